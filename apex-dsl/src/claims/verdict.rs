//! Verdicts on claims.

use crate::graph::Graph;

/// Verdict on a claim.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// The claim holds in every run.
    Holds,
    /// There is a run in which the claim does not hold.
    Fails,
    /// There are too many states: the program checks the claim at run time.
    Undecided,
    /// The same in a program on several threads, which does not check it.
    Unchecked,
}

impl Verdict {
    /// The verdict as text.
    pub fn words(self) -> &'static str {
        match self {
            Self::Holds => "holds",
            Self::Fails => "fails",
            Self::Undecided => "undecided, checked at run time",
            Self::Unchecked => "undecided, and not checked on several threads",
        }
    }

    /// The verdict on a claim of `graph` that is not decided.
    pub fn undecided(graph: &Graph) -> Self {
        if graph.has_several_groups() { Self::Unchecked } else { Self::Undecided }
    }
}

/// Note about a claim of `graph` that is not decided: whether the program checks it.
pub fn how_checked(graph: &Graph) -> &'static str {
    if graph.has_several_groups() {
        "it is not checked at run time either: the program runs on several threads"
    } else {
        "the program checks it at run time and reports a violation to `Observer::claim_failed`"
    }
}
