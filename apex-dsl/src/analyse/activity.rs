//! The activity subgraph (thesis 7.1.2): the nodes that can ever be active.

use crate::{
    graph::{Graph, NodeId, NodeKind},
    index::IdVec,
    syntax::tree::PortKind,
};
use std::collections::BTreeSet;

/// Nodes that activity can reach. All others are never active, and activity costs them nothing.
pub fn reachable(graph: &Graph) -> BTreeSet<NodeId> {
    spread(graph, |_| false)
}

/// Nodes that activity can reach if the graph is a part of another graph, which sends activity to its ports.
pub fn reachable_within(graph: &Graph) -> BTreeSet<NodeId> {
    spread(graph, |kind| matches!(kind, NodeKind::Boundary(PortKind::Input | PortKind::Slot)))
}

/// For each node, the nodes to which activity can go from it: over `=>`, or because it is cancelled.
pub fn successors(graph: &Graph) -> IdVec<NodeId, Vec<NodeId>> {
    let mut next: IdVec<NodeId, Vec<NodeId>> = IdVec::from_elem(vec![], graph.nodes.len());
    for c in graph.connections.iter().filter(|c| c.active) {
        next[c.from.node].push(c.to.node);
    }
    for interrupt in graph.interrupts() {
        interrupt.takes.into_iter().for_each(|node| next[node].push(interrupt.node));
    }
    next
}

/// Nodes that activity can reach from its origins, and from nodes of the kinds for which `enters` is `true`.
fn spread(graph: &Graph, enters: impl Fn(&NodeKind) -> bool) -> BTreeSet<NodeId> {
    let next = successors(graph);
    let begins = |n: &NodeId| {
        let node = &graph.nodes[*n];
        let is_source = match &node.kind {
            NodeKind::Start => true,
            NodeKind::Receiver(far) => far.carries_activity,
            kind => enters(kind),
        };
        node.starts_active || is_source && !next[*n].is_empty()
    };
    let mut found: BTreeSet<NodeId> = BTreeSet::new();
    let mut stack: Vec<NodeId> = graph.nodes.ids().filter(begins).collect();
    while let Some(node) = stack.pop() {
        if found.insert(node) {
            stack.extend(&next[node]);
        }
    }
    found.retain(|n| graph.can_hold_activity(*n));
    found
}
