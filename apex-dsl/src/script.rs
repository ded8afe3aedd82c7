//! Resolved scripts of `test` blocks: the steps that a test takes with a program.

use crate::{
    graph::{Condition, NodeId, Subject, Value},
    source::Span,
};
use std::time::Duration;

/// The script of a test.
#[derive(Debug, Clone)]
pub struct Script {
    /// Name of the test.
    pub name: String,
    /// Documentation.
    pub docs: String,
    /// Place in the source file.
    pub span: Span,
    /// Inputs and expectations, in order.
    pub steps: Vec<Step>,
}

/// A step of a test.
#[derive(Debug, Clone)]
pub enum Step {
    /// Tokens for a port of the program: the first one now, each further one a period later. A single token with a
    /// period is repeated.
    Feed {
        /// The port.
        port: NodeId,
        /// The tokens.
        values: Vec<Value>,
        /// Period between the tokens.
        every: Option<Duration>,
    },
    /// The tokens of a channel of a recording for a port of the program, at their times.
    FeedRecorded {
        /// The port.
        port: NodeId,
        /// Path of the file, relative to the folder of the source file.
        file: String,
        /// The channel.
        channel: String,
    },
    /// Lets time pass.
    Wait(Duration),
    /// An observation that must be made until then; without a time it must have been made by now.
    Expect(Seen, Option<Until>),
    /// An observation that must not be made from now on.
    Never(Seen),
}

/// Time limit of an expectation.
#[derive(Debug, Clone, Copy)]
pub enum Until {
    /// Time since the start.
    By(Duration),
    /// Time since the previous step.
    Within(Duration),
}

/// An observation that a test expects or forbids.
#[derive(Debug, Clone)]
pub struct Seen {
    /// Kind of the observation.
    pub what: What,
    /// Wording in the source file.
    pub text: String,
    /// Place in the source file.
    pub span: Span,
}

/// Kind of an observation.
#[derive(Debug, Clone)]
pub enum What {
    /// A node or nested graph is active.
    Active(Subject),
    /// A token arrives at a probe and satisfies the condition, if there is one.
    Token(NodeId, Option<Condition>),
}
