//! Connections cut into legs at the sides of nested graphs, and what lies on a loop.

use crate::{
    graph::{Crossing, Flow, Graph, NodeId, NodeKind},
    syntax::tree::PortKind,
};
use std::collections::{BTreeMap, BTreeSet};

/// Where a leg begins or ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Stop {
    /// At a node.
    Node(NodeId),
    /// At a side of a nested graph.
    Side(Crossing),
}

/// The part of a connection between two stops.
#[derive(Debug, Clone, Copy)]
pub struct Leg {
    /// The connection.
    pub connection: usize,
    /// Where it begins.
    pub from: Stop,
    /// Where it ends.
    pub to: Stop,
}

/// All legs, those of a connection one after the other.
pub fn legs(graph: &Graph) -> Vec<Leg> {
    let insides = insides(graph);
    // A delay breaks a loop: the loop goes on with what it sends, before the graph around it sends everything else.
    cut(graph, |node, side| {
        matches!(side, Crossing::Leave(_))
            && insides.get(&node).is_some_and(|inside| inside.contains(&Stop::Side(side)))
    })
}

/// The legs, if connections from a node pass by those sides for which `passes` holds.
fn cut(graph: &Graph, passes: impl Fn(NodeId, Crossing) -> bool) -> Vec<Leg> {
    let mut legs = vec![];
    for (connection, c) in graph.connections.iter().enumerate() {
        let mut from = Stop::Node(c.from.node);
        // A slot takes each token alone, so that no side of a nested graph holds it back.
        let sides = if graph.flow(c) == Flow::ToSlot { &[] } else { c.crossings.as_slice() };
        for &crossing in sides.iter().filter(|side| !passes(c.from.node, **side)) {
            let to = Stop::Side(crossing);
            legs.push(Leg { connection, from, to });
            from = to;
        }
        legs.push(Leg { connection, from, to: Stop::Node(c.to.node) });
    }
    legs
}

/// A loop, or several that have nodes in common. An iteration begins only when it can come to its end: all delays send together.
#[derive(Debug, Clone)]
pub struct Loop {
    /// Its delays.
    pub delays: Vec<NodeId>,
    /// The legs that lead into it from elsewhere. It goes round once for each token on each of them; without any, it sets its own pace.
    pub entries: Vec<usize>,
    /// The legs of the events of all nodes on it: they have to be free when an iteration begins.
    pub events: Vec<usize>,
}

/// The loops of a graph, by its [`legs`].
pub fn loops(graph: &Graph, legs: &[Leg]) -> Vec<Loop> {
    let on_loop = |(inside, delays): (BTreeSet<Stop>, Vec<NodeId>)| {
        let numbered = || legs.iter().enumerate();
        let is_entry = |l: &Leg| to_input(graph, l) && !inside.contains(&l.from) && inside.contains(&l.to);
        let is_event =
            |l: &Leg| matches!(l.from, Stop::Node(_)) && inside.contains(&l.from) && from_event(graph, l.connection);
        Loop {
            delays,
            entries: numbered().filter(|(_, l)| is_entry(l)).map(|(i, _)| i).collect(),
            events: numbered().filter(|(_, l)| is_event(l)).map(|(i, _)| i).collect(),
        }
    };
    let mut delays: BTreeMap<BTreeSet<Stop>, Vec<NodeId>> = BTreeMap::new();
    insides(graph).into_iter().for_each(|(delay, inside)| delays.entry(inside).or_default().push(delay));
    delays.into_iter().map(on_loop).collect()
}

/// For each delay on a loop all that lies on the loop. A nested graph is passed as a whole: by its sides.
fn insides(graph: &Graph) -> BTreeMap<NodeId, BTreeSet<Stop>> {
    let mut after: BTreeMap<Stop, Vec<Stop>> = BTreeMap::new();
    let mut before: BTreeMap<Stop, Vec<Stop>> = BTreeMap::new();
    for leg in cut(graph, |_, _| false).iter().filter(|leg| to_input(graph, leg)) {
        after.entry(leg.from).or_default().push(leg.to);
        before.entry(leg.to).or_default().push(leg.from);
    }
    let mut insides = BTreeMap::new();
    for (node, _) in graph.nodes.iter().enumerate().filter(|(_, n)| matches!(n.kind, NodeKind::Delay(_))) {
        let (below, above) = (reached([Stop::Node(node)], &after), reached([Stop::Node(node)], &before));
        if below.contains(&Stop::Node(node)) {
            insides.insert(node, below.intersection(&above).copied().collect());
        }
    }
    insides
}

fn to_input(graph: &Graph, leg: &Leg) -> bool {
    graph.flow(&graph.connections[leg.connection]) != Flow::ToSlot
}

/// What `next` leads to from any of `from`, directly or not; one of them only if it is led back to.
pub fn reached(from: impl IntoIterator<Item = Stop>, next: &BTreeMap<Stop, Vec<Stop>>) -> BTreeSet<Stop> {
    let mut found = BTreeSet::new();
    let mut ends: Vec<Stop> = from.into_iter().filter_map(|stop| next.get(&stop)).flatten().copied().collect();
    while let Some(stop) = ends.pop() {
        if found.insert(stop) {
            ends.extend(next.get(&stop).into_iter().flatten());
        }
    }
    found
}

/// The connections that start at a port and carry only values: those of an event, and those from an output to a slot.
pub fn value_connections(graph: &Graph, end: crate::graph::End) -> impl Iterator<Item = usize> + '_ {
    let connections = graph.connections.iter().enumerate();
    connections.filter(move |(_, c)| c.from == end && graph.flow(c) != Flow::Synchronous).map(|(i, _)| i)
}

/// Whether a connection starts at an event of its node.
pub fn from_event(graph: &Graph, connection: usize) -> bool {
    graph.port(graph.connections[connection].from).kind == PortKind::Event
}
