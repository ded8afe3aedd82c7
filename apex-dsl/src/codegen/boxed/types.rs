//! The types of tokens, as far as they can be written down.

use crate::{
    catalog::{Catalog, Type},
    codegen::{generator::Generator, tokens::to_rust},
    graph::{Graph, PortId, Value},
};
use proc_macro2::{TokenStream, TokenTree};
use quote::quote;

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

/// The type of a constant that stands for a token of type `ty`.
///
/// # Errors
/// Only rustc can infer it.
pub fn constant_type(value: &Value, ty: &Type, catalog: &Catalog) -> Result<TokenStream, String> {
    match to_rust(ty, catalog) {
        Some(rust) => Ok(rust),
        None if matches!(value, Value::Text(_)) => Ok(quote!(&'static str)),
        None => Err(format!("only rustc knows the type of the constant `{}`", value.text())),
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
