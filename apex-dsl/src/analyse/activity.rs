//! The activity sub-graph (thesis 7.1.2): which nodes can ever be active.

use crate::graph::{Graph, NodeId, NodeKind};
use std::collections::BTreeSet;

/// The nodes that activity can reach. All others are never active, and cost nothing.
pub fn reachable(graph: &Graph) -> BTreeSet<NodeId> {
    let mut next: Vec<Vec<NodeId>> = vec![vec![]; graph.nodes.len()];
    for c in graph.connections.iter().filter(|c| c.active) {
        next[c.from.node].push(c.to.node);
    }
    let begins = |n: &NodeId| {
        let node = &graph.nodes[*n];
        node.starts_active || matches!(node.kind, NodeKind::Start | NodeKind::Receiver(_)) && !next[*n].is_empty()
    };
    let mut found: BTreeSet<NodeId> = BTreeSet::new();
    let mut stack: Vec<NodeId> = (0..graph.nodes.len()).filter(begins).collect();
    while let Some(node) = stack.pop() {
        if found.insert(node) {
            stack.extend(&next[node]);
        }
    }
    found.retain(|n| graph.can_hold_activity(*n));
    found
}
