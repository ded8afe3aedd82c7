//! Graph + analysis → Rust. The text that comes out is meant to be read (`apex expand`).

mod activity;
mod bits;
mod cells;
mod claims;
mod clusters;
mod condition;
mod deliver;
mod dispatch;
mod each;
mod fire;
mod machine;
mod memory;
mod parallel;
mod params;
mod plan;
mod program;
mod rates;
mod record;
mod slots;
mod stamps;
mod state;
mod tables;
mod test;
mod text;
mod threads;
mod timers;
mod types;
mod wiring;
mod witness;

pub use memory::{Piece, memory};
pub use plan::{Storage, storage};
pub use text::{module_name, text};

use crate::{
    catalog::Catalog,
    claims::Decided,
    graph::{End, Graph, Node, NodeId, NodeKind},
    program::Program,
    source::{Sources, Span},
    threads::{Cell, Origin, Part},
};
use proc_macro2::TokenStream;
use std::collections::{BTreeMap, BTreeSet};

/// Generates programs.
#[derive(Clone, Copy)]
pub struct Generator<'a> {
    catalog: &'a Catalog,
    sources: &'a Sources,
    names: &'a Names,
    /// Where a piece of the text stands in the code that called `graph!`.
    place: &'a dyn Fn(Span) -> proc_macro2::Span,
    /// The graph around the body of an `each`, and the node that the body belongs to.
    outer: Option<(&'a Graph, NodeId, &'a Generator<'a>)>,
    /// The graph of all thread groups, and which of its parts this is.
    part: Option<(&'a Graph, &'a Part)>,
    /// The thread groups, if there are several.
    parts: &'a [Part],
    /// What is between the parts.
    cells: &'a [Cell],
    /// What is known about the claims; nothing in a part of a program and in the body of an `each`.
    claims: Option<&'a Decided>,
    /// What is recorded, if the program can be recorded; not in the body of an `each`.
    channels: Option<&'a record::Channels>,
}

/// Names of locals and fields: those of the text, made unique.
#[derive(Clone, Default)]
pub struct Names {
    /// What tells a program, its parts and the bodies of its `each` apart.
    number: usize,
    /// The number of each node in the table of all nodes.
    numbers: Vec<usize>,
    tokens: BTreeMap<End, String>,
    /// Where delays hold tokens back.
    held: BTreeMap<NodeId, String>,
    /// Where delays keep the activity of these tokens.
    held_activity: BTreeMap<NodeId, String>,
    inner: BTreeMap<NodeId, Names>,
}

impl Names {
    fn new(graph: &Graph, prefix: &str, count: &mut usize, used: &mut BTreeSet<String>) -> Self {
        // No other graph has nodes with these numbers.
        let mut names = Self { number: *count, ..Self::default() };
        names.numbers = (*count..*count + graph.nodes.len()).collect();
        *count += graph.nodes.len();
        for (node, n) in graph.nodes.iter().enumerate() {
            let path = format!("{prefix}{}", graph.path(node).replace('.', "_"));
            names.add(node, n, &path, used);
            if let NodeKind::Each(each) = &n.kind {
                names.inner.insert(node, Self::new(&each.body, &format!("{path}_"), count, used));
            }
        }
        names
    }

    /// More than any number in it.
    fn count(&self) -> usize {
        let inner = self.inner.values().map(Self::count).max().unwrap_or(0);
        self.numbers.iter().map(|number| number + 1).max().unwrap_or(0).max(inner)
    }

    /// The names of a node and its tokens.
    fn add(&mut self, node: NodeId, n: &Node, path: &str, used: &mut BTreeSet<String>) {
        for (port, p) in n.ports.iter().enumerate().filter(|(_, p)| p.kind.sends()) {
            let plain = p.name == "out" || matches!(n.kind, NodeKind::Boundary(_));
            let name = if plain { path.to_owned() } else { format!("{path}_{}", p.name) };
            self.tokens.insert(End { node, port }, local(name, used));
        }
        if let NodeKind::Delay(_) = &n.kind {
            self.held.insert(node, local(format!("{path}_held"), used));
            self.held_activity.insert(node, local(format!("{path}_held_activity"), used));
        }
    }

    /// The names of a thread group's part of the program with these names.
    fn of_part(&self, part: &Part, number: usize, used: &mut BTreeSet<String>) -> Self {
        let mut names = Self { number, ..Self::default() };
        for (node, n) in part.graph.nodes.iter().enumerate() {
            let Origin::Node(origin) = part.origins[node] else {
                // It is not a node of the program: its number lies beyond those that observers know.
                names.numbers.push(self.count() + node);
                names.add(node, n, &format!("cell_{node}"), used);
                continue;
            };
            names.numbers.push(self.numbers[origin]);
            let tokens = self.tokens.range(End { node: origin, port: 0 }..).take_while(|(end, _)| end.node == origin);
            names.tokens.extend(tokens.map(|(end, name)| (End { node, port: end.port }, name.clone())));
            names.held.extend(self.held.get(&origin).map(|name| (node, name.clone())));
            names.held_activity.extend(self.held_activity.get(&origin).map(|name| (node, name.clone())));
            names.inner.extend(self.inner.get(&origin).map(|inner| (node, inner.clone())));
        }
        names
    }
}

