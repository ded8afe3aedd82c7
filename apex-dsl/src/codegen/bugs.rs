//! Faults of the compiler that show while it generates code: each becomes a message, and no program is made.

use super::Generator;
use crate::{
    report::{Diagnostic, Diagnostics},
    source::Span,
};
use proc_macro2::TokenStream;
use quote::quote;
use std::cell::RefCell;
use syn::Ident;

/// Faults found in one program.
#[derive(Debug)]
pub struct Bugs {
    /// Span of the graph, for faults without a more precise place.
    graph: Span,
    found: RefCell<Vec<(Span, String)>>,
}

impl Bugs {
    /// No faults in the program of the graph at `graph`.
    pub const fn new(graph: Span) -> Self {
        Self { graph, found: RefCell::new(vec![]) }
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

impl Generator<'_> {
    /// Notes a fault at `span`. The code stands for what cannot be generated.
    pub fn bug(&self, span: Span, what: &str) -> TokenStream {
        self.bugs.found.borrow_mut().push((span, what.to_owned()));
        let message = format!("internal error of the Apex compiler: {what}");
        quote!(::core::compile_error!(#message))
    }

    /// Notes that something has no name. The identifier stands for it.
    pub fn nameless(&self, what: &str) -> Ident {
        self.bug(self.bugs.graph, &format!("{what} has no name"));
        quote::format_ident!("nameless")
    }
}
