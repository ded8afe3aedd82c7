//! A region whose nodes fire at different rates: one iteration fires every node as often as the balance equations
//! say, through buffers of exactly the size that an iteration needs.

use super::{
    Generator,
    types::{ident, path},
};
use crate::{
    analyse::{Analysis, Links, handles_absence},
    catalog::{ArgSig, Signature},
    graph::{Graph, Library, NodeId, NodeKind, PortId},
    syntax::tree::PortKind,
};
use proc_macro2::TokenStream;
use quote::{format_ident, quote};

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
                    let (name, size) = (self.name(PortId { node, port }), count * p.rate);
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
                let (name, held) = (self.name(PortId { node, port: 1 }), self.held(node));
                let count = analysis.repetitions[node] as usize;
                let is_used = !analysis.links.out_of[node].is_empty();
                let keep = if is_used { quote!(#name[i] =) } else { quote!(let _ =) };
                quote! { for i in 0..#count { #keep state.#held.take_at(i); } }
            }
            NodeKind::Boundary(PortKind::Input) => {
                let (name, port) = (self.name(PortId { node, port: 0 }), ident(&n.name));
                quote! { #name[0] = inputs.#port.take(); }
            }
            _ => quote!(),
        }
    }

    fn fire_at_rate(&self, graph: &Graph, analysis: &Analysis, links: &Links, node: NodeId) -> TokenStream {
        let count = analysis.repetitions[node] as usize;
        let from = |port: usize| {
            links.into[node].iter().map(|c| &graph.connections[*c]).find(|c| c.to.port == port).map(|c| c.from)
        };
        match &graph.nodes[node].kind {
            NodeKind::Library(library) => {
                let signature = &self.catalog.signatures[library.signature];
                let code = self.call_at_rate(graph, links, node, library, signature, &from);
                let late = self.check_late(graph, node);
                quote! { for i in 0..#count { #code } #late }
            }
            NodeKind::Delay(_) => {
                let (held, Some(from)) = (self.held(node), from(0)) else {
                    return self.bug(graph.nodes[node].span, "nothing leads to the delay");
                };
                let name = self.name(from);
                let token = self.cloned(graph, from, &quote!(#name[i].as_ref()));
                quote! { for i in 0..#count { state.#held.put(#token); } }
            }
            NodeKind::Boundary(PortKind::Output) => {
                let (port, Some(from)) = (ident(&graph.nodes[node].name), from(0)) else {
                    return self.bug(graph.nodes[node].span, "nothing leads to the output");
                };
                let name = self.name(from);
                let store = self.store(graph, from, &quote!(outputs.#port), &quote!(#name[i].as_ref()));
                quote! { for i in 0..#count { #store } }
            }
            NodeKind::Probe => {
                let Some(end) = from(0) else { return quote!() };
                let name = self.name(end);
                let see = self.see(graph, node, end, &quote!(#name[i].as_ref()));
                quote! { for i in 0..#count { #see } }
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
        from: &dyn Fn(usize) -> Option<PortId>,
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
                    match (p.kind, from(port)) {
                        (PortKind::Input, Some(end)) if p.optional => {
                            let from = self.name(end);
                            quote!(#from[i].as_ref())
                        }
                        (PortKind::Input, None) => quote!(None),
                        (PortKind::Input, Some(end)) => {
                            let from = self.name(end);
                            let (name, rate) = (format_ident!("token_{}", p.name), p.rate);
                            let batched = signature.is_batched(port);
                            tokens.push(if batched {
                                let copy = self.copier(graph, end);
                                quote!(&::apex_rt::gather::<_, #rate>(&#from, i, #copy))
                            } else {
                                quote!(#from[i].as_ref())
                            });
                            names.push(name.clone());
                            quote!(#name)
                        }
                        (PortKind::Output, _) => {
                            let name = self.name(PortId { node, port });
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
        let sends = self.sends_at_rate(graph, links, node, library, call);
        let sends = self.recorded_at_rate(graph, node, sends);
        let told = if handles_absence(graph, self.catalog, node) {
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
        library: &Library,
        call: TokenStream,
    ) -> TokenStream {
        let signature = &self.catalog.signatures[library.signature];
        let returns = signature.returns;
        let failing = returns.fallible || graph.nodes[node].is_contained();
        let call = if failing { self.contained(graph, node, library, call, returns.fallible) } else { call };
        let value = match (failing, returns.maybe) {
            (true, true) => quote!(#call.flatten()),
            (true, false) | (false, true) => call.clone(),
            (false, false) => quote!(Some(#call)),
        };
        // What a node wrote in place before it failed counts for nothing.
        let written = (0..signature.ports.len()).map(|port| PortId { node, port });
        let written = written.filter(|end| failing && super::plan::is_buffer(graph, self.catalog, *end));
        let clears: Vec<_> = written.map(|end| self.name(end)).collect();
        let clear = (!clears.is_empty()).then(|| quote! { if sent.is_none() { #(state.#clears.clear();)* } });
        let used = |port: &usize| links.out_of[node].iter().any(|c| graph.connections[*c].from.port == *port);
        let outputs = (0..signature.ports.len()).filter(|p| signature.ports[*p].kind == PortKind::Output).filter(used);
        let mut puts = quote!();
        for port in outputs {
            let (name, p) = (self.name(PortId { node, port }), &signature.ports[port]);
            let token = if super::plan::is_buffer(graph, self.catalog, PortId { node, port }) {
                self.cloned(graph, PortId { node, port }, &quote!(state.#name.get()))
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
        if returns.value || failing {
            quote! { let sent = #value; #clear #puts }
        } else {
            quote! { #call; #puts }
        }
    }
}
