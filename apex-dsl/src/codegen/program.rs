//! The struct of a program: nodes, state, `new`, `react`, and the table that describes it.

use super::{
    generator::Generator,
    groups::group_info,
    structs::{Field, Struct, around_text, insert, node_structs, port_accessors},
    tokens::ident,
    view::{Lowered, ProgramView},
};
use crate::{
    analyse::{Analysis, Cluster},
    graph::{Graph, Library, NodeId, NodeKind, PortId},
    syntax::tree::PortKind,
};
use proc_macro2::TokenStream;
use quote::quote;
use std::collections::BTreeMap;
use syn::Ident;

impl Generator<'_> {
    /// All items of a program on one thread.
    pub fn program(&self, graph: &Graph, analysis: &Analysis) -> TokenStream {
        let name = self.program_name(graph);
        let lowered = Lowered::new(self, graph, analysis);
        let view = ProgramView::new(graph, analysis, &lowered);
        let items = self.items(view);
        let (own_react, react) = self.around(graph, self.react(view), &quote!(self));
        let recording = self.recording(graph);
        let (is_active, is_graph_active) = (self.is_active(view), self.is_graph_active(view));
        let waiting = self.waiting(view);
        let stop = self.stop(graph, analysis, &quote!(self));
        let clusters: Vec<Vec<NodeId>> = analysis.clusters.iter().map(Cluster::schedule).collect();
        // A single thread is only mentioned if something is said about it.
        let groups: Vec<TokenStream> = graph.threads.iter().map(|thread| group_info(graph, &thread.group)).collect();
        let info = self.info(graph, analysis, &clusters, &groups);
        let parameters = self.parameters(graph, analysis).implementation(&name, &|_| quote!(self.nodes));
        let mailboxes = self.port_mailboxes(graph, &quote!(self));
        quote! {
            #items
            #info
            impl #name {
                /// Reacts at `now`: runs until nothing is ready, and says when it wants to be called next.
                #[inline]
                pub fn react(&mut self, now: ::apex_rt::Time) -> ::apex_rt::Next { ::apex_rt::Program::react_with(self, now, &mut ()) }
                #own_react
            }
            impl ::apex_rt::Program for #name {
                const INFO: ::apex_rt::Info = INFO;
                #mailboxes
                #recording
                #react
                #is_active
                #is_graph_active
                #waiting
                #stop
            }
            #parameters
        }
    }

    /// Functions that react: `react_with` of `Program`, and, if the program is recorded, the function inside it.
    pub fn around(&self, graph: &Graph, react: TokenStream, ports: &TokenStream) -> (TokenStream, TokenStream) {
        match self.channels {
            Some(_) => (react, self.recorded_react(graph, Some(ports), &quote!(self.reaction(now, observer)))),
            None => (quote!(), react),
        }
    }

    /// The struct of a program or of a part of one, with all that it consists of, and the functions that fire its
    /// clusters and serve its slots.
    pub fn items(&self, view: ProgramView<'_>) -> TokenStream {
        let ProgramView { graph, analysis, .. } = view;
        let name = self.program_name(graph);
        let (mut fields, mut handed_in) = (BTreeMap::new(), vec![]);
        self.node_fields(graph, analysis, &mut fields, &mut handed_in);
        let nodes = node_structs(&self.item(graph, "Nodes"), &name, &fields, false);
        let [state, core] = self.state_structs(view);
        let ports = self.port_structs(graph);
        let docs = if graph.docs.is_empty() { format!("The graph `{}`.", graph.name) } else { graph.docs.clone() };
        let parts = self.parts_struct(graph, &handed_in);
        let (argument, default) = match &parts {
            Some((ty, _)) => (quote!(parts: #ty), quote!()),
            None => {
                (quote!(), quote! { impl ::core::default::Default for #name { fn default() -> Self { Self::new() } } })
            }
        };
        let parts_item = parts.map(|(_, item)| item);
        let place = quote!(self);
        let accessors =
            [nodes.accessor("The nodes, by instance name.", "nodes", &place), port_accessors(&ports, &place)];
        let fields = ["nodes", "state", "core", "inputs", "outputs", "events"].map(ident);
        let [inputs, outputs, events] = ports;
        let all = [nodes, state, core, inputs, outputs, events];
        let (types, makes, items) =
            (all.iter().map(|s| &s.ty), all.iter().map(|s| &s.make), all.iter().map(|s| &s.item));
        let (clusters, stop) = (self.clusters(view), self.stop_nodes(graph, analysis));
        let (dispatcher, claims, rows) = (self.dispatcher(view), self.claim_function(view), self.row_constants(view));
        let witnesses = self.witnesses(graph);
        let inner = around_text();
        quote! {
            #[doc = #docs]
            pub struct #name { #(#inner #fields: #types,)* }
            #parts_item
            #(#items)*
            impl #name {
                /// The program before its first reaction.
                pub fn new(#argument) -> Self { Self { #(#fields: #makes,)* } }
                #(#accessors)*
                #clusters
                #dispatcher
                #claims
                #stop
            }
            #default
            #rows
            #witnesses
        }
    }

    /// Type of the struct of nodes.
    pub fn nodes_type(&self, view: ProgramView<'_>) -> TokenStream {
        let (mut fields, mut handed_in) = (BTreeMap::new(), vec![]);
        self.node_fields(view.graph, view.analysis, &mut fields, &mut handed_in);
        let name = self.item(view.graph, "Nodes");
        if fields.is_empty() { quote!(()) } else { quote!(#name) }
    }

    /// The structs with the ports of a program: inputs and slots, outputs, events.
    pub fn port_structs(&self, graph: &Graph) -> [Struct; 3] {
        let inner = around_text();
        let of = |is_meant: &dyn Fn(PortKind) -> bool| -> Vec<(Ident, TokenStream)> {
            let ports = graph.boundaries(is_meant).into_iter();
            ports.map(|n| (ident(&graph.nodes[n].name), self.token_type(graph, PortId { node: n, port: 0 }))).collect()
        };
        let mailboxes = |ports: Vec<(Ident, TokenStream)>| -> Vec<(TokenStream, TokenStream)> {
            let field =
                |(name, ty)| (quote!(pub #name: ::apex_rt::Mailbox<#ty>), quote!(#name: ::apex_rt::Mailbox::new()));
            ports.into_iter().map(field).collect()
        };
        let outputs = of(&|kind| kind == PortKind::Output).into_iter();
        let outputs = outputs.map(|(name, ty)| (quote!(pub #name: ::core::option::Option<#ty>), quote!(#name: None)));
        let probes = graph.nodes.ids().filter(|n| graph.nodes[*n].kind.is_probe()).map(|n| {
            let (name, ty) = (self.probe(n), self.token_type(graph, PortId { node: n, port: 0 }));
            let make = quote!(#name: ::apex_rt::testing::Probe::new());
            (quote!(#inner #name: ::apex_rt::testing::Probe<#ty>), make)
        });
        let outputs: Vec<_> = outputs.chain(probes).collect();
        let inputs = mailboxes(of(&|kind| matches!(kind, PortKind::Input | PortKind::Slot)));
        let events = mailboxes(of(&|kind| kind == PortKind::Event));
        let held_back = "Events that wait to be taken. As long as one waits, what triggers it is held back.";
        [
            Struct::new(&self.item(graph, "Inputs"), "Where tokens are put in.", &inputs),
            Struct::new(&self.item(graph, "Outputs"), "The tokens that came out last; `None` is ⊥.", &outputs),
            Struct::new(&self.item(graph, "Events"), held_back, &events),
        ]
    }

    /// Items of `Program` for the mailboxes of the ports, which are kept at `place`.
    pub fn port_mailboxes(&self, graph: &Graph, place: &TokenStream) -> TokenStream {
        let [Struct { ty: inputs, .. }, _, Struct { ty: events, .. }] = self.port_structs(graph);
        let names = graph.boundaries(|kind| kind == PortKind::Event).into_iter().map(|n| graph.nodes[n].name.as_str());
        let names: Vec<&str> = names.collect();
        let fields = names.iter().map(|name| ident(name));
        let untaken = (!names.is_empty()).then(|| {
            quote! {
                fn untaken(&self) -> ::core::option::Option<(&'static str, ::apex_rt::Arrival)> {
                    ::apex_rt::untaken(&[#((#names, #place.events.#fields.arrival())),*])
                }
            }
        });
        quote! {
            type Inputs = #inputs;
            type Events = #events;
            fn mailboxes(&mut self) -> (&mut #inputs, &mut #events) { (&mut #place.inputs, &mut #place.events) }
            #untaken
        }
    }

    /// The struct of the nodes that are made in Rust, and its name; `None` if there are none.
    pub fn parts_struct(&self, graph: &Graph, handed_in: &[(Ident, TokenStream)]) -> Option<(Ident, TokenStream)> {
        if handed_in.is_empty() {
            return None;
        }
        let (names, types): (Vec<&Ident>, Vec<&TokenStream>) = handed_in.iter().map(|(name, ty)| (name, ty)).unzip();
        let (name, doc) =
            (self.item(graph, "Parts"), format!(" The nodes of [`{}`] that are made in Rust.", graph.name));
        let item = quote! {
            #[doc = #doc]
            pub struct #name { #(pub #names: #types,)* }
        };
        Some((name, item))
    }

    /// Field of a node of the catalog: `nodes.fast.planner`.
    pub fn node_place(&self, graph: &Graph, node: NodeId) -> TokenStream {
        let segments = self.node_path(graph, node);
        let segments = segments.iter().map(|s| ident(s));
        quote!(nodes #(.#segments)*)
    }

    /// The fields on the way to a node of the catalog.
    pub fn node_path(&self, graph: &Graph, node: NodeId) -> Vec<String> {
        let own = graph.path(node);
        let mut segments: Vec<String> = match self.outer {
            Some((outer, each, generator)) => generator.node_path(outer, each),
            None => vec![],
        };
        // `each` on a single node: the node itself has the name of the instance.
        let single = graph.is_body && segments.last() == Some(&own);
        if !single {
            segments.extend(own.split('.').map(str::to_owned));
        }
        segments
    }

    /// The field of the struct of parts for a node that Rust makes: `fast_planner`. Where another node has the same,
    /// the later one ends in `_`.
    fn part_field(&self, graph: &Graph, node: NodeId, handed_in: &[(Ident, TokenStream)]) -> Ident {
        let mut name = self.node_path(graph, node).join("_");
        while handed_in.iter().any(|(other, _)| *other == ident(&name)) {
            name.push('_');
        }
        ident(&name)
    }

    /// The fields of nodes, and those nodes that Rust makes.
    pub fn node_fields(
        &self,
        graph: &Graph,
        analysis: &Analysis,
        fields: &mut BTreeMap<String, Field>,
        handed_in: &mut Vec<(Ident, TokenStream)>,
    ) {
        for (id, node) in graph.nodes.iter_enumerated() {
            match &node.kind {
                NodeKind::Library(library) if !self.catalog.signatures[library.signature].is_function => {
                    let ty = self.node_type(graph, library);
                    let make = if library.handed_in {
                        let part = self.part_field(graph, id, handed_in);
                        handed_in.push((part.clone(), ty.clone()));
                        quote!(parts.#part)
                    } else {
                        self.make(graph, id, library)
                    };
                    insert(fields, &self.node_path(graph, id), Field::Node { ty, make });
                }
                NodeKind::Each(each) => {
                    if let Some(body) = analysis.bodies.get(&id) {
                        self.inside(graph, id).node_fields(&each.body, body, fields, handed_in);
                    }
                }
                _ => {}
            }
        }
    }

    /// Creates a node again, unless Rust made it. Its parameters stay as they are: they are settings, not state.
    pub fn remake(&self, graph: &Graph, node: NodeId) -> TokenStream {
        let NodeKind::Library(library) = &graph.nodes[node].kind else { return quote!() };
        if library.handed_in || self.catalog.signatures[library.signature].is_function {
            return quote!();
        }
        let (place, make) = (self.node_place(graph, node), self.make(graph, node, library));
        let ty = self.node_type(graph, library);
        let keeps = (0..library.params.len()).map(|param| {
            quote! { ::core::mem::swap(::apex_rt::ParamField::<#param>::field(&mut #place), ::apex_rt::ParamField::<#param>::field(&mut made)); }
        });
        let mutable = (!library.params.is_empty()).then(|| quote!(mut));
        quote! { let #mutable made: #ty = #make; #(#keeps)* #place = made; }
    }

    fn make(&self, graph: &Graph, node: NodeId, library: &Library) -> TokenStream {
        let params = (0..library.params.len()).map(|param| self.argument(graph, node, library, param));
        self.construct(graph, node, library, &params.collect::<Vec<_>>())
    }

    /// Function that tells if a node is active, by its index.
    pub fn is_active(&self, view: ProgramView<'_>) -> TokenStream {
        let states = self.is_in_state(view);
        let is_active = match view.analysis.active.iter().all(|node| view.graph.nodes[*node].is_delay()) {
            true if states.is_empty() => return quote!(),
            true => quote!(false),
            false => quote!(self.core.active.has(node)),
        };
        let is_active = match states.is_empty() {
            true => is_active,
            false => quote! { match node { #states _ => #is_active } },
        };
        quote! { fn is_active(&self, node: usize) -> bool { #is_active } }
    }
}
