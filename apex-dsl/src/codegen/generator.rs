//! The generator: all that the code of a program depends on.

use super::{
    bugs::Bugs,
    channels::Channels,
    names::{Names, item},
    tokens::ident,
};
use crate::{
    catalog::Catalog,
    claims::Decided,
    graph::{ConnectionId, Graph, NodeId, PortId},
    source::{Sources, Span},
    threads::{Cell, Part},
};
use proc_macro2::TokenStream;
use quote::{format_ident, quote};
use syn::Ident;

/// Generates programs.
#[derive(Clone, Copy)]
pub struct Generator<'a> {
    pub catalog: &'a Catalog,
    pub sources: &'a Sources,
    pub names: &'a Names,
    /// Faults of the compiler itself.
    pub bugs: &'a Bugs,
    /// Position of a span of the source file in the code that calls `graph!`.
    pub place: &'a dyn Fn(Span) -> proc_macro2::Span,
    /// The graph around the body of an `each`, and the node that the body belongs to.
    pub outer: Option<(&'a Graph, NodeId, &'a Generator<'a>)>,
    /// The graph of all thread groups, and which of its parts this is.
    pub part: Option<(&'a Graph, &'a Part)>,
    /// The thread groups, if there are several.
    pub parts: &'a [Part],
    /// Cells between the parts.
    pub cells: &'a [Cell],
    /// Decisions about the claims; `None` in a part of a program and in the body of an `each`.
    pub claims: Option<&'a Decided>,
    /// Recorded channels, if the program can be recorded; `None` in the body of an `each`.
    pub channels: Option<&'a Channels>,
}

impl<'a> Generator<'a> {
    /// The generator of a program on one thread, which does not look at claims and cannot be recorded.
    pub fn new(
        catalog: &'a Catalog,
        sources: &'a Sources,
        names: &'a Names,
        bugs: &'a Bugs,
        place: &'a dyn Fn(Span) -> proc_macro2::Span,
    ) -> Self {
        let (outer, part, parts, cells, claims, channels) = (None, None, &[][..], &[][..], None, None);
        Self { catalog, sources, names, bugs, place, outer, part, parts, cells, claims, channels }
    }

    /// The generator for the body of the `each` node `node` of `graph`.
    pub fn inside(&'a self, graph: &'a Graph, node: NodeId) -> Generator<'a> {
        let names = self.names.inner.get(&node).unwrap_or(self.names);
        Generator { names, outer: Some((graph, node, self)), part: None, claims: None, channels: None, ..*self }
    }

    /// For types: the generator of the graph of all thread groups. A type may depend on a node of another group.
    pub fn of_all(&self) -> Self {
        Self { part: None, ..*self }
    }

    /// The number of a node in the table of all nodes.
    pub fn index(&self, node: NodeId) -> usize {
        self.names.numbers[node]
    }

    /// The number of a connection in the table of all connections, unless it leads to another thread group.
    pub fn connection(&self, connection: ConnectionId) -> Option<usize> {
        match self.part {
            Some((_, part)) => part.connections[connection].map(ConnectionId::index),
            None => Some(connection.index()),
        }
    }

    /// Name of an item of the program, or of the part of one, that `graph` is.
    pub fn item(&self, graph: &Graph, kind: &str) -> Ident {
        match self.part {
            Some((program, part)) => item(program, Some(part), kind),
            None => item(graph, None, kind),
        }
    }

    /// Name of the struct of the program, or of the part of one, that `graph` is.
    pub fn program_name(&self, graph: &Graph) -> Ident {
        match self.part {
            Some((program, part)) => item(program, Some(part), ""),
            None => ident(&graph.name),
        }
    }

    /// The name of a token.
    pub fn name(&self, end: PortId) -> Ident {
        self.names.tokens.get(&end).map_or_else(|| self.nameless("a token"), |name| ident(name))
    }

    /// The name of the place where a delay keeps the activity of the tokens that it holds.
    pub fn held_activity(&self, node: NodeId) -> Ident {
        self.names.held_activity.get(&node).map_or_else(|| self.nameless("the activity of a delay"), |name| ident(name))
    }

    /// The name of the place where a delay holds tokens back, or where `cancel` remembers nodes.
    pub fn held(&self, node: NodeId) -> Ident {
        self.names.held.get(&node).map_or_else(|| self.nameless("a delay or `cancel`"), |name| ident(name))
    }

    /// Notes a fault at `span`. The code stands for what cannot be generated.
    pub fn bug(&self, span: Span, what: &str) -> TokenStream {
        let message = self.bugs.note(span, what);
        quote!(::core::compile_error!(#message))
    }

    /// Notes that something has no name. The identifier stands for it.
    pub fn nameless(&self, what: &str) -> Ident {
        self.bug(self.bugs.graph, &format!("{what} has no name"));
        format_ident!("nameless")
    }
}
