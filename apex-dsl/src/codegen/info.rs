//! The table that describes a program.

use super::{distinct::Distinct, generator::Generator, groups::end_if_hung, tokens::nanos};
use crate::{
    analyse::Analysis,
    catalog::{first_sentence, linkless},
    graph::{Graph, Node, NodeId, NodeKind},
    machine::machines,
    source::{FileId, Span},
    syntax::tree::PortKind,
};
use proc_macro2::{Literal, TokenStream};
use quote::quote;

/// Rows of the tables of a program.
#[derive(Default)]
struct Rows {
    nodes: Vec<TokenStream>,
    connections: Vec<TokenStream>,
    kinds: Distinct,
    /// The source files of the nodes.
    files: Vec<FileId>,
}

impl Generator<'_> {
    /// The tables that describe a program. `clusters` has the numbers of their nodes.
    pub fn info(
        &self,
        graph: &Graph,
        analysis: &Analysis,
        clusters: &[Vec<NodeId>],
        groups: &[TokenStream],
    ) -> TokenStream {
        let (name, docs) = (&graph.name, &graph.docs);
        let mut rows = Rows::default();
        self.rows(graph, analysis, "", &mut rows);
        self.state_rows(graph, &mut rows);
        let Rows { nodes, connections, kinds, files } = rows;
        let files = files.iter().map(|file| self.sources.get(*file).path.display().to_string());
        let kinds = kinds.rows();
        let claims = graph.claims.iter().map(|claim| graph.claim_text(claim));
        let end_if_hung = end_if_hung(graph);
        let graphs = graph.nested().map(|scope| graph.scope_path(scope));
        let clusters = clusters.iter().map(|nodes| {
            let nodes = nodes.iter().map(|node| Literal::usize_unsuffixed(node.index()));
            quote!(&[#(#nodes),*])
        });
        quote! {
            const NODES: &'static [::apex_rt::NodeInfo] = &[#(#nodes),*];
            const KINDS: &'static [::apex_rt::KindInfo] = &[#(#kinds),*];
            const CONNECTIONS: &'static [::apex_rt::ConnectionInfo] = &[#(#connections),*];
            const INFO: ::apex_rt::Info = ::apex_rt::Info {
                name: #name,
                docs: #docs,
                files: &[#(#files),*],
                nodes: NODES,
                kinds: KINDS,
                graphs: &[#(#graphs),*],
                connections: CONNECTIONS,
                clusters: &[#(#clusters),*],
                groups: &[#(#groups),*],
                end_if_hung: #end_if_hung,
                claims: &[#(#claims),*],
            };
        }
    }

    fn rows(&self, graph: &Graph, analysis: &Analysis, prefix: &str, rows: &mut Rows) {
        for (id, node) in graph.nodes.iter_enumerated() {
            let name = format!("{prefix}{}", graph.path(id));
            let kind = Literal::usize_unsuffixed(rows.kinds.number(self.kind_row(node)));
            let (c, place) = (analysis.characteristics[id], self.place_row(node.span, &mut rows.files));
            let (required, siblings) = (c.required, c.siblings);
            let every = node.modifiers.every.map(nanos).map(|period| quote!(.every(#period)));
            rows.nodes.push(quote!(::apex_rt::NodeInfo::new(#name, #kind, #place, #required, #siblings)#every));
        }
        for c in &graph.connections {
            let (from, to) =
                (Literal::usize_unsuffixed(self.index(c.from.node)), Literal::usize_unsuffixed(self.index(c.to.node)));
            let taker = &graph.nodes[c.to.node];
            let (output, input) = (&graph.port(c.from).name, &taker.ports[taker.declared(c.to.port)].name);
            let activity = c.active;
            rows.connections.push(quote!(::apex_rt::ConnectionInfo::new(#from, #output, #to, #input, #activity)));
        }
        for (id, node) in graph.nodes.iter_enumerated() {
            if let (NodeKind::Each(each), Some(body)) = (&node.kind, analysis.bodies.get(&id)) {
                let prefix = format!("{prefix}{}.", graph.path(id));
                self.inside(graph, id).rows(&each.body, body, &prefix, rows);
            }
        }
    }

    /// Adds the states of all state machines.
    fn state_rows(&self, graph: &Graph, rows: &mut Rows) {
        for (id, machine) in machines(graph, self.catalog) {
            let kind = rows.kinds.number(quote!(::apex_rt::KindInfo::new("state", "", &[])));
            let (kind, path) = (Literal::usize_unsuffixed(kind), graph.path(id));
            let place = self.place_row(graph.nodes[id].span, &mut rows.files);
            for state in &machine.states {
                let name = format!("{path}.{state}");
                rows.nodes.push(quote!(::apex_rt::NodeInfo::new(#name, #kind, #place, false, false)));
            }
        }
    }

    /// Index of a place's file in `files`, line, and column.
    fn place_row(&self, span: Span, files: &mut Vec<FileId>) -> TokenStream {
        let file = files.iter().position(|file| *file == span.file).unwrap_or_else(|| {
            files.push(span.file);
            files.len() - 1
        });
        let (line, column) = self.sources.line_column(span.file, span.start);
        let numbers = [file, line, column].map(Literal::usize_unsuffixed);
        quote!([#(#numbers),*])
    }

    /// The row of a node's kind.
    fn kind_row(&self, node: &Node) -> TokenStream {
        let (name, docs) = self.kind(node);
        let is_declared = |port: usize| node.declared(port) == port;
        let ports = node.ports.iter().enumerate().filter(|(i, _)| is_declared(*i)).map(|(_, port)| port);
        let own = ports.filter(|port| port.parameter.is_none() && port.standard.is_none());
        let ports = own.map(|port| {
            let (name, ty) = (&port.name, port.ty.to_string());
            let kind = match port.kind {
                PortKind::Input => quote!(input),
                PortKind::Output => quote!(output),
                PortKind::Slot => quote!(slot),
                PortKind::Event => quote!(event),
            };
            quote!(::apex_rt::PortInfo::#kind(#name, #ty))
        });
        quote!(::apex_rt::KindInfo::new(#name, #docs, &[#(#ports),*]))
    }

    /// Name of a node's kind, and the first sentence of its documentation.
    fn kind(&self, node: &Node) -> (String, String) {
        let role = match &node.kind {
            NodeKind::Library(library) => {
                let signature = &self.catalog.signatures[library.signature];
                return (signature.name.clone(), short(&signature.docs));
            }
            NodeKind::Each(each) => return (format!("each {}", each.body.name), short(&each.body.docs)),
            NodeKind::Boundary(kind) => kind.word(),
            NodeKind::Delay(_) => "delay",
            NodeKind::Relay => "relay",
            NodeKind::Probe => "probe",
            NodeKind::Start => "start",
            NodeKind::Watchdog => "hung",
            NodeKind::SetBack => "set_back",
            NodeKind::Exit(_) => "exit",
            NodeKind::Reset => "reset",
            NodeKind::Interrupt(_) => "cancel",
            NodeKind::Sender(_) | NodeKind::Receiver(_) => "cell",
        };
        (role.to_owned(), String::new())
    }
}

/// First sentence of documentation, as plain text.
fn short(docs: &str) -> String {
    linkless(&first_sentence(docs))
}
