//! The types of tokens, as far as they can be written down.

use crate::{
    codegen::generator::Generator,
    graph::{Graph, PortId},
};
use proc_macro2::{TokenStream, TokenTree};

/// The type of the tokens at a port.
///
/// # Errors
/// Only rustc can infer it.
pub fn token_type(generator: &Generator<'_>, graph: &Graph, end: PortId) -> Result<TokenStream, String> {
    let ty = generator.token_type(graph, end);
    match is_inferred(&ty) || ty.is_empty() {
        true => Err(format!("only rustc knows the type of `{}`", graph.end_name(end))),
        false => Ok(ty),
    }
}

/// Returns `true` if a type has a part that rustc has to infer.
pub fn is_inferred(ty: &TokenStream) -> bool {
    ty.clone().into_iter().any(|token| match token {
        TokenTree::Ident(name) => name == "_",
        TokenTree::Group(group) => is_inferred(&group.stream()),
        TokenTree::Punct(_) | TokenTree::Literal(_) => false,
    })
}
