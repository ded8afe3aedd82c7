//! Results of the analysis of a graph.

use super::{
    asynchronous::Asynchronous,
    characteristics::Characteristics,
    clocks::Clock,
    cluster::{Cluster, ClusterId, Guard},
    links::Links,
    silences::Silence,
};
use crate::{
    graph::{ConnectionId, Graph, NodeId},
    index::IdVec,
    syntax::tree::PortKind,
};
use std::collections::{BTreeMap, BTreeSet};

/// Results of the analysis of a graph.
#[derive(Debug)]
pub struct Analysis {
    /// All nodes, producers before consumers, otherwise in the order of the source file.
    pub order: Vec<NodeId>,
    /// Number of firings of each node in one iteration of its region.
    pub repetitions: IdVec<NodeId, u64>,
    /// Region of each node.
    pub regions: IdVec<NodeId, usize>,
    /// Guards of all clusters.
    pub guards: Vec<Guard>,
    /// Clusters, in the order of their first node.
    pub clusters: IdVec<ClusterId, Cluster>,
    /// Cluster of each node. Nodes that do not fire have the number 0, but are in no cluster.
    pub cluster_of: IdVec<NodeId, ClusterId>,
    /// Characteristics of each node for pruning (thesis eqs. 3.6–3.8).
    pub characteristics: IdVec<NodeId, Characteristics>,
    /// Clock of each node.
    pub clocks: IdVec<NodeId, Clock>,
    /// Guards in whose place ⊥ is taken after a silence.
    pub silences: Vec<Silence>,
    /// Connections with slots or events.
    pub asynchronous: Asynchronous,
    /// Clusters and connections that keep stamps.
    pub stamps: Stamps,
    /// Nodes that activity can reach.
    pub active: BTreeSet<NodeId>,
    /// Nodes whose activity can be cancelled.
    pub cancelled: BTreeSet<NodeId>,
    /// Connections of each node.
    pub links: Links,
    /// Analysis of the body of each `each` node.
    pub bodies: BTreeMap<NodeId, Analysis>,
}

impl Analysis {
    /// Returns `true` if a cluster needs no dispatcher: it fires once per reaction, exchanges no synchronous
    /// tokens with other clusters, and nothing that it sends can hold it back.
    pub fn is_free(&self, graph: &Graph, cluster: &Cluster) -> bool {
        let holds_back = |c: &ConnectionId| {
            self.asynchronous.may_block[*c] && graph.port(graph.connections[*c].from).kind == PortKind::Output
        };
        cluster.upstream.is_empty()
            && cluster.downstream.is_empty()
            && cluster.own_guards.iter().all(|g| self.guards[*g] == Guard::React)
            && !cluster.sends.iter().any(holds_back)
    }

    /// Cluster in which a node fires; `None` for a node that only has slots.
    pub fn fires_in(&self, node: NodeId) -> Option<ClusterId> {
        let cluster = self.cluster_of[node];
        self.clusters.get(cluster).is_some_and(|c| c.nodes.contains(&node)).then_some(cluster)
    }
}

/// Clusters and connections that keep stamps.
#[derive(Debug, Default)]
pub struct Stamps {
    /// Clusters with a node that uses stamps, and all from which its tokens come.
    pub clusters: BTreeSet<ClusterId>,
    /// Asynchronous connections whose tokens have stamps, in order.
    pub connections: Vec<ConnectionId>,
}

impl Stamps {
    /// The number of a connection's stamp, if it is kept.
    pub fn number(&self, connection: ConnectionId) -> Option<usize> {
        self.connections.binary_search(&connection).ok()
    }
}
