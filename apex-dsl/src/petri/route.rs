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
    let mut legs = vec![];
    for (connection, c) in graph.connections.iter().enumerate() {
        let mut from = Stop::Node(c.from.node);
        // A slot takes each token alone, so that no side of a nested graph holds it back.
        let sides = if graph.flow(c) == Flow::ToSlot { &[] } else { c.crossings.as_slice() };
        for &crossing in sides {
            let to = Stop::Side(crossing);
            legs.push(Leg { connection, from, to });
            from = to;
        }
        legs.push(Leg { connection, from, to: Stop::Node(c.to.node) });
    }
    legs
}

/// What decides when a delay on a loop sends.
pub struct Loop {
    /// The legs that lead into the loop from elsewhere. The delay sends once for each token on each of them; without any, it sets the
    /// pace of the loop itself.
    pub entries: Vec<usize>,
    /// The legs of the events of all nodes on the loop: an iteration begins only when it can come to its end.
    pub events: Vec<usize>,
}

/// For each delay on a loop what decides when it sends.
pub fn loops(graph: &Graph, legs: &[Leg]) -> BTreeMap<NodeId, Loop> {
    let to_inputs: Vec<(usize, &Leg)> =
        legs.iter().enumerate().filter(|(_, l)| graph.flow(&graph.connections[l.connection]) != Flow::ToSlot).collect();
    let mut after: BTreeMap<Stop, Vec<Stop>> = BTreeMap::new();
    let mut before: BTreeMap<Stop, Vec<Stop>> = BTreeMap::new();
    for (_, leg) in &to_inputs {
        after.entry(leg.from).or_default().push(leg.to);
        before.entry(leg.to).or_default().push(leg.from);
    }
    let mut loops = BTreeMap::new();
    for (node, n) in graph.nodes.iter().enumerate() {
        if !matches!(n.kind, NodeKind::Delay(_)) {
            continue;
        }
        let (below, above) = (reached(Stop::Node(node), &after), reached(Stop::Node(node), &before));
        if below.contains(&Stop::Node(node)) {
            let inside = |stop: &Stop| below.contains(stop) && above.contains(stop);
            let entries = to_inputs.iter().filter(|(_, l)| !inside(&l.from) && inside(&l.to)).map(|(i, _)| *i);
            let is_event =
                |l: &Leg| matches!(l.from, Stop::Node(_)) && inside(&l.from) && from_event(graph, l.connection);
            let events = legs.iter().enumerate().filter(|(_, l)| is_event(l)).map(|(i, _)| i);
            loops.insert(node, Loop { entries: entries.collect(), events: events.collect() });
        }
    }
    loops
}

fn reached(from: Stop, next: &BTreeMap<Stop, Vec<Stop>>) -> BTreeSet<Stop> {
    let mut found = BTreeSet::new();
    let mut ends: Vec<Stop> = next.get(&from).into_iter().flatten().copied().collect();
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
