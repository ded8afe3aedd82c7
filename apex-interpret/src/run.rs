//! Execution of a program.

use crate::{Library, Value, cells::Cells, code::Code, local::Local, state::State};

/// Execution of a program, or of the body of an `each`.
pub struct Run<'r, 'a, O> {
    pub code: &'r Code<'a>,
    pub state: &'r mut State<'a>,
    pub cells: &'r mut Cells<'a>,
    pub library: &'r dyn Library,
    pub observer: &'r mut O,
}

/// Place of operations: the cluster that they belong to, and the token that a slot has taken away.
#[derive(Default)]
pub struct Place<'l, 'a> {
    /// Tokens of the cluster.
    pub local: Option<&'l mut Local<'a>>,
    /// Token of the slot.
    pub taken: Option<Value>,
}
