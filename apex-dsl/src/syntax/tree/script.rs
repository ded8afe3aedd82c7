//! Tests.

use super::{Arg, Expr, Ident, Instance, PathExpr, PortRef};
use crate::source::Span;

/// `test name: Graph(argument = value) { … }`
#[derive(Debug)]
pub struct TestItem {
    /// Documentation.
    pub docs: String,
    /// Name of the test.
    pub name: Ident,
    /// The graph under test.
    pub graph: PathExpr,
    /// Arguments of the graph.
    pub args: Vec<Arg>,
    /// Nodes that are replaced, with their replacements.
    pub replaced: Vec<(PortRef, Instance)>,
    /// Inputs and expectations, in order.
    pub steps: Vec<TestStep>,
    /// From its name to its graph.
    pub span: Span,
    /// From its documentation to its closing bracket.
    pub extent: Span,
}

/// A statement of a test.
#[derive(Debug)]
pub enum TestStep {
    /// `feed port = value every 10ms;`
    Feed(Ident, Option<Expr>, Option<Expr>),
    /// `feed port = recording("run.mcap", "laser.scan");`
    FeedRecorded(Ident, String, String),
    /// `wait 50ms;`
    Wait(Expr),
    /// `expect condition within 50ms;`, `expect condition by 2s;`
    Expect(Condition, Option<(Limit, Expr)>),
    /// `never condition;`
    Never(Condition),
}

/// Kind of a time limit for an expectation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Limit {
    /// Measured from the start.
    By,
    /// Measured from the previous step.
    Within,
}

/// Condition of an expectation.
#[derive(Debug)]
pub struct Condition {
    /// A port, or the node or graph that should be active.
    pub of: PortRef,
    /// `true` for `active(…)`.
    pub active: bool,
    /// Comparison of the token: operator and value.
    pub compare: Option<(&'static str, Expr)>,
    /// Largest difference that is still equal.
    pub tolerance: Option<Expr>,
    /// The whole condition.
    pub span: Span,
}
