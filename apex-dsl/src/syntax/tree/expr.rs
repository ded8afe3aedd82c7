//! Types and constant expressions.

use super::{Ident, PathExpr};
use crate::source::Span;

/// A type as written.
#[derive(Debug, Clone)]
pub struct TypeExpr {
    /// Kind of the type.
    pub kind: TypeKind,
    /// Place in the source file.
    pub span: Span,
}

/// Kind of a type.
#[derive(Debug, Clone)]
pub enum TypeKind {
    /// `a::B<C>`
    Path(PathExpr, Vec<TypeExpr>),
    /// `[T; N]`; without `N` a list of any length.
    Array(Box<TypeExpr>, Option<String>),
    /// `(A, B)`
    Tuple(Vec<TypeExpr>),
    /// `T[unit]`: the type of a port whose tokens are numbers in this unit.
    Measured(Box<TypeExpr>, Ident),
    /// A number as a type argument.
    Const(String),
}

/// A constant expression.
#[derive(Debug, Clone)]
pub struct Expr {
    /// Kind of the expression.
    pub kind: ExprKind,
    /// Place in the source file.
    pub span: Span,
}

/// Kind of an expression.
#[derive(Debug, Clone)]
pub enum ExprKind {
    /// Digits and the unit behind them.
    Number(String, Option<String>),
    /// A string with its escapes resolved.
    Text(String),
    /// `true`, `false`
    Bool(bool),
    /// A parameter, or a constant in Rust.
    Path(PathExpr),
    /// `[a, b]`
    List(Vec<Expr>),
    /// `Pose2 { x: 1m, y: 0m }`
    Struct(PathExpr, Vec<(Ident, Expr)>),
    /// `-a`, `!a`
    Unary(&'static str, Box<Expr>),
    /// `a + b`
    Binary(&'static str, Box<Expr>, Box<Expr>),
}
