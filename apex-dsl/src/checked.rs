//! A checked program, from which code is generated.

use crate::{analyse::Analysis, claims::Decided, graph::Graph, script::Script, threads::Split};

/// A graph that has passed all checks, with the results of its analysis.
pub struct CheckedProgram {
    /// The graph.
    pub graph: Graph,
    /// Results of the analysis before it runs.
    pub analysis: Analysis,
    /// Verdicts on its claims.
    pub claims: Decided,
    /// Division into thread groups, if it runs on several threads.
    pub split: Option<Split>,
    /// Scripts of the tests for which the program is made; empty for a program of its own.
    pub scripts: Vec<Script>,
}

impl CheckedProgram {
    /// `true` if the program is made for tests.
    pub fn is_test(&self) -> bool {
        !self.scripts.is_empty()
    }
}