/// Names that the generated code itself uses, and those that stand for values in every module.
#[rustfmt::skip]
const OWN: [&str; 64] = [
    "Err", "None", "Ok", "Some", "active", "agenda", "begins", "bits", "carries", "code", "counts",
    "ctx", "dispatcher", "enabled", "ends", "event", "events", "exit", "first", "found", "gains",
    "i", "inputs", "late", "left", "life", "list", "loses", "made", "missing", "next", "nodes",
    "now", "observer", "outputs", "parcel", "part", "parts", "place", "program", "queue", "quiet",
    "recorded", "result", "results", "round", "row", "self", "sent", "stamp", "stamps", "started",
    "state", "step", "steps", "tap", "timeouts", "timers", "token", "tokens", "told", "value",
    "wake", "woken",
];
/// Beginnings of names that the generated code itself uses.
const OWN_PREFIXES: [&str; 10] =
    ["param_", "token_", "claim_", "stamp_", "recorded_", "result_", "cell_", "holding_", "sender_", "receiver_"];

/// The name of a local, which no name that the generated code itself uses hides.
fn local(mut name: String, used: &mut BTreeSet<String>) -> String {
    if OWN.contains(&name.as_str()) || OWN_PREFIXES.iter().any(|own| name.starts_with(own)) {
        name.push('_');
    }
    unused(name, used)
}

/// `name`, or something like it that is not used yet.
fn unused(mut name: String, used: &mut BTreeSet<String>) -> String {
    while !used.insert(name.clone()) {
        name.push('_');
    }
    name
}

/// The program of a graph, with the test that it is made for, if there is one; `recordable` if a run of it can be recorded.
fn program(
    program: &Program,
    catalog: &Catalog,
    sources: &Sources,
    place: &dyn Fn(Span) -> proc_macro2::Span,
    recordable: bool,
) -> TokenStream {
    let graph = &program.graph;
    let mut used = BTreeSet::new();
    let names = Names::new(graph, "", &mut 0, &mut used);
    let cells = program.split.as_ref().map_or(&[][..], |split| &split.cells);
    let parts = program.split.as_ref().map_or(&[][..], |split| &split.parts);
    let channels = record::Channels::new(graph, &program.analysis, catalog, parts);
    let channels = recordable.then_some(&channels);
    let claims = program.split.is_none().then_some(&program.claims);
    let generator =
        Generator { catalog, sources, names: &names, place, outer: None, part: None, parts, cells, claims, channels };
    let code = match &program.split {
        Some(split) => generator.threads(graph, &program.analysis, split, &mut used),
        None => generator.program(graph, &program.analysis),
    };
    match &program.script {
        Some(script) => generator.test(graph, script, code),
        None => code,
    }
}

impl<'a> Generator<'a> {
    /// The generator for the body of the `each` node `node` of `graph`.
    fn inside(&'a self, graph: &'a Graph, node: NodeId) -> Generator<'a> {
        let names = self.names.inner.get(&node).unwrap_or(self.names);
        Generator { names, outer: Some((graph, node, self)), part: None, claims: None, channels: None, ..*self }
    }

    /// For types: the generator of the graph of all thread groups. A type may depend on a node of another group.
    fn of_all(&self) -> Self {
        Self { part: None, ..*self }
    }

    /// The number of a node in the table of all nodes.
    fn index(&self, node: NodeId) -> usize {
        self.names.numbers[node]
    }

    /// The number of a connection in the table of all connections, unless it leads to another thread group.
    fn connection(&self, connection: usize) -> Option<usize> {
        match self.part {
            Some((_, part)) => part.connections[connection],
            None => Some(connection),
        }
    }

    /// The name of a token.
    fn name(&self, end: End) -> syn::Ident {
        types::ident(self.names.tokens.get(&end).map_or("token", String::as_str))
    }

    /// The name of the place where a delay keeps the activity of the tokens that it holds.
    fn held_activity(&self, node: NodeId) -> syn::Ident {
        types::ident(self.names.held_activity.get(&node).map_or("held_activity", String::as_str))
    }

    /// The name of the place where a delay holds tokens back.
    fn held(&self, node: NodeId) -> syn::Ident {
        types::ident(self.names.held.get(&node).map_or("held", String::as_str))
    }
}
