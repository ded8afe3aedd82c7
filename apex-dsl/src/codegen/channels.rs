//! The ports of a program whose tokens can be recorded.

use super::distinct::Distinct;
use crate::{
    analyse::{Analysis, Links, is_source},
    catalog::Catalog,
    graph::{Graph, NodeId, NodeKind, PortId, Standard},
    syntax::tree::PortKind,
    threads::Part,
};
use proc_macro2::TokenStream;
use quote::{format_ident, quote};
use std::{
    cell::RefCell,
    collections::{BTreeMap, BTreeSet, btree_map::Entry},
};

/// Role of a channel, named as in the runtime.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Role {
    Mailbox,
    Event,
    Source,
    Chosen,
    Port,
}

/// The ports of a program whose tokens can be recorded or observed, each with the number of its channel.
#[derive(Debug, Default)]
pub struct Channels {
    pub rows: Vec<(PortId, Role)>,
    /// The groups of threads, if there are several.
    groups: Vec<String>,
    /// Their numbers.
    pub numbers: BTreeMap<PortId, usize>,
    /// Types of tokens that generated code has asked a codec for.
    types: RefCell<Distinct>,
}

impl Channels {
    /// Those of a program, which runs on these threads if they are several.
    pub fn new(graph: &Graph, analysis: &Analysis, catalog: &Catalog, parts: &[Part]) -> Self {
        let groups = parts.iter().map(|part| part.group.clone()).collect();
        let mut channels = Self { groups, ..Self::default() };
        let comes_in = |kind| matches!(kind, PortKind::Input | PortKind::Slot);
        for node in graph.boundaries(comes_in) {
            channels.add(PortId { node, port: 0 }, Role::Mailbox);
        }
        for node in graph.boundaries(|kind| kind == PortKind::Event) {
            channels.add(PortId { node, port: 0 }, Role::Event);
        }
        for node in graph.nodes.ids().filter(|n| is_recorded(graph, analysis, catalog, *n)) {
            for end in source_ports(graph, &analysis.links, node) {
                channels.add(end, Role::Source);
            }
        }
        for end in graph.record.iter().flat_map(|record| &record.ports) {
            channels.add(*end, Role::Chosen);
        }
        let is_node = |end: &PortId| matches!(graph.nodes[end.node].kind, NodeKind::Library(_) | NodeKind::Each(_));
        let sending: BTreeSet<PortId> = graph.connections.iter().map(|c| c.from).filter(is_node).collect();
        for end in sending {
            channels.add(end, Role::Port);
        }
        channels
    }

    /// The functions that return the codecs and formats of token types.
    pub fn formats(&self) -> TokenStream {
        let types = self.types.borrow();
        let functions = types.rows().iter().enumerate().map(|(number, ty)| {
            let (codec, format) = (format_ident!("codec_{number}"), format_ident!("format_{number}"));
            quote! { ::apex_rt::__format!(#codec, #format, #ty); }
        });
        quote! { #(#functions)* }
    }

    /// The number of a type of tokens.
    pub fn type_number(&self, ty: TokenStream) -> usize {
        self.types.borrow_mut().number(ty)
    }

    fn add(&mut self, end: PortId, role: Role) {
        if let Entry::Vacant(entry) = self.numbers.entry(end) {
            entry.insert(self.rows.len());
            self.rows.push((end, role));
        }
    }

    /// The number of the group that a node belongs to: that of its part. Ports of the program belong to the main group.
    pub fn group(&self, graph: &Graph, node: NodeId) -> usize {
        let group = graph.group(node);
        self.groups.iter().position(|g| g == group).unwrap_or(0)
    }
}

/// Returns `true` if the tokens of a node come from outside of the program: it is a source, and not a computed one.
fn is_recorded(graph: &Graph, analysis: &Analysis, catalog: &Catalog, node: NodeId) -> bool {
    let NodeKind::Library(library) = &graph.nodes[node].kind else { return false };
    !catalog.signatures[library.signature].computed && is_source(graph, catalog, &analysis.links, node)
}

/// The ports by which a source itself sends.
fn source_ports<'a>(graph: &'a Graph, links: &'a Links, node: NodeId) -> impl Iterator<Item = PortId> + 'a {
    let sends = move |end: &PortId| {
        let all = links.out_of[node].iter().chain(&links.sends[node]);
        all.map(|c| graph.connections[*c].from).any(|from| from == *end)
    };
    let own = move |end: &PortId| {
        let port = graph.port(*end);
        port.kind.sends() && port.parameter.is_none() && matches!(port.standard, None | Some(Standard::Failed))
    };
    (0..graph.nodes[node].ports.len()).map(move |port| PortId { node, port }).filter(own).filter(sends)
}
