//! Sources that fire when their consumers need tokens.

use super::route::{SegmentEnd, loops, reached, segments};
use apex_dsl::graph::{Flow, Graph, NodeId, NodeKind};
use std::collections::{BTreeMap, BTreeSet};

/// Demand-driven sources: they have no timer, send only to synchronous inputs, and share a node downstream with another
/// source, a timer or an asynchronous connection. They may fire when and as often as that node needs their tokens.
pub fn demand_driven(graph: &Graph, sources: &BTreeSet<NodeId>) -> BTreeSet<NodeId> {
    let has_pace = |node: &NodeId| graph.nodes[*node].modifiers.has_pace();
    let is_free = |node: &NodeId| {
        let mut sent = graph.connections.iter().filter(|c| c.from.node == *node).peekable();
        let is_library = matches!(graph.nodes[*node].kind, NodeKind::Library(_));
        is_library && !has_pace(node) && sent.peek().is_some() && sent.all(|c| graph.is_synchronous(c))
    };
    let mut after: BTreeMap<SegmentEnd, Vec<SegmentEnd>> = BTreeMap::new();
    let mut paces: BTreeSet<SegmentEnd> = graph.nodes.ids().filter(has_pace).map(SegmentEnd::Node).collect();
    let segments = segments(graph);
    for segment in &segments {
        let flow = graph.flow(&graph.connections[segment.connection]);
        // Tokens cross a boundary together, so that asynchronous ones wait for all others there, too.
        if flow == Flow::Synchronous || flow == Flow::ToInput && matches!(segment.from, SegmentEnd::Side(_)) {
            after.entry(segment.from).or_default().push(segment.to);
        }
        if flow == Flow::ToInput {
            paces.insert(segment.to);
        }
    }
    // The delays of a loop send when a token has come on each leg into the loop.
    for on_loop in loops(graph, &segments) {
        for entry in on_loop.entries {
            after.entry(segments[entry].from).or_default().extend(on_loop.delays.iter().copied().map(SegmentEnd::Node));
        }
    }
    let waits = |node: &NodeId| {
        let mut others = paces.clone();
        others.extend(sources.iter().filter(|source| *source != node).map(|source| SegmentEnd::Node(*source)));
        others.extend(reached(others.iter().copied(), &after));
        !reached([SegmentEnd::Node(*node)], &after).is_disjoint(&others)
    };
    sources.iter().copied().filter(is_free).filter(waits).collect()
}
