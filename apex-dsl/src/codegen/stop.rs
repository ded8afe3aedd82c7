//! The end of a program: the methods of nodes that are called then.

use super::{generator::Generator, tokens::ident};
use crate::{
    analyse::Analysis,
    graph::{Graph, NodeKind},
};
use proc_macro2::TokenStream;
use quote::quote;

impl Generator<'_> {
    /// The function that calls the `#[on_stop]` methods of the nodes of a program, or of a part of one. Nothing if no
    /// node has one.
    pub fn stop_nodes(&self, graph: &Graph, analysis: &Analysis) -> TokenStream {
        let calls = self.stop_calls(graph, analysis);
        if calls.is_empty() {
            return calls;
        }
        quote! {
            fn stop_nodes(&mut self) {
                let Self { nodes, .. } = self;
                #calls
            }
        }
    }

    /// `stop` of `Program`, for nodes that are kept at `place`.
    pub fn stop(&self, graph: &Graph, analysis: &Analysis, place: &TokenStream) -> TokenStream {
        match self.stop_calls(graph, analysis).is_empty() {
            true => quote!(),
            false => quote! { fn stop(&mut self) { #place.stop_nodes(); } },
        }
    }

    fn stop_calls(&self, graph: &Graph, analysis: &Analysis) -> TokenStream {
        let calls = graph.nodes.iter_enumerated().map(|(id, node)| match &node.kind {
            NodeKind::Library(library) => match &self.catalog.signatures[library.signature].on_stop {
                Some(method) => {
                    let (place, method) = (self.node_place(graph, id), ident(method));
                    // After a panic, which has been reported, the other nodes stop all the same.
                    quote! { let _ = ::apex_rt::contain(|| #place.#method()); }
                }
                None => quote!(),
            },
            NodeKind::Each(each) => match analysis.bodies.get(&id) {
                Some(body) => self.inside(graph, id).stop_calls(&each.body, body),
                None => quote!(),
            },
            _ => quote!(),
        });
        calls.collect()
    }
}
