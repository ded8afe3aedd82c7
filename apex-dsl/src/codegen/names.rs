//! Names in generated code: those of the text for locals and fields, and those of the items of a program.

use super::tokens::ident;
use crate::{
    catalog::Catalog,
    graph::{Graph, Node, NodeId, NodeKind, PortId},
    index::IdVec,
    machine::machines,
    threads::{Origin, Part},
};
use std::collections::{BTreeMap, BTreeSet};
use syn::Ident;

/// Names of locals and fields: those of the text, made unique.
#[derive(Clone, Default)]
pub struct Names {
    /// Number that distinguishes a program, its parts and the bodies of its `each`.
    pub number: usize,
    /// The number of each node in the table of all nodes.
    pub numbers: IdVec<NodeId, usize>,
    /// The number of the first state of each state machine in the table of all nodes, where its states come behind the
    /// nodes. A machine in the body of an `each` has none: it is in several states at once.
    pub states: BTreeMap<NodeId, usize>,
    /// Names of tokens.
    pub tokens: BTreeMap<PortId, String>,
    /// Fields of the tokens that delays hold.
    pub held: BTreeMap<NodeId, String>,
    /// Fields of the activity of these tokens.
    pub held_activity: BTreeMap<NodeId, String>,
    /// Names in the bodies of `each` nodes.
    pub inner: BTreeMap<NodeId, Names>,
    /// More than any number of a program.
    pub beyond: usize,
}

impl Names {
    /// The names of a program and the bodies of its `each`.
    pub fn new(graph: &Graph, catalog: &Catalog, used: &mut BTreeSet<String>) -> Self {
        let mut count = 0;
        let mut names = Self::of_graph(graph, "", &mut count, used);
        for (node, machine) in machines(graph, catalog) {
            names.states.insert(node, count);
            count += machine.states.len();
        }
        names.beyond = count;
        names
    }

    fn of_graph(graph: &Graph, prefix: &str, count: &mut usize, used: &mut BTreeSet<String>) -> Self {
        // No other graph has nodes with these numbers.
        let mut names = Self { number: *count, ..Self::default() };
        names.numbers = (*count..*count + graph.nodes.len()).collect();
        *count += graph.nodes.len();
        for (node, n) in graph.nodes.iter_enumerated() {
            let path = format!("{prefix}{}", graph.path(node).replace('.', "_"));
            names.add(node, n, &path, used);
            if let NodeKind::Each(each) = &n.kind {
                names.inner.insert(node, Self::of_graph(&each.body, &format!("{path}_"), count, used));
            }
        }
        names
    }

    /// The names of a node and its tokens.
    fn add(&mut self, node: NodeId, n: &Node, path: &str, used: &mut BTreeSet<String>) {
        for (port, p) in n.ports.iter().enumerate().filter(|(_, p)| p.kind.sends()) {
            let plain = p.name == "out" || matches!(n.kind, NodeKind::Boundary(_));
            // `work.cancelled` is an event of `work`.
            let path = if n.interrupts().is_some() { path.strip_suffix("_cancel").unwrap_or(path) } else { path };
            let name = if plain { path.to_owned() } else { format!("{path}_{}", p.name) };
            self.tokens.insert(PortId { node, port }, local(name, used));
        }
        if let NodeKind::Delay(_) = &n.kind {
            self.held.insert(node, local(format!("{path}_held"), used));
            self.held_activity.insert(node, local(format!("{path}_held_activity"), used));
        }
        if n.interrupts().is_some() {
            self.held.insert(node, local(format!("{path}_remembered"), used));
        }
    }

