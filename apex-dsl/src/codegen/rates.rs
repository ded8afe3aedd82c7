//! A region whose nodes fire at different rates: one iteration fires every node as often as the balance equations
//! say, through buffers of exactly the size that an iteration needs.

use super::{
    Generator,
    activity::Whole,
    types::{ident, path},
};
use crate::{
    analyse::{Analysis, Links, is_told},
    catalog::{ArgSig, Signature},
    graph::{End, Graph, Library, NodeId, NodeKind},
    report::{Diagnostic, Diagnostics},
    syntax::tree::PortKind,
};
use proc_macro2::TokenStream;
use quote::{format_ident, quote};
use std::collections::BTreeSet;

/// Whether a cluster has more than one rate.
pub fn is_multirate(graph: &Graph, analysis: &Analysis, cluster: usize) -> bool {
    let region = analysis.clusters[cluster].region;
    (0..graph.nodes.len()).any(|n| analysis.regions[n] == region && has_rates(graph, analysis, n))
}

fn has_rates(graph: &Graph, analysis: &Analysis, node: NodeId) -> bool {
    analysis.repetitions[node] != 1 || graph.nodes[node].ports.iter().any(|p| p.rate != 1 && p.kind.is_synchronous())
}

/// What cannot be generated for a region with several rates.
pub fn check(graph: &Graph, analysis: &Analysis, diagnostics: &mut Diagnostics) {
    let regions: BTreeSet<usize> =
        (0..graph.nodes.len()).filter(|n| has_rates(graph, analysis, *n)).map(|n| analysis.regions[n]).collect();
    for (index, cluster) in analysis.clusters.iter().enumerate().filter(|(_, c)| regions.contains(&c.region)) {
        let first = cluster.nodes.iter().min().copied().unwrap_or(0);
        if !cluster.upstream.is_empty() || !cluster.downstream.is_empty() {
            let message = "a region with several rates can have only one source with a pace of its own";
            diagnostics.push(Diagnostic::error("rates", graph.nodes[first].span, message));
        }
        for &node in &analysis.clusters[index].nodes {
            let n = &graph.nodes[node];
            let count = analysis.repetitions[node];
            let message = match &n.kind {
                NodeKind::Boundary(PortKind::Input) if count > 1 && !graph.is_body => {
                    format!("one iteration would take {count} tokens from the input `{}`, which holds one", n.name)
                }
                _ if graph
                    .connections
                    .iter()
                    .any(|c| (c.active || !graph.is_synchronous(c)) && (c.from.node == node || c.to.node == node)) =>
                {
                    format!(
                        "`{}` fires in a region with several rates: it can have neither events and slots nor active connections",
                        n.name
                    )
                }
                NodeKind::Each(_) => format!("`each` cannot stand in a region with several rates; `{}` does", n.name),
                NodeKind::Boundary(_) if graph.is_body => "the body of an `each` has one rate".to_owned(),
                NodeKind::Delay(initial) if (initial.len() as u64) < count => {
                    format!(
                        "a delay in a region with several rates holds at least the tokens of one iteration: {count}, not {}",
                        initial.len()
                    )
                }
                NodeKind::Library(_)
                    if n.ports.iter().any(|p| p.parameter.is_some() && is_connected(graph, node, p.parameter)) =>
                {
                    format!("parameters of `{}` cannot be connected in a region with several rates", n.name)
                }
                _ => continue,
            };
            diagnostics.push(Diagnostic::error("rates", n.span, message));
        }
    }
}

fn is_connected(graph: &Graph, node: NodeId, parameter: Option<usize>) -> bool {
    let at = |end: End| end.node == node && graph.port(end).parameter == parameter;
    graph.connections.iter().any(|c| at(c.from) || at(c.to))
}

