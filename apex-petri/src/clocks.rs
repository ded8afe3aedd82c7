//! The times of nodes with a `timeout`.

use apex_dsl::{
    graph::{Graph, NodeId, NodeKind, Standard},
    index::IdVec,
};
use std::{collections::BTreeSet, time::Duration};

/// Since when the `timeout` of each node counts: since it became active, or, for a source that activity never comes to,
/// since it sent its last value.
#[derive(Clone)]
pub struct Clocks {
    now: Duration,
    since: IdVec<NodeId, Option<Duration>>,
    /// Sources whose silence is watched.
    watched: BTreeSet<NodeId>,
}

impl Clocks {
    /// The times at the beginning of a program with these sources.
    pub fn new(graph: &Graph, sources: &BTreeSet<NodeId>) -> Self {
        let active = reached_by_activity(graph);
        let watched: BTreeSet<NodeId> = sources.difference(&active).copied().collect();
        let begins = |n: NodeId| (graph.nodes[n].starts_active || watched.contains(&n)).then_some(Duration::ZERO);
        Self { now: Duration::ZERO, since: graph.nodes.ids().map(begins).collect(), watched }
    }

    /// The time of a reaction.
    pub fn set(&mut self, now: Duration) {
        self.now = now;
    }

    /// A node became active or inactive.
    pub fn turned(&mut self, node: NodeId, active: bool) {
        if !self.watched.contains(&node) {
            self.since[node] = active.then_some(self.now);
        }
    }

    /// A source sent a value, or triggered an event.
    pub fn sent(&mut self, node: NodeId) {
        if self.watched.contains(&node) {
            self.since[node] = Some(self.now);
        }
    }

    /// Returns `true` if the time of a node is over.
    pub fn is_due(&self, graph: &Graph, node: NodeId) -> bool {
        let since = self.since[node].zip(graph.nodes[node].modifiers.timeout);
        since.is_some_and(|(since, timeout)| self.now >= since + timeout)
    }

    /// The event of a node was triggered, which happens once.
    pub fn expire(&mut self, node: NodeId) {
        self.since[node] = None;
    }
}

/// The number of the event `timeout` among the ports of a node, if it is connected.
pub fn port(graph: &Graph, node: NodeId) -> Option<usize> {
    graph.nodes[node].ports.iter().position(|port| port.standard == Some(Standard::Timeout))
}

/// Nodes that activity can come to: from the beginning, over active connections, and from what is cancelled.
fn reached_by_activity(graph: &Graph) -> BTreeSet<NodeId> {
    let is_origin = |n: &NodeId| graph.nodes[*n].starts_active || matches!(graph.nodes[*n].kind, NodeKind::Start);
    let mut found: BTreeSet<NodeId> = graph.nodes.ids().filter(is_origin).collect();
    loop {
        let over = graph.connections.iter().filter(|c| c.active && found.contains(&c.from.node)).map(|c| c.to.node);
        let interrupts = graph.interrupts().filter(|interrupt| interrupt.takes.iter().any(|n| found.contains(n)));
        let cancelled = interrupts.map(|interrupt| interrupt.node);
        let new: Vec<NodeId> = over.chain(cancelled).filter(|node| !found.contains(node)).collect();
        if new.is_empty() {
            return found;
        }
        found.extend(new);
    }
}