    /// The names of a thread group's part of the program with these names.
    pub fn of_part(&self, part: &Part, number: usize, used: &mut BTreeSet<String>) -> Self {
        let mut names = Self { number, ..Self::default() };
        for (node, n) in part.graph.nodes.iter_enumerated() {
            let Origin::Node(origin) = part.origins[node] else {
                // It is not a node of the program: its number lies beyond those that observers know.
                names.numbers.push(self.beyond + node.index());
                names.add(node, n, &format!("cell_{}", node.index()), used);
                continue;
            };
            names.numbers.push(self.numbers[origin]);
            let tokens =
                self.tokens.range(PortId { node: origin, port: 0 }..).take_while(|(end, _)| end.node == origin);
            names.tokens.extend(tokens.map(|(end, name)| (PortId { node, port: end.port }, name.clone())));
            names.held.extend(self.held.get(&origin).map(|name| (node, name.clone())));
            names.held_activity.extend(self.held_activity.get(&origin).map(|name| (node, name.clone())));
            names.states.extend(self.states.get(&origin).map(|first| (node, *first)));
            names.inner.extend(self.inner.get(&origin).map(|inner| (node, inner.clone())));
        }
        names
    }
}

/// Names that the generated code itself uses, and those that stand for values in every module.
#[rustfmt::skip]
const OWN: [&str; 72] = [
    "Err", "None", "Ok", "Some", "active", "agenda", "at", "begins", "bits", "carries", "code", "completes", "core", "counts",
    "ctx", "dispatcher", "enabled", "ends", "event", "events", "exit", "first", "found", "gains",
    "i", "inputs", "last", "late", "left", "life", "list", "loses", "made", "missing", "next", "nodes",
    "now", "observer", "outputs", "parcel", "part", "parts", "place", "program", "queue", "quiet",
    "recorded", "result", "results", "round", "row", "self", "sent", "silences", "slot", "stamp", "stamps", "started",
    "state", "step", "steps", "stuck", "tap", "time", "timeouts", "timers", "token", "tokens", "told", "value",
    "wake", "woken",
];
/// Beginnings of names that the generated code itself uses.
#[rustfmt::skip]
const OWN_PREFIXES: [&str; 11] = [
    "param_", "token_", "claim_", "stamp_", "recorded_", "result_", "cell_", "holding_", "sender_", "receiver_",
    "ahead_",
];

/// The name of a local, which no name that the generated code itself uses hides.
fn local(mut name: String, used: &mut BTreeSet<String>) -> String {
    if OWN.contains(&name.as_str()) || OWN_PREFIXES.iter().any(|own| name.starts_with(own)) {
        name.push('_');
    }
    unused(name, used)
}

/// `name`, or something like it that is not used yet.
pub fn unused(mut name: String, used: &mut BTreeSet<String>) -> String {
    while !used.insert(name.clone()) {
        name.push('_');
    }
    name
}

/// Name of an item of a program: `Nodes`. In a part of a program it begins with the thread group: `On_visionNodes`.
pub fn item(program: &Graph, part: Option<&Part>, kind: &str) -> Ident {
    let group = part.map(|part| format!("On_{}", part.group)).unwrap_or_default();
    let name = format!("{group}{kind}");
    // The program has the name that the text gives it.
    ident(&if name == program.name { name + "_" } else { name })
}

/// Name of a constant: `WAITING_SIGNAL` of `waiting.signal`. Its own names are those of the tables.
pub fn constant_name(name: &str) -> String {
    const OWN: [&str; 12] = [
        "CLUSTERS",
        "CONNECTIONS",
        "FREE",
        "INFO",
        "KINDS",
        "MISSING",
        "NEEDS",
        "NODES",
        "ORDER",
        "PARAMS",
        "SLOTS",
        "SELF",
    ];
    let name = name.trim_start_matches("r#").chars().flat_map(char::to_uppercase);
    let mut name: String = name.map(valid).collect();
    if OWN.contains(&name.as_str()) {
        name.push('_');
    }
    if name.starts_with(char::is_numeric) {
        name.insert(0, '_');
    }
    name
}

/// Relays, probes and hidden slots have names that are not identifiers.
pub fn valid(c: char) -> char {
    if c.is_alphanumeric() { c } else { '_' }
}
