//! The struct of a program: nodes, state, `new`, `react`, and the table that describes it.

use super::{
    Generator,
    activity::Whole,
    state,
    threads::{end_if_hung, group_info},
    types::ident,
    wiring::Wiring,
};
use crate::{
    analyse::{Analysis, Cluster},
    graph::{End, Graph, Library, NodeId, NodeKind, camel},
    syntax::tree::PortKind,
};
use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};
use std::collections::{BTreeMap, BTreeSet};
use syn::Ident;

/// The mailboxes of a program, which are those of the struct `name` at `place`.
pub fn mailboxes(name: &str, place: &TokenStream) -> TokenStream {
    let (inputs, events) = (format_ident!("{name}Inputs"), format_ident!("{name}Events"));
    quote! {
        type Inputs = #inputs;
        type Events = #events;
        fn mailboxes(&mut self) -> (&mut #inputs, &mut #events) { (&mut #place.inputs, &mut #place.events) }
    }
}

/// A field of the struct of nodes: a node, or the nodes of a nested graph.
pub enum Field {
    Node { ty: TokenStream, make: TokenStream },
    Nested(BTreeMap<String, Field>),
}

impl Generator<'_> {
    /// All items of a program on one thread.
    pub fn program(&self, graph: &Graph, analysis: &Analysis) -> TokenStream {
        let name = ident(&graph.name);
        let wiring = Wiring::new(self, graph, analysis);
        let whole = Whole::new(graph, analysis, &wiring);
        let items = self.items(whole);
        let (own_react, react) = self.around(graph, self.react(whole), &quote!(self));
        let recording = self.recording(graph);
        let (is_active, is_graph_active) = (self.is_active(whole), self.is_graph_active(whole));
        let waiting = self.waiting(whole);
        let clusters: Vec<Vec<NodeId>> = analysis.clusters.iter().map(Cluster::schedule).collect();
        // A single thread is only mentioned if something is said about it.
        let groups: Vec<TokenStream> = graph.threads.iter().map(|thread| group_info(graph, &thread.group)).collect();
        let info = self.info(graph, analysis, &clusters, &groups);
        let parameters = self.parameters(graph, analysis, &|_| quote!(self.nodes));
        let mailboxes = mailboxes(&graph.name, &quote!(self));
        quote! {
            #items
            impl #name {
                /// Reacts at `now`: runs until nothing is ready, and says when it wants to be called next.
                #[inline]
                pub fn react(&mut self, now: ::apex_rt::Time) -> ::apex_rt::Next { ::apex_rt::Program::react_with(self, now, &mut ()) }
                #own_react
            }
            impl ::apex_rt::Program for #name {
                const INFO: ::apex_rt::Info = #info;
                #mailboxes
                #recording
                #react
                #is_active
                #is_graph_active
                #waiting
            }
            #parameters
        }
    }

    /// How a program reacts: in a function of its own if it is recorded, and as `Program` knows it.
    pub fn around(&self, graph: &Graph, react: TokenStream, ports: &TokenStream) -> (TokenStream, TokenStream) {
        match self.channels {
            Some(_) => (react, self.recorded_react(graph, ports)),
            None => (quote!(), react),
        }
    }

    /// The struct of a program or of a part of one, with all that it consists of, and the functions that fire its clusters and
    /// serve its slots.
    pub fn items(&self, whole: Whole<'_>) -> TokenStream {
        let Whole { graph, analysis, .. } = whole;
        let name = ident(&graph.name);
        let mut fields = BTreeMap::new();
        let mut handed_in = vec![];
        self.node_fields(graph, analysis, &mut fields, &mut handed_in);
        let (nodes_items, nodes_make) = node_structs(&format!("{}Nodes", graph.name), &fields, false);
        let (state_fields, state_make) = state::fields(&self.state(whole));
        let comes_in = |kind| matches!(kind, PortKind::Input | PortKind::Slot);
        let inputs = boundaries(graph, comes_in);
        let outputs = boundaries(graph, |kind| kind == PortKind::Output);
        let events = boundaries(graph, |kind| kind == PortKind::Event);
        let (nodes_name, state_name) = (format_ident!("{}Nodes", name), format_ident!("{}State", name));
        let (inputs_name, outputs_name, parts_name) =
            (format_ident!("{}Inputs", name), format_ident!("{}Outputs", name), format_ident!("{}Parts", name));
        let events_name = format_ident!("{}Events", name);
        let port_types = |ports: &[NodeId]| -> Vec<TokenStream> {
            ports.iter().map(|n| self.token_type(graph, End { node: *n, port: 0 })).collect()
        };
        let port_names =
            |ports: &[NodeId]| -> Vec<Ident> { ports.iter().map(|n| ident(&graph.nodes[*n].name)).collect() };
        let (input_names, input_types) = (port_names(&inputs), port_types(&inputs));
        let (output_names, output_types) = (port_names(&outputs), port_types(&outputs));
        let probes: Vec<NodeId> = (0..graph.nodes.len()).filter(|n| graph.nodes[*n].kind.is_probe()).collect();
        let (probe_names, probe_types): (Vec<Ident>, Vec<TokenStream>) =
            (probes.iter().map(|n| self.probe(*n)).collect(), port_types(&probes));
        let (event_names, event_types) = (port_names(&events), port_types(&events));
        let (part_names, part_types): (Vec<Ident>, Vec<TokenStream>) = handed_in.into_iter().unzip();
        let docs = if graph.docs.is_empty() { format!("The graph `{}`.", graph.name) } else { graph.docs.clone() };
        let (new_args, parts_item, default) = if part_names.is_empty() {
            let default = quote! { impl ::core::default::Default for #name { fn default() -> Self { Self::new() } } };
            (quote!(), quote!(), default)
        } else {
            let doc = format!("The nodes of [`{}`] that are made in Rust.", graph.name);
            let item = quote! {
                #[doc = #doc]
                pub struct #parts_name { #(pub #part_names: #part_types,)* }
            };
            (quote!(parts: #parts_name), item, quote!())
        };
        let clusters = self.clusters(whole);
        let (dispatcher, claims) = (self.dispatcher(whole), self.claim_function(whole));
        let witnesses = self.witnesses(graph);
        let inner = around_text();
        quote! {
            #[doc = #docs]
            pub struct #name {
                #inner nodes: #nodes_name,
                #inner state: #state_name,
                #inner inputs: #inputs_name,
                #inner outputs: #outputs_name,
                #inner events: #events_name,
            }
            #parts_item
            #nodes_items
            #[doc = "Where tokens are put in."]
            pub struct #inputs_name { #(pub #input_names: ::apex_rt::Mailbox<#input_types>,)* }
            #[doc = "The tokens that came out last; `None` is ⊥."]
            pub struct #outputs_name {
                #(pub #output_names: ::core::option::Option<#output_types>,)*
                #(#inner #probe_names: ::apex_rt::testing::Probe<#probe_types>,)*
            }
            #[doc = "Events that wait to be taken. As long as one waits, what triggers it is held back."]
            pub struct #events_name { #(pub #event_names: ::apex_rt::Mailbox<#event_types>,)* }
            #inner struct #state_name { #state_fields }
            #witnesses
            impl #name {
                /// The program before its first reaction.
                pub fn new(#new_args) -> Self {
                    Self {
                        nodes: #nodes_make,
                        state: #state_name { #state_make },
                        inputs: #inputs_name { #(#input_names: ::apex_rt::Mailbox::new(),)* },
                        outputs: #outputs_name { #(#output_names: None,)* #(#probe_names: ::apex_rt::testing::Probe::new(),)* },
                        events: #events_name { #(#event_names: ::apex_rt::Mailbox::new(),)* },
                    }
                }
                /// The nodes, by instance name.
                pub fn nodes(&self) -> &#nodes_name { &self.nodes }
                /// The graph-level inputs and slots.
                pub fn inputs(&mut self) -> &mut #inputs_name { &mut self.inputs }
                /// The graph-level outputs.
                pub fn outputs(&self) -> &#outputs_name { &self.outputs }
                /// The graph-level events.
                pub fn events(&mut self) -> &mut #events_name { &mut self.events }
                #clusters
                #dispatcher
                #claims
            }
            #default
        }
    }

    /// Where a node of the catalog is kept: `nodes.fast.planner`.
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

    /// The field of the struct of parts for a node that Rust makes: `fast_planner`. Where another node has the same, the later one
    /// ends in `_`.
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
        for (id, node) in graph.nodes.iter().enumerate() {
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

    /// Makes a node anew, unless Rust made it. Its parameters stay as they are: they are settings, not state.
    pub fn remake(&self, graph: &Graph, node: NodeId, library: &Library) -> TokenStream {
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

    /// Whether a node is active, by its index.
    pub fn is_active(&self, whole: Whole<'_>) -> TokenStream {
        if whole.analysis.active.is_empty() {
            return quote!();
        }
        if whole.analysis.active.iter().all(|node| whole.graph.nodes[*node].is_delay()) {
            return quote!();
        }
        quote! { fn is_active(&self, node: usize) -> bool { self.state.active.has(node) } }
    }

    /// The table that describes a program. `clusters` has the numbers of their nodes.
    pub fn info(
        &self,
        graph: &Graph,
        analysis: &Analysis,
        clusters: &[Vec<NodeId>],
        groups: &[TokenStream],
    ) -> TokenStream {
        let name = &graph.name;
        let (mut nodes, mut connections) = (vec![], vec![]);
        self.rows(graph, analysis, "", &mut nodes, &mut connections);
        let claims = graph.claims.iter().map(|claim| graph.claim_text(claim));
        let end_if_hung = end_if_hung(graph);
        let graphs = (1..graph.scopes.len()).map(|scope| graph.scope_path(scope));
        let clusters = clusters.iter().map(|nodes| {
            let nodes = nodes.iter().copied().map(Literal::usize_unsuffixed);
            quote!(&[#(#nodes),*])
        });
        quote! {
            ::apex_rt::Info { name: #name, nodes: &[#(#nodes),*], graphs: &[#(#graphs),*], connections: &[#(#connections),*], clusters: &[#(#clusters),*], groups: &[#(#groups),*], end_if_hung: #end_if_hung, claims: &[#(#claims),*] }
        }
    }

    fn rows(
        &self,
        graph: &Graph,
        analysis: &Analysis,
        prefix: &str,
        nodes: &mut Vec<TokenStream>,
        connections: &mut Vec<TokenStream>,
    ) {
        for (id, node) in graph.nodes.iter().enumerate() {
            let (name, kind) = (format!("{prefix}{}", graph.path(id)), kind(self, node));
            let c = analysis.characteristics[id];
            let (required, siblings) = (c.required, c.siblings);
            nodes.push(quote!(::apex_rt::NodeInfo::new(#name, #kind, #required, #siblings)));
        }
        for c in &graph.connections {
            let (from, to) =
                (Literal::usize_unsuffixed(self.index(c.from.node)), Literal::usize_unsuffixed(self.index(c.to.node)));
            let (output, input) = (&graph.port(c.from).name, &graph.port(c.to).name);
            connections.push(quote!(::apex_rt::ConnectionInfo::new(#from, #output, #to, #input)));
        }
        for (id, node) in graph.nodes.iter().enumerate() {
            if let (NodeKind::Each(each), Some(body)) = (&node.kind, analysis.bodies.get(&id)) {
                let prefix = format!("{prefix}{}.", graph.path(id));
                self.inside(graph, id).rows(&each.body, body, &prefix, nodes, connections);
            }
        }
    }
}

fn kind(generator: &Generator<'_>, node: &crate::graph::Node) -> String {
    match &node.kind {
        NodeKind::Library(library) => generator.catalog.signatures[library.signature].name.clone(),
        NodeKind::Each(each) => format!("each {}", each.body.name),
        NodeKind::Boundary(kind) => kind.word().to_owned(),
        NodeKind::Delay(_) => "delay".to_owned(),
        NodeKind::Relay => "relay".to_owned(),
        NodeKind::Probe => "probe".to_owned(),
        NodeKind::Start => "start".to_owned(),
        NodeKind::Hung => "hung".to_owned(),
        NodeKind::Exit(_) => "exit".to_owned(),
        NodeKind::Reset => "reset".to_owned(),
        NodeKind::Sender(_) | NodeKind::Receiver(_) => "cell".to_owned(),
    }
}

/// The ports of the graph itself that are meant.
pub fn boundaries(graph: &Graph, is_meant: impl Fn(PortKind) -> bool) -> Vec<NodeId> {
    (0..graph.nodes.len()).filter(|n| matches!(graph.nodes[*n].kind, NodeKind::Boundary(k) if is_meant(k))).collect()
}

/// Puts a field where its path leads.
pub fn insert(fields: &mut BTreeMap<String, Field>, path: &[String], field: Field) {
    match path {
        [name] => {
            fields.insert(name.clone(), field);
        }
        [first, rest @ ..] => {
            if let Field::Nested(inner) = fields.entry(first.clone()).or_insert_with(|| Field::Nested(BTreeMap::new()))
            {
                insert(inner, rest, field);
            }
        }
        [] => {}
    }
}

/// The visibility of what belongs to a program alone: where the call of `graph!` stands, it can be looked at. A program
/// has a module of its own ([`super::Modules`]) in the one of its text.
pub fn around_text() -> TokenStream {
    quote!(pub(in super::super))
}

/// The struct of a level of nodes with all below it, and the expression that makes it.
///
/// If `borrowed`, it has references to nodes that are kept elsewhere.
pub fn node_structs(name: &str, fields: &BTreeMap<String, Field>, borrowed: bool) -> (TokenStream, TokenStream) {
    let mut used = BTreeSet::from([name.to_owned()]);
    node_struct(name, fields, borrowed, &mut used)
}

fn node_struct(
    name: &str,
    fields: &BTreeMap<String, Field>,
    borrowed: bool,
    used: &mut BTreeSet<String>,
) -> (TokenStream, TokenStream) {
    let struct_name = ident(name);
    let (mut items, mut declared, mut made) = (quote!(), quote!(), quote!());
    let life = borrowed.then(|| quote!(<'a>));
    // There may be no node.
    let phantom = borrowed.then(|| quote! { life: ::core::marker::PhantomData<&'a ()>, });
    let phantom_made = borrowed.then(|| quote! { life: ::core::marker::PhantomData, });
    for (field, content) in fields {
        let field_name = ident(field);
        match content {
            Field::Node { ty, make } => {
                declared.extend(quote! { pub #field_name: #ty, });
                made.extend(quote! { #field_name: #make, });
            }
            Field::Nested(inner) => {
                // `a` with `b` inside and `a_b` would have the same name.
                let inner_name = super::unused(format!("{name}{}", camel(field)), used);
                let (inner_items, inner_make) = node_struct(&inner_name, inner, borrowed, used);
                let inner_type = ident(&inner_name);
                items.extend(inner_items);
                declared.extend(quote! { pub #field_name: #inner_type #life, });
                made.extend(quote! { #field_name: #inner_make, });
            }
        }
    }
    let item = quote! {
        pub struct #struct_name #life { #declared #phantom }
        #items
    };
    (item, quote!(#struct_name { #made #phantom_made }))
}
