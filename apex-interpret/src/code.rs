//! A program that is interpreted: its operations, and its state.

use apex_dsl::{
    catalog::Catalog,
    graph::{ConnectionId, Graph, NodeId, NodeKind},
    index::IdVec,
    machine::machines,
    program::{Lower, Program},
    threads::{Origin, Part},
};
use std::collections::BTreeMap;

/// Numbers of nodes and connections, for observers.
#[derive(Clone, Default)]
pub struct Numbers {
    /// Number of each node among all nodes.
    pub own: IdVec<NodeId, usize>,
    /// Number of each connection; `None` if observers do not know it.
    pub connections: IdVec<ConnectionId, Option<usize>>,
    /// Number of the first state of each state machine: its states come behind all nodes.
    pub states: BTreeMap<NodeId, usize>,
    /// Those in the bodies of `each`.
    inner: BTreeMap<NodeId, Numbers>,
}

impl Numbers {
    /// The numbers in a graph. `count` is the number of nodes before it.
    pub fn new(graph: &Graph, count: &mut usize) -> Self {
        let own = (*count..*count + graph.nodes.len()).collect();
        *count += graph.nodes.len();
        let connections = graph.connections.ids().map(|connection| Some(connection.index())).collect();
        let mut inner = BTreeMap::new();
        for (node, n) in graph.nodes.iter_enumerated() {
            if let NodeKind::Each(each) = &n.kind {
                inner.insert(node, Self::new(&each.body, count));
            }
        }
        Self { own, connections, states: BTreeMap::new(), inner }
    }

    /// The numbers in a program, and the first number beyond them.
    pub fn of_program(graph: &Graph, catalog: &Catalog) -> (Self, usize) {
        let mut count = 0;
        let mut numbers = Self::new(graph, &mut count);
        for (node, machine) in machines(graph, catalog) {
            numbers.states.insert(node, count);
            count += machine.states.len();
        }
        (numbers, count)
    }

    /// The numbers in the part of a thread group. Nodes that only pass tokens on come behind all others.
    pub fn of_part(&self, part: &Part, beyond: usize) -> Self {
        let mut numbers = Self::default();
        for (node, origin) in part.origins.iter_enumerated() {
            match origin {
                Origin::Node(origin) => {
                    numbers.own.push(self.own[*origin]);
                    numbers.inner.extend(self.inner.get(origin).map(|inner| (node, inner.clone())));
                    numbers.states.extend(self.states.get(origin).map(|first| (node, *first)));
                }
                Origin::Token(_) => drop(numbers.own.push(beyond + node.index())),
            }
        }
        numbers.connections = part.connections.iter().map(|origin| origin.map(ConnectionId::index)).collect();
        numbers
    }
}

/// Names of all nodes and states of a program, by their numbers.
pub fn names(graph: &Graph, catalog: &Catalog) -> Vec<String> {
    let mut names = vec![];
    add_names(graph, "", &mut names);
    for (node, machine) in machines(graph, catalog) {
        names.extend(machine.states.iter().map(|state| format!("{}.{state}", graph.path(node))));
    }
    names
}

fn add_names(graph: &Graph, prefix: &str, names: &mut Vec<String>) {
    names.extend(graph.nodes.ids().map(|id| format!("{prefix}{}", graph.path(id))));
    for (id, node) in graph.nodes.iter_enumerated() {
        if let NodeKind::Each(each) = &node.kind {
            add_names(&each.body, &format!("{prefix}{}.", graph.path(id)), names);
        }
    }
}

/// A program, the part of a thread group, or the body of an `each`.
pub struct Code<'a> {
    /// The program.
    pub program: Program<'a>,
    /// Numbers for observers.
    pub numbers: Numbers,
    /// It is the part of a thread group, beside others.
    pub is_part: bool,
    /// Bodies of `each`.
    pub bodies: BTreeMap<NodeId, Code<'a>>,
}

impl<'a> Code<'a> {
    pub fn new(lower: Lower<'a>, numbers: Numbers, is_part: bool) -> Self {
        let Lower { graph, analysis, catalog, .. } = lower;
        let mut bodies = BTreeMap::new();
        for (node, n) in graph.nodes.iter_enumerated() {
            if let (NodeKind::Each(each), Some(body)) = (&n.kind, analysis.bodies.get(&node)) {
                let inner = numbers.inner.get(&node).cloned().unwrap_or_default();
                bodies.insert(node, Self::new(Lower::new(&each.body, body, catalog, None), inner, false));
            }
        }
        Self { program: Program::new(lower), numbers, is_part, bodies }
    }

    /// Faults of the compiler that show in the program, also in the bodies of its `each`.
    pub fn faults(&self) -> Vec<String> {
        let inner = self.bodies.values().flat_map(Self::faults);
        self.program.faults().into_iter().chain(inner).collect()
    }

    /// The graph.
    pub fn graph(&self) -> &'a Graph {
        self.program.lower.graph
    }
}
