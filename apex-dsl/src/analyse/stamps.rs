//! Where it must be known when the source fired that a token descends from (execution semantics, section 1): only where
//! somebody asks, because a node has a `deadline` or takes the context.

use super::{Analysis, Guard};
use crate::{
    catalog::{ArgSig, Catalog},
    graph::{Graph, NodeId, NodeKind},
};
use std::collections::BTreeSet;

/// What keeps stamps.
#[derive(Debug, Default)]
pub struct Stamps {
    /// Clusters with a node that wants to know, or that send to those.
    pub clusters: BTreeSet<usize>,
    /// Asynchronous connections to them.
    pub connections: BTreeSet<usize>,
}

/// Follows from those who ask to where their tokens come from.
pub fn stamps(graph: &Graph, catalog: &Catalog, analysis: &Analysis) -> Stamps {
    let mut search = Search { graph, analysis, found: Stamps::default() };
    for (node, n) in graph.nodes.iter().enumerate() {
        if n.modifiers.deadline.is_some() || asks(graph, catalog, node) {
            search.node(node);
        }
    }
    search.found
}

/// Whether a node can ask for the stamp.
fn asks(graph: &Graph, catalog: &Catalog, node: NodeId) -> bool {
    match &graph.nodes[node].kind {
        NodeKind::Library(library) => {
            let signature = &catalog.signatures[library.signature];
            let slots = signature.slots.iter().flat_map(|s| &s.args);
            signature.process.iter().flatten().chain(slots).any(|arg| *arg == ArgSig::Ctx)
        }
        NodeKind::Each(each) => (0..each.body.nodes.len()).any(|inner| asks(&each.body, catalog, inner)),
        _ => false,
    }
}

struct Search<'a> {
    graph: &'a Graph,
    analysis: &'a Analysis,
    found: Stamps,
}

impl Search<'_> {
    fn node(&mut self, node: NodeId) {
        let cluster = self.analysis.cluster_of[node];
        // A node that only has slots is in no cluster.
        if self.analysis.clusters.get(cluster).is_some_and(|c| c.nodes.contains(&node)) {
            self.cluster(cluster);
        }
        for &slot in &self.analysis.asynchronous.slots {
            if self.graph.connections[slot].to.node == node {
                self.connection(slot);
            }
        }
    }

    fn cluster(&mut self, cluster: usize) {
        if !self.found.clusters.insert(cluster) {
            return;
        }
        let c = &self.analysis.clusters[cluster];
        c.upstream.iter().for_each(|up| self.cluster(*up));
        for guard in &c.own_guards {
            if let Guard::Token(connection) = self.analysis.guards[*guard] {
                self.connection(connection);
            }
        }
    }

    fn connection(&mut self, connection: usize) {
        if self.found.connections.insert(connection) {
            self.node(self.graph.connections[connection].from.node);
        }
    }
}
