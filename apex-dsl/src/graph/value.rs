//! Constants, and claims about activity.

use super::ids::{NodeId, ScopeId};
use crate::{
    catalog::Type,
    fraction::Fraction,
    source::Span,
    units::{Dimension, Unit},
};
use std::time::Duration;

/// A claim about activity, or about the tokens of events.
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
    /// Tokens never wait for one another.
    Live,
}

impl ClaimKind {
    /// All kinds of claims.
    pub const ALL: [Self; 4] = [Self::Exclusive, Self::Reaches, Self::Conserved, Self::Live];

    /// The keyword of the claim.
    pub fn word(self) -> &'static str {
        match self {
            Self::Exclusive => "exclusive",
            Self::Reaches => "reaches",
            Self::Conserved => "conserved",
            Self::Live => "live",
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
            Self::Number(n) => n.integer().map_or_else(|| n.value.to_string(), |integer| integer.to_string()),
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
    /// The nearest `f64`.
    pub value: f64,
    /// Its exact value, unless that is not a fraction, or has too many digits.
    pub exact: Option<Fraction>,
    /// `true` for a float where only rustc knows the type: it was written with a point, with a unit, or is a part.
    pub is_float: bool,
    /// Dimension of the quantity.
    pub dimension: Dimension,
}

impl Number {
    /// 1 divided by the number; `None` for 0.
    pub fn inverse(self) -> Option<Self> {
        let dimension = Dimension::NONE.combine(self.dimension, -1)?;
        let exact = self.exact.and_then(|exact| Fraction::ONE.checked_div(exact));
        (self.value != 0.0).then(|| Self { value: 1.0 / self.value, exact, is_float: true, dimension })
    }

    /// A plain whole number.
    pub fn whole(number: i128) -> Self {
        let exact = Fraction::whole(number);
        Self { value: exact.value(), exact: Some(exact), is_float: false, dimension: Dimension::NONE }
    }

    /// A plain number as it is printed.
    pub fn plain(value: f64) -> Self {
        Self { value, exact: Fraction::of(value), is_float: true, dimension: Dimension::NONE }
    }

    /// The number, if it is whole.
    pub fn integer(self) -> Option<i128> {
        self.exact.and_then(Fraction::integer)
    }

    /// So many units, where it is a plain number.
    pub fn times(self, unit: Unit) -> Self {
        let exact = self.exact.and_then(|exact| exact.checked_mul(unit.factor));
        let value = exact.map_or_else(|| self.value * unit.size(), Fraction::value);
        Self { value, exact, is_float: true, dimension: unit.dimension }
    }

    /// The number of units that the quantity is, as a plain number.
    pub fn in_unit(self, unit: Unit) -> Self {
        let exact = self.exact.and_then(|exact| exact.checked_div(unit.factor));
        let value = exact.map_or_else(|| self.value / unit.size(), Fraction::value);
        Self { value, exact, is_float: true, dimension: Dimension::NONE }
    }
}
