//! Resolved scripts of `test` and `tune` items: the steps that a test takes with a program, and what a study searches.

use crate::{
    catalog::Type,
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
    /// The study, if it is the script of one.
    pub study: Option<Study>,
}

/// A study: many runs of a script with other values of parameters.
#[derive(Debug, Clone, Default)]
pub struct Study {
    /// Parameters that are searched.
    pub vary: Vec<Varied>,
    /// Goals.
    pub goals: Vec<Goal>,
    /// Names of the tests that must pass.
    pub required: Vec<String>,
    /// Names of the parameters that differ between the seeds.
    pub seed_params: Vec<String>,
    /// Number of seeds.
    pub seeds: u64,
    /// Number of further seeds that only score the result.
    pub held_out: u64,
    /// Recordings that only score the result, relative to the folder of the source file.
    pub recordings: Vec<String>,
}

/// A parameter that a study searches.
#[derive(Debug, Clone)]
pub struct Varied {
    /// Name, as written.
    pub name: String,
    /// Names of the parameters of the program that have its value.
    pub targets: Vec<String>,
    /// SI unit of its numbers.
    pub unit: Option<String>,
    /// Unit of its declaration, and the value of one of it in SI, if that is another one.
    pub declared: Option<(String, f64)>,
    /// Smallest value, in SI.
    pub low: f64,
    /// Largest value, in SI.
    pub high: f64,
    /// `true` if all values are integers.
    pub integer: bool,
    /// `true` if the values are of single precision.
    pub single: bool,
    /// Place in the source file.
    pub span: Span,
}

/// An observed token, or a field of it.
#[derive(Debug, Clone)]
pub struct Observed {
    /// The probe at the port.
    pub probe: NodeId,
    /// The fields on the way from the token to what is observed; none for the token itself.
    pub fields: Vec<String>,
    /// Type of what is observed.
    pub ty: Type,
}

/// A goal of a study: the last token of a run at a port.
#[derive(Debug, Clone)]
pub struct Goal {
    /// Name of the port, as written.
    pub name: String,
    /// The observed number or time.
    pub of: Observed,
    /// Unit of its tokens.
    pub unit: Option<String>,
    /// `true` if greater is better.
    pub maximise: bool,
    /// Share of the runs that reach the value of a candidate, above 0 and at most 1.
    pub share: f64,
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
        /// Place in the source file.
        span: Span,
    },
    /// The tokens of a channel of a recording for a port of the program, at their times.
    FeedRecorded {
        /// The port.
        port: NodeId,
        /// Path of the file, relative to the folder of the source file.
        file: String,
        /// The channel.
        channel: String,
        /// Place in the source file.
        span: Span,
    },
    /// Lets time pass.
    Wait(Duration),
    /// An observation that must be made until then; without a time it must have been made by now. A token that was
    /// observed is not observed again.
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
    /// A state machine is in one of these states, by their numbers.
    InState(NodeId, Vec<usize>),
    /// A token arrives at a probe and satisfies the condition, if there is one.
    Token(Observed, Option<Condition>),
}
