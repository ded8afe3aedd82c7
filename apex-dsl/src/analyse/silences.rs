//! Silences: where ⊥ takes the place of a token that does not come.
//!
//! A node with a `silence` parameter must be called although nothing comes. Its cluster waits for timers, which always
//! come, and for tokens from outside of the region, which may not: those at inputs of the program, of events and of
//! other thread groups. If such a token does not come for as long as the parameter says, the cluster that waits for it
//! takes ⊥ in its place.

use super::cluster::{Cluster, ClusterId, Guard};
use crate::{
    catalog::Catalog,
    graph::{Graph, NodeId, NodeKind},
    index::IdVec,
};
use std::collections::BTreeMap;

/// Guard in whose place ⊥ is taken after a silence.
#[derive(Debug)]
pub struct Silence {
    /// The guard, by its number in [`Analysis::guards`](super::Analysis::guards).
    pub guard: usize,
    /// Nodes downstream with a `silence` parameter. The shortest time counts.
    pub nodes: Vec<NodeId>,
}

/// Silences of a program, in the order of their guards.
pub fn silences(
    graph: &Graph,
    catalog: &Catalog,
    guards: &[Guard],
    clusters: &IdVec<ClusterId, Cluster>,
) -> Vec<Silence> {
    let mut nodes: BTreeMap<usize, Vec<NodeId>> = BTreeMap::new();
    for cluster in clusters.iter().filter(|cluster| cluster.fires && !graph.is_body) {
        let outside = |guard: &&usize| matches!(guards[**guard], Guard::Input(_) | Guard::Token(_));
        for &node in cluster.nodes.iter().filter(|node| parameter(graph, catalog, **node).is_some()) {
            cluster.guards.iter().filter(outside).for_each(|guard| nodes.entry(*guard).or_default().push(node));
        }
    }
    nodes.into_iter().map(|(guard, nodes)| Silence { guard, nodes }).collect()
}

/// Parameter of a node with the time without tokens after which it is called with ⊥.
pub fn parameter(graph: &Graph, catalog: &Catalog, node: NodeId) -> Option<usize> {
    match &graph.nodes[node].kind {
        NodeKind::Library(library) => catalog.signatures[library.signature].silence(),
        _ => None,
    }
}
