//! `#[node]`, `#[derive(Outputs)]` and `#[derive(Units)]`, which `apex-rt` re-exports.

mod node;
mod outputs;

use proc_macro::TokenStream;

/// Makes a function, a struct or its `impl` a node. The signature is the interface.
#[proc_macro_attribute]
pub fn node(args: TokenStream, item: TokenStream) -> TokenStream {
    node::expand(args.into(), item.into()).unwrap_or_else(|error| error.into_compile_error()).into()
}

/// Makes every field of a struct an output of the node that returns it. A field of type `Option<T>` may be ⊥.
/// `#[unit("m")]` is the unit of a field.
#[proc_macro_derive(Outputs, attributes(unit))]
pub fn outputs(item: TokenStream) -> TokenStream {
    outputs::expand(item.into()).unwrap_or_else(|error| error.into_compile_error()).into()
}

/// Gives the fields of a struct units: `#[unit("m")]`. They are checked where a source file writes the struct as a
/// value: `Pose2 { x: 1m, y: 0m, theta: 90deg }`.
#[proc_macro_derive(Units, attributes(unit))]
pub fn units(item: TokenStream) -> TokenStream {
    outputs::units(item.into()).unwrap_or_else(|error| error.into_compile_error()).into()
}
