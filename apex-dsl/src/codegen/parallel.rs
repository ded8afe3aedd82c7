//! `each par`: what its body keeps during a firing is made again for each thread, so that elements share nothing.

use super::{
    field::fields,
    generator::Generator,
    structs::{Field, Struct, insert, node_structs},
    tokens::ident,
};
use crate::{
    analyse::Analysis,
    graph::{Graph, Library, NodeId, NodeKind},
};
use proc_macro2::TokenStream;
use quote::{format_ident, quote};
use std::collections::BTreeMap;

/// State of a thread that runs the body of an `each par`.
pub struct Local {
    /// The types of it, and the parameters that it is made from.
    pub items: TokenStream,
    /// It: the buffers and the nodes.
    pub make: TokenStream,
}

impl Generator<'_> {
    /// State of a thread that runs `body`, for which this is the generator.
    pub fn local(&self, body: &Graph, analysis: &Analysis) -> Local {
        let tokens = fields(&self.token_state(body, analysis));
        let state = Struct::new(&ident("LocalState"), "Tokens.", &tokens);
        let (mut nodes, mut params) = (BTreeMap::new(), vec![]);
        self.local_nodes(body, analysis, &mut nodes, &mut params);
        let (name, program) = (ident("LocalNodes"), ident(&body.name));
        let nodes = node_structs(&name, &program, &nodes, false);
        let (state_item, state_make, node_items, nodes_make) = (state.item, state.make, nodes.item, nodes.make);
        Local { items: quote! { #state_item #node_items #(#params)* }, make: quote!((#state_make, #nodes_make)) }
    }

    /// Nodes with the parameters that they have at this moment.
    fn local_nodes(
        &self,
        graph: &Graph,
        analysis: &Analysis,
        fields: &mut BTreeMap<String, Field>,
        params: &mut Vec<TokenStream>,
    ) {
        for (id, node) in graph.nodes.iter_enumerated() {
            match &node.kind {
                NodeKind::Library(library) if !self.catalog.signatures[library.signature].is_function => {
                    let place = self.node_place(graph, id);
                    let first = params.len();
                    for param in 0..library.params.len() {
                        let name = format_ident!("param_of_{}", params.len());
                        params.push(quote! {
                            let #name = ::core::clone::Clone::clone(::apex_rt::ParamField::<#param>::field(&mut #place));
                        });
                    }
                    let (ty, make) = self.local_node(graph, id, library, first..params.len());
                    insert(fields, &self.node_path(graph, id), Field::Node { ty, make });
                }
                NodeKind::Each(each) => {
                    if let Some(body) = analysis.bodies.get(&id) {
                        self.inside(graph, id).local_nodes(&each.body, body, fields, params);
                    }
                }
                _ => {}
            }
        }
    }

    fn local_node(
        &self,
        graph: &Graph,
        node: NodeId,
        library: &Library,
        params: std::ops::Range<usize>,
    ) -> (TokenStream, TokenStream) {
        let ty = self.node_type(graph, library);
        let params = params.map(|param| {
            let name = format_ident!("param_of_{param}");
            quote!(::core::clone::Clone::clone(&#name))
        });
        (ty, self.construct(graph, node, library, &params.collect::<Vec<_>>()))
    }
}
