//! `graph!`: a thin wrapper around the compiler, `apex-dsl`. The code that it generates calls the runtime, `apex-rt`.

mod graph;

use proc_macro::TokenStream;

/// Compiles a graph: `graph!("robot.afg")`, or the source itself in braces.
#[proc_macro]
pub fn graph(text: TokenStream) -> TokenStream {
    graph::expand(text).into()
}
