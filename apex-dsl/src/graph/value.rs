//! Constants, and claims about activity.

use super::{NodeId, ScopeId};
use crate::{catalog::Type, source::Span, units::Dimension};
use std::time::Duration;

/// A claim about activity.
#[derive(Debug, Clone)]
pub struct Claim {
    /// What is claimed.
    pub kind: ClaimKind,
    /// Of which nodes or nested graphs.
    pub of: Vec<Subject>,
    /// Its place in the text.
    pub span: Span,
}

/// What a claim says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ClaimKind {
    /// No two of them are ever active at the same time.
    Exclusive,
    /// Whenever the first is active, there is a way on which activity can come to the second.
    Reaches,
    /// There is always as much activity in the program as `start` gave.
    Conserved,
}

impl ClaimKind {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Exclusive, Self::Reaches, Self::Conserved];

    /// The word for it in a text.
    pub fn word(self) -> &'static str {
        match self {
            Self::Exclusive => "exclusive",
            Self::Reaches => "reaches",
            Self::Conserved => "conserved",
        }
    }
}

/// What a claim is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Subject {
    /// A node.
    Node(NodeId),
    /// A nested graph: active while a node inside is, or while activity is under way between two of them.
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
    /// A constant of Rust, by the path with which generated code names it, and its type.
    Path(Vec<String>, Type),
    /// The default that is written in Rust and that only rustc can evaluate.
    RustDefault,
}

impl Value {
    /// The value as a text has it, in SI.
    pub fn text(&self) -> String {
        match self {
            Self::Number(n) => n.integer.map_or_else(|| n.value.to_string(), |integer| integer.to_string()),
            Self::Bool(value) => value.to_string(),
            Self::Text(text) => format!("{text:?}"),
            Self::List(items) => format!("[{}]", items.iter().map(Self::text).collect::<Vec<_>>().join(", ")),
            Self::Unit => "()".to_owned(),
            Self::Duration(time) => format!("{}s", time.as_secs_f64()),
            Self::Path(path, _) => path.join("::").trim_start_matches("::").to_owned(),
            Self::RustDefault => "…".to_owned(),
        }
    }
}

/// A number in SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Number {
    /// Its value.
    pub value: f64,
    /// Its exact value, if it was written as an integer without a unit.
    pub integer: Option<i128>,
    /// What it measures.
    pub dimension: Dimension,
}
