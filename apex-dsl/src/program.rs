//! A program between its checks and its code.

use crate::{analyse::Analysis, claims::Decided, graph::Graph, script::Script, threads::Split};

/// A graph that stood all checks, with what is known about it.
pub struct Program {
    /// The graph.
    pub graph: Graph,
    /// What is known about it before it runs.
    pub analysis: Analysis,
    /// What is known about its claims.
    pub claims: Decided,
    /// If it runs on several threads: what runs on which.
    pub split: Option<Split>,
    /// If it is made for a test: what the test does with it.
    pub script: Option<Script>,
}
