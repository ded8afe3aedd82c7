//! Input of the passes that determine guards.

use super::{asynchronous::Asynchronous, firing::fires, links::Links};
use crate::{
    catalog::Catalog,
    graph::{ConnectionId, Graph, NodeId},
    index::IdVec,
    syntax::tree::PortKind,
};

/// Input of the passes that determine guards.
pub struct View<'a> {
    pub graph: &'a Graph,
    pub catalog: &'a Catalog,
    pub links: &'a Links,
    pub order: &'a [NodeId],
    pub regions: &'a IdVec<NodeId, usize>,
    pub asynchronous: &'a Asynchronous,
}

impl View<'_> {
    /// Returns `true` if a node fires, and so belongs to a cluster.
    pub fn fires(&self, node: NodeId) -> bool {
        fires(self.graph, self.catalog, self.links, node)
    }

    /// Returns `true` if an output of a node leads to a slot that may leave the token there. Until it is taken, the
    /// nodes upstream are held back (R4).
    pub fn sends_what_stays(&self, node: NodeId) -> bool {
        let is_output = |c: &ConnectionId| self.graph.port(self.graph.connections[*c].from).kind == PortKind::Output;
        self.links.sends[node].iter().any(|c| is_output(c) && self.asynchronous.may_block[*c])
    }
}
