//! Which sources may wait for those that take their tokens.

use super::route::{Leg, Stop, legs};
use crate::graph::{Flow, Graph, NodeId, NodeKind};
use std::collections::BTreeSet;

/// Sources without a pace that only feed inputs, if something behind them waits for others, too: they may fire when and as
/// often as that.
pub fn patient(graph: &Graph, sources: &BTreeSet<NodeId>) -> BTreeSet<NodeId> {
    let legs = legs(graph);
    let flow = |leg: &Leg| graph.flow(&graph.connections[leg.connection]);
    let has_pace = |node: &NodeId| graph.nodes[*node].modifiers.has_pace();
    let is_free = |node: &NodeId| {
        let mut sent = graph.connections.iter().filter(|c| c.from.node == *node).peekable();
        let is_library = matches!(graph.nodes[*node].kind, NodeKind::Library(_));
        is_library && !has_pace(node) && sent.peek().is_some() && sent.all(|c| graph.is_synchronous(c))
    };
    let paced = || (0..graph.nodes.len()).filter(has_pace).map(Stop::Node);
    let asynchronous = || legs.iter().filter(|leg| flow(leg) == Flow::ToInput).map(|leg| leg.to);
    let waits = |node: &NodeId| {
        let sources = sources.iter().filter(|source| *source != node).map(|source| Stop::Node(*source));
        let others = behind(graph, &legs, sources.chain(paced()).chain(asynchronous()));
        !behind(graph, &legs, [Stop::Node(*node)]).is_disjoint(&others)
    };
    sources.iter().copied().filter(is_free).filter(waits).collect()
}

/// `stops`, and where what they send goes on, directly or not. At a side of a nested graph everything goes on together.
fn behind(graph: &Graph, legs: &[Leg], stops: impl IntoIterator<Item = Stop>) -> BTreeSet<Stop> {
    let goes_on = |leg: &&Leg| match graph.flow(&graph.connections[leg.connection]) {
        Flow::Synchronous => true,
        Flow::ToInput => matches!(leg.from, Stop::Side(_)),
        _ => false,
    };
    let mut found = BTreeSet::new();
    let mut ends: Vec<Stop> = stops.into_iter().collect();
    while let Some(stop) = ends.pop() {
        if found.insert(stop) {
            ends.extend(legs.iter().filter(|leg| leg.from == stop).filter(goes_on).map(|leg| leg.to));
        }
    }
    found
}
