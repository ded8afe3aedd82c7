//! What a `test` does with a program: the steps of its script, resolved.

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
    /// Its place in the text.
    pub span: Span,
    /// What is done and expected, in order.
    pub steps: Vec<Step>,
}

/// A step of a test.
#[derive(Debug, Clone)]
pub enum Step {
    /// Tokens for a port of the program: the first now, the others each a period later. A single one with a period
    /// comes again and again.
    Feed {
        /// The port.
        port: NodeId,
        /// The tokens.
        values: Vec<Value>,
        /// From token to token.
        every: Option<Duration>,
    },
    /// The tokens of a channel of a recording for a port of the program, at their times.
    FeedRecorded {
        /// The port.
        port: NodeId,
        /// The file, from the folder of the text.
        file: String,
        /// The channel.
        channel: String,
    },
    /// Lets time pass.
    Wait(Duration),
    /// Something is to happen until then; without a time it has to have happened by now.
    Expect(Seen, Option<Until>),
    /// Something is not to happen from now on.
    Never(Seen),
}

/// A time of a test.
#[derive(Debug, Clone, Copy)]
pub enum Until {
    /// Since the start.
    By(Duration),
    /// Since the step before.
    Within(Duration),
}

/// What a test looks for.
#[derive(Debug, Clone)]
pub struct Seen {
    /// What it is.
    pub what: What,
    /// As the text says it.
    pub text: String,
    /// Its place in the text.
    pub span: Span,
}

/// What a test looks for.
#[derive(Debug, Clone)]
pub enum What {
    /// It is active.
    Active(Subject),
    /// A token at a probe, for which this condition holds.
    Token(NodeId, Option<Condition>),
}
