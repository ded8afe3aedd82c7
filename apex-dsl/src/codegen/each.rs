//! `each`: the body as a closure over the elements of a list.

use super::{
    emitter::Emitter,
    parallel::Local,
    view::{Lowered, ProgramView},
};
use crate::{
    graph::{Each, Graph, NodeId, NodeKind, PortId},
    program::{BlockId, Storage},
    syntax::tree::PortKind,
};
use proc_macro2::TokenStream;
use quote::{format_ident, quote};

impl Emitter<'_> {
    /// Fires an `each`: the results are collected in order, ⊥ is dropped.
    pub fn fire_each(&self, node: NodeId, each: &Each, block: BlockId) -> TokenStream {
        let index = self.generator.index(node);
        let generator = self.generator.inside(self.graph, node);
        let body = &*each.body;
        let Some(analysis) = self.analysis.bodies.get(&node) else { return quote!() };
        let lowered = Lowered::new(&generator, body, analysis);
        let clusters: Vec<Emitter<'_>> = analysis
            .clusters
            .ids()
            .map(|cluster| Emitter::new(&generator, ProgramView::new(body, analysis, &lowered), cluster))
            .collect();
        let code: TokenStream = clusters.iter().map(Emitter::code).collect();
        let (mut item, mut bindings) = (format_ident!("_item"), quote!());
        for (port, p) in self.graph.nodes[node].ports.iter().enumerate().filter(|(_, p)| p.kind == PortKind::Input) {
            let inside = generator.name(PortId { node: boundary(body, &p.name, PortKind::Input), port: 0 });
            if Some(port) == each.list {
                item = inside;
            } else if p.optional || self.incoming(PortId { node, port }).is_some() {
                let to = PortId { node, port };
                let token = if p.optional { self.arriving(to, block) } else { self.arrived(to, block) };
                let token = token.unwrap_or_else(|| quote!(None));
                bindings.extend(quote! { let #inside = #token; });
            }
        }
        let Some(list) = each.list.and_then(|port| self.arrived(PortId { node, port }, block)) else {
            return self.generator.bug(self.graph.nodes[node].span, "nothing leads to the list of an `each`");
        };
        let results: Vec<(syn::Ident, TokenStream, bool)> = self.graph.nodes[node]
            .ports
            .iter()
            .enumerate()
            .filter(|(_, p)| p.kind == PortKind::Output)
            .map(|(port, p)| {
                let (value, optional) = result(&clusters, boundary(body, &p.name, PortKind::Output));
                (self.generator.name(PortId { node, port }), value, optional)
            })
            .collect();
        let iteration = match results.as_slice() {
            several if each.parallel => {
                let Local { items, make } = generator.local(body, analysis);
                let begins =
                    several.iter().map(|(name, ..)| quote! { ::apex_rt::List::clear(state.#name.begin().get_mut()); });
                let values = several
                    .iter()
                    .map(|(_, value, optional)| if *optional { quote!(#value) } else { quote!(Some(#value)) });
                let names: Vec<syn::Ident> = (0..several.len()).map(|i| format_ident!("result_{i}")).collect();
                let appends = several.iter().zip(&names).map(|((name, ..), result)| {
                    quote! { ::apex_rt::List::append(state.#name.get_mut(), #result.into_iter()); }
                });
                // What happens on other threads cannot be watched.
                quote! {
                    #items
                    #(#begins)*
                    let results = ::apex_rt::par_map(::apex_rt::List::items(#list), || #make, |(state, nodes), #item| {
                        let observer = &mut ();
                        #code
                        Some((#(#values,)*))
                    });
                    for (#(#names,)*) in results { #(#appends)* }
                }
            }
            [(name, value, optional)] => {
                let adapter = if *optional { quote!(filter_map) } else { quote!(map) };
                quote! {
                    let results = state.#name.begin().get_mut();
                    ::apex_rt::List::clear(results);
                    ::apex_rt::List::append(results, ::apex_rt::List::items(#list).iter().#adapter(|#item| { #code #value }));
                }
            }
            several => {
                let begins =
                    several.iter().map(|(name, ..)| quote! { ::apex_rt::List::clear(state.#name.begin().get_mut()); });
                let appends = several.iter().map(|(name, value, optional)| {
                    let some = if *optional { quote!(#value) } else { quote!(Some(#value)) };
                    quote! { ::apex_rt::List::append(state.#name.get_mut(), (#some).into_iter()); }
                });
                quote! {
                    #(#begins)*
                    for #item in ::apex_rt::List::items(#list) { #code #(#appends)* }
                }
            }
        };
        quote! { observer.fired(#index); { #bindings #iteration } observer.finished(#index); }
    }
}

/// The boundary node of a port.
fn boundary(body: &Graph, name: &str, kind: PortKind) -> NodeId {
    body.nodes
        .position(|n| n.name == name && matches!(n.kind, NodeKind::Boundary(k) if k == kind))
        .unwrap_or(NodeId::from(0))
}

/// Result of one element at an output, and `true` if it is an `Option`.
fn result(clusters: &[Emitter<'_>], output: NodeId) -> (TokenStream, bool) {
    let found = clusters.iter().find(|c| c.analysis.clusters[c.cluster].nodes.contains(&output));
    let Some((emitter, from)) = found.and_then(|c| Some((c, c.incoming(PortId { node: output, port: 0 })?))) else {
        return (quote!(None), true);
    };
    let name = emitter.generator.name(from);
    match emitter.plan.storage(from) {
        Storage::Argument => (emitter.generator.clone(emitter.graph, from, &quote!(#name)), false),
        Storage::MaybeArgument => (emitter.generator.cloned(emitter.graph, from, &quote!(#name)), true),
        Storage::Buffer => (emitter.generator.cloned(emitter.graph, from, &quote!(state.#name.get())), true),
        Storage::Array => (quote!(#name[0].take()), true),
        _ if emitter.plan.is_plain(from) => (quote!(#name), false),
        _ => (quote!(#name), true),
    }
}
