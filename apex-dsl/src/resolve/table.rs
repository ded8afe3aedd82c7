//! Meanings of the names in a graph body.

use crate::{
    catalog::Type,
    graph::{Node, NodeId, NodeKind, PortId, ScopeId, WireEnd},
    report::{Diagnostic, Diagnostics},
    source::Span,
    syntax::tree::{Ident, PortKind},
};
use std::collections::BTreeMap;

/// A port that a name may stand for.
#[derive(Debug, Clone)]
pub struct Candidate {
    pub name: String,
    pub kind: PortKind,
    pub ty: Type,
    pub place: WireEnd,
    /// `true` for a parameter, which counts only if it is named.
    pub parameter: bool,
}

/// Owner of ports.
#[derive(Debug, Clone, Copy)]
pub enum Owner {
    /// A node.
    Node(NodeId),
    /// A nested graph.
    Scope(ScopeId),
}

/// Meaning of a name in a graph.
#[derive(Debug, Clone)]
pub enum Symbol {
    /// A node or nested graph with its ports.
    Ports(Owner, Vec<Candidate>),
    /// A port of the graph itself, seen from inside.
    Own(Candidate),
    /// A node or nested graph that could not be made, which has been reported.
    Broken,
}

impl Symbol {
    /// A port of the graph itself.
    pub fn port(place: WireEnd, kind: PortKind, ty: &Type, name: &str) -> Self {
        Self::Own(Candidate { name: name.to_owned(), kind, ty: ty.clone(), place, parameter: false })
    }

    /// A node with its ports.
    pub fn of_node(id: NodeId, node: &Node) -> Self {
        let each = matches!(node.kind, NodeKind::Each(_));
        let ports = node.ports.iter().enumerate().map(|(port, p)| Candidate {
            name: p.name.clone(),
            kind: p.kind,
            // The port decides if a list or its element is wanted; `check::types` compares them later.
            ty: if each { Type::Unknown(String::new()) } else { p.ty.clone() },
            place: WireEnd::Port(PortId { node: id, port }),
            parameter: p.parameter.is_some(),
        });
        Self::Ports(Owner::Node(id), ports.collect())
    }

    /// A nested graph with its pins.
    pub fn of_graph(scope: ScopeId, pins: Vec<(String, PortKind, Type, WireEnd)>) -> Self {
        Self::Ports(
            Owner::Scope(scope),
            pins.into_iter()
                .map(|(name, kind, ty, place)| Candidate { name, kind, ty, place, parameter: false })
                .collect(),
        )
    }

    /// The outputs of a node or nested graph.
    pub fn outputs(&mut self) -> Vec<&mut Candidate> {
        match self {
            Self::Ports(_, ports) => ports.iter_mut().filter(|p| p.kind == PortKind::Output && !p.parameter).collect(),
            _ => vec![],
        }
    }
}

/// The names of one graph body.
pub struct Table {
    symbols: BTreeMap<String, (Symbol, Span)>,
}

impl Table {
    /// An empty table.
    pub fn new() -> Self {
        Self { symbols: BTreeMap::new() }
    }

    /// The meaning of a name, and the place of its declaration.
    pub fn get(&self, name: &str) -> Option<(&Symbol, Span)> {
        self.symbols.get(name).map(|(symbol, span)| (symbol, *span))
    }

    /// The ports of the graph itself, seen from inside, in order of their names.
    pub fn own_ports(&self) -> impl Iterator<Item = &Candidate> {
        self.symbols.values().filter_map(|(symbol, _)| if let Symbol::Own(port) = symbol { Some(port) } else { None })
    }

    /// All names.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.symbols.keys().map(String::as_str)
    }

    /// Adds a name. A name that is declared twice becomes [`Symbol::Broken`].
    pub fn insert(&mut self, name: &Ident, symbol: Symbol, diagnostics: &mut Diagnostics) {
        if let Some((_, first)) = self.symbols.get(&name.text) {
            let message = format!("`{}` is already defined in this graph", name.text);
            diagnostics
                .push(Diagnostic::error("duplicate-name", name.span, message).also(*first, "first defined here"));
            // Uses of the name may mean either of the two.
            let first = *first;
            self.symbols.insert(name.text.clone(), (Symbol::Broken, first));
            return;
        }
        self.symbols.insert(name.text.clone(), (symbol, name.span));
    }
}

/// Ports as text.
pub fn list(ports: &[&Candidate]) -> String {
    let word = |p: &&Candidate| match p.ty.to_string().as_str() {
        "" => format!("{} `{}`", p.kind.word(), p.name),
        ty => format!("{} `{}: {ty}`", p.kind.word(), p.name),
    };
    ports.iter().map(word).collect::<Vec<_>>().join(", ")
}
