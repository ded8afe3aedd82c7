//! Faults of the compiler that show while it generates code: each becomes a message, and no program is made.

use crate::{
    report::{Diagnostic, Diagnostics},
    source::Span,
};
use std::cell::RefCell;

/// Faults found in one program.
#[derive(Debug)]
pub struct Bugs {
    /// Span of the graph, for faults without a more precise place.
    pub graph: Span,
    found: RefCell<Vec<(Span, String)>>,
}

impl Bugs {
    /// No faults in the program of the graph at `graph`.
    pub const fn new(graph: Span) -> Self {
        Self { graph, found: RefCell::new(vec![]) }
    }

    /// Notes a fault. Returns the message for rustc.
    pub fn note(&self, span: Span, what: &str) -> String {
        self.found.borrow_mut().push((span, what.to_owned()));
        format!("internal error of the Apex compiler: {what}")
    }

    /// Turns the first fault into a message. Others may follow from it.
    pub fn report(self, diagnostics: &mut Diagnostics) {
        if let Some((span, what)) = self.found.into_inner().into_iter().next() {
            diagnostics.push(
                Diagnostic::error("internal-error", span, format!("internal error of the compiler: {what}"))
                    .note("the source file may be right; please report this message together with the file"),
            );
        }
    }
}