impl Generator<'_> {
    /// The code of a cluster with several rates.
    pub fn rates(&self, graph: &Graph, analysis: &Analysis, links: &Links, cluster: usize) -> TokenStream {
        let nodes = &analysis.clusters[cluster].nodes;
        let buffers = nodes.iter().flat_map(|&node| {
            let count = analysis.repetitions[node] as usize;
            let outputs = graph.nodes[node]
                .ports
                .iter()
                .enumerate()
                .filter(|(_, p)| p.kind == PortKind::Output && p.parameter.is_none());
            outputs
                .filter(move |(port, _)| links.out_of[node].iter().any(|c| graph.connections[*c].from.port == *port))
                .map(move |(port, p)| {
                    let (name, size) = (self.name(End { node, port }), count * p.rate);
                    quote! { let mut #name = ::core::array::from_fn::<_, #size, _>(|_| None); }
                })
        });
        let reads = nodes.iter().map(|&node| self.read(graph, analysis, node));
        let fires = nodes.iter().map(|&node| self.fire_at_rate(graph, analysis, links, node));
        quote! { #(#buffers)* #(#reads)* #(#fires)* }
    }

    fn read(&self, graph: &Graph, analysis: &Analysis, node: NodeId) -> TokenStream {
        let n = &graph.nodes[node];
        match n.kind {
            NodeKind::Delay(_) => {
                let name = self.name(End { node, port: 1 });
                let count = analysis.repetitions[node] as usize;
                let held = self.held(node);
                quote! { for i in 0..#count { #name[i] = state.#held.take_at(i); } }
            }
            NodeKind::Boundary(PortKind::Input) => {
                let (name, port) = (self.name(End { node, port: 0 }), ident(&n.name));
                quote! { #name[0] = inputs.#port.take(); }
            }
            _ => quote!(),
        }
    }

    fn fire_at_rate(&self, graph: &Graph, analysis: &Analysis, links: &Links, node: NodeId) -> TokenStream {
        let count = analysis.repetitions[node] as usize;
        let source = |port: usize| {
            links.into[node]
                .iter()
                .map(|c| &graph.connections[*c])
                .find(|c| c.to.port == port)
                .map(|c| self.name(c.from))
        };
        match &graph.nodes[node].kind {
            NodeKind::Library(library) => {
                let signature = &self.catalog.signatures[library.signature];
                let code = self.call_at_rate(graph, links, node, library, signature, &source);
                let late = self.check_late(Whole { graph, analysis, links }, node);
                quote! { for i in 0..#count { #code } #late }
            }
            NodeKind::Delay(_) => {
                let (held, from) = (self.held(node), source(0));
                quote! { for i in 0..#count { state.#held.put(#from[i].clone()); } }
            }
            NodeKind::Boundary(PortKind::Output) => {
                let (port, from) = (ident(&graph.nodes[node].name), source(0));
                quote! { for i in 0..#count { ::apex_rt::store(&mut outputs.#port, #from[i].as_ref()); } }
            }
            _ => quote!(),
        }
    }

    /// One firing: tests its tokens, calls the node, and puts what it sends into the buffers.
    fn call_at_rate(
        &self,
        graph: &Graph,
        links: &Links,
        node: NodeId,
        library: &Library,
        signature: &Signature,
        source: &dyn Fn(usize) -> Option<syn::Ident>,
    ) -> TokenStream {
        let Some(args) = &signature.process else { return quote!() };
        let index = self.index(node);
        let (mut names, mut tokens) = (vec![], vec![]);
        let args: Vec<TokenStream> = args
            .iter()
            .map(|arg| match *arg {
                ArgSig::Ctx => quote!(ctx),
                ArgSig::Param(param) => self.param_value(graph, library, param),
                ArgSig::Port(port) => {
                    let p = &signature.ports[port];
                    match (p.kind, source(port)) {
                        (PortKind::Input, Some(from)) if p.optional => quote!(#from[i].as_ref()),
                        (PortKind::Input, None) => quote!(None),
                        (PortKind::Input, Some(from)) => {
                            let (name, rate) = (format_ident!("token_{}", p.name), p.rate);
                            let batched = signature.is_batched(port);
                            tokens.push(if batched {
                                quote!(&::apex_rt::gather::<_, #rate>(&#from, i))
                            } else {
                                quote!(#from[i].as_ref())
                            });
                            names.push(name.clone());
                            quote!(#name)
                        }
                        (PortKind::Output, _) => {
                            let name = self.name(End { node, port });
                            quote!(state.#name.begin())
                        }
                        _ => quote!(::apex_rt::Event::unconnected()),
                    }
                }
            })
            .collect();
        let call = if signature.is_function {
            let function = path(&signature.path);
            quote!(#function(#(#args),*))
        } else {
            let place = self.node_place(graph, node);
            quote!(#place.process(#(#args),*))
        };
        let sends = self.sends_at_rate(graph, links, node, signature, call, index);
        let sends = self.recorded_at_rate(graph, node, sends);
        let told = if is_told(graph, self.catalog, node) {
            let (place, method) =
                (self.node_place(graph, node), ident(signature.no_message.as_deref().unwrap_or_default()));
            quote! { else { observer.fired(#index); #place.#method(); observer.finished(#index); } }
        } else {
            quote!()
        };
        match names.as_slice() {
            [] => quote! { observer.fired(#index); #sends observer.finished(#index); },
            _ => {
                quote! { if let (#(Some(#names),)*) = (#(#tokens,)*) { observer.fired(#index); #sends observer.finished(#index); } #told }
            }
        }
    }

    fn sends_at_rate(
        &self,
        graph: &Graph,
        links: &Links,
        node: NodeId,
        signature: &Signature,
        call: TokenStream,
        index: usize,
    ) -> TokenStream {
        let returns = signature.returns;
        let value = match (returns.fallible, returns.maybe) {
            (true, true) => quote!(::apex_rt::sent(#call, #index, observer).flatten()),
            (true, false) => quote!(::apex_rt::sent(#call, #index, observer)),
            (false, true) => quote!(#call),
            (false, false) => quote!(Some(#call)),
        };
        let used = |port: &usize| links.out_of[node].iter().any(|c| graph.connections[*c].from.port == *port);
        let outputs = (0..signature.ports.len()).filter(|p| signature.ports[*p].kind == PortKind::Output).filter(used);
        let mut puts = quote!();
        for port in outputs {
            let (name, p) = (self.name(End { node, port }), &signature.ports[port]);
            let token = if super::plan::is_buffer(graph, self.catalog, End { node, port }) {
                quote!(state.#name.get().cloned())
            } else if let Some((_, field)) = &p.field {
                let field = ident(field);
                if p.field_is_option {
                    quote!(sent.as_ref().and_then(|sent| sent.#field.clone()))
                } else {
                    quote!(sent.as_ref().map(|sent| sent.#field.clone()))
                }
            } else {
                quote!(sent)
            };
            puts.extend(if signature.is_batched(port) {
                quote! { if let Some(tokens) = #token { ::apex_rt::spread(&mut #name, i, tokens); } }
            } else {
                quote! { #name[i] = #token; }
            });
        }
        if returns.value || returns.fallible {
            quote! { let sent = #value; #puts }
        } else {
            quote! { #call; #puts }
        }
    }
}
