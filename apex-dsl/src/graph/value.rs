//! Constants, and claims about activity.

use super::{NodeId, ScopeId};
use crate::{
    catalog::Type,
    source::Span,
    units::{self, Dimension, Unit},
};
use std::time::Duration;

/// A claim about activity.
#[derive(Debug, Clone)]
pub struct Claim {
    /// Property that is claimed.
    pub kind: ClaimKind,
    /// Nodes or nested graphs that the claim is about.
    pub of: Vec<Subject>,
    /// Place in the source file.
    pub span: Span,
}

/// Property of a claim.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ClaimKind {
    /// No two subjects are ever active at the same time.
    Exclusive,
    /// Whenever the first subject is active, activity can reach the second.
    Reaches,
    /// The amount of activity in the program is always the amount that `start` gave.
    Conserved,
}

impl ClaimKind {
    /// All kinds of claims.
    pub const ALL: [Self; 3] = [Self::Exclusive, Self::Reaches, Self::Conserved];

    /// The keyword of the claim.
    pub fn word(self) -> &'static str {
        match self {
            Self::Exclusive => "exclusive",
            Self::Reaches => "reaches",
            Self::Conserved => "conserved",
        }
    }
}

/// Subject of a claim.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Subject {
    /// A node.
    Node(NodeId),
    /// A nested graph: active while a node inside is active, or while activity is on its way between two nodes inside.
    Scope(ScopeId),
}

/// A constant.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// A number in SI.
    Number(Number),
    /// `true`, `false`
    Bool(bool),
    /// A string
    Text(String),
    /// A list
    List(Vec<Value>),
    /// `()`
    Unit,
    /// A duration
    Duration(Duration),
    /// A constant of Rust: the path that generated code uses, and its type.
    Path(Vec<String>, Type),
    /// A struct of Rust.
    Struct(StructValue),
    /// A default that is written in Rust, which only rustc can evaluate.
    RustDefault,
}

impl Value {
    /// The value as written in a source file, in SI units.
    pub fn text(&self) -> String {
        match self {
            Self::Number(n) => n.integer.map_or_else(|| n.value.to_string(), |integer| integer.to_string()),
            Self::Bool(value) => value.to_string(),
            Self::Text(text) => format!("{text:?}"),
            Self::List(items) => format!("[{}]", items.iter().map(Self::text).collect::<Vec<_>>().join(", ")),
            Self::Unit => "()".to_owned(),
            Self::Duration(time) => format!("{}s", time.as_secs_f64()),
            Self::Path(path, _) => path.join("::").trim_start_matches("::").to_owned(),
            Self::Struct(given) => {
                let fields = given.fields.iter().map(|field| format!("{}: {}", field.name, field.value.text()));
                let name = given.path.last().map_or("", String::as_str);
                format!("{name} {{ {} }}", fields.collect::<Vec<_>>().join(", "))
            }
            Self::RustDefault => "…".to_owned(),
        }
    }
}

/// A struct of Rust with the values of its fields.
#[derive(Debug, Clone, PartialEq)]
pub struct StructValue {
    /// The path that generated code uses.
    pub path: Vec<String>,
    /// Its type; type parameters stand for themselves.
    pub ty: Type,
    /// Its fields.
    pub fields: Vec<FieldValue>,
}

/// The value of a field.
#[derive(Debug, Clone, PartialEq)]
pub struct FieldValue {
    /// Name of the field.
    pub name: String,
    /// Type of the field.
    pub ty: Type,
    /// Its value.
    pub value: Value,
}

/// A number in SI units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Number {
    /// Its value.
    pub value: f64,
    /// Its exact value, if it was written as an integer without a unit.
    pub integer: Option<i128>,
    /// Dimension of the quantity.
    pub dimension: Dimension,
}

impl Number {
    /// The number of units that the quantity is, as a plain number.
    pub fn in_unit(self, unit: Unit) -> Self {
        let value = units::scaled(self.value, 1.0 / unit.factor);
        let integer = (value.fract() == 0.0 && value.abs() < 2f64.powi(63)).then_some(value as i128);
        Self { value, integer, dimension: Dimension::NONE }
    }
}
