//! Tests and studies.

use super::{Arg, Expr, Ident, Instance, PathExpr, PortRef, RangeExpr};
use crate::source::Span;

/// `test name: Graph(argument = value) { … }`, or a study `tune name: Graph { … }`
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
    /// Statements that only a study has.
    pub study: Option<StudyItem>,
    /// From its name to its graph.
    pub span: Span,
    /// From its documentation to its closing bracket.
    pub extent: Span,
}

impl TestItem {
    /// The keyword of the item.
    pub fn word(&self) -> &'static str {
        if self.study.is_some() { "tune" } else { "test" }
    }
}

/// Statements that only a study has.
#[derive(Debug, Default)]
pub struct StudyItem {
    /// `vary node.parameter in low..=high;`
    pub vary: Vec<(PortRef, Option<RangeExpr>)>,
    /// `minimise port at 90%;`, `maximise port;`
    pub goals: Vec<GoalItem>,
    /// `require test, test;`
    pub required: Vec<Ident>,
    /// `seeds 32;`
    pub seeds: Option<Expr>,
    /// `holdout 32;`, `holdout "other.mcap";`
    pub held_out: Vec<Expr>,
}

/// A goal of a study.
#[derive(Debug)]
pub struct GoalItem {
    /// The port whose last value in a run counts.
    pub of: PortRef,
    /// `true` for `maximise`.
    pub maximise: bool,
    /// The share of the runs that reach the value of the goal.
    pub share: Option<Expr>,
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
