//! `#[node]` and `#[derive(Outputs)]`, which `apex-rt` re-exports.

mod node;
mod outputs;

use proc_macro::TokenStream;

/// Makes a function, a struct or its `impl` a node. The signature is the interface.
#[proc_macro_attribute]
pub fn node(args: TokenStream, item: TokenStream) -> TokenStream {
    node::expand(args.into(), item.into()).unwrap_or_else(|error| error.into_compile_error()).into()
}

/// Makes every field of a struct an output of the node that returns it. A field of type `Option<T>` may be ⊥.
#[proc_macro_derive(Outputs)]
pub fn outputs(item: TokenStream) -> TokenStream {
    outputs::expand(item.into()).unwrap_or_else(|error| error.into_compile_error()).into()
}
