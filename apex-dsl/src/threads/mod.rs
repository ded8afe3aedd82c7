//! Thread groups: a graph whose nodes run on several threads becomes one graph per group, with cells between them.
//!
//! Every connection between two groups leads through a cell: from a [`Sender`](crate::graph::NodeKind::Sender) in the
//! graph of one group to a [`Receiver`](crate::graph::NodeKind::Receiver) in the graph of the other. To the sending
//! group the cell is a connection that stays occupied until the other group is done with the token (R4, R6, R7). To the
//! receiving group it is an event. Each group is therefore analysed, and runs, like any other graph.

mod check;
mod pace;
mod split;

use crate::{
    analyse::Analysis,
    graph::{ConnectionId, Graph, NodeId, PortId},
    index::IdVec,
};

pub use check::check;
pub use split::split;

/// The graphs of all thread groups.
#[derive(Debug)]
pub struct Split {
    /// One part per group: the main group first, then the others in the order of the source file.
    pub parts: Vec<Part>,
    /// Cells between the parts.
    pub cells: Vec<Cell>,
}

/// The graph of a thread group.
#[derive(Debug)]
pub struct Part {
    /// The name of the group.
    pub group: String,
    /// Nodes of the group, and the ends of its cells.
    pub graph: Graph,
    /// Analysis of the graph.
    pub analysis: Analysis,
    /// For each node, its counterpart in the whole graph.
    pub origins: IdVec<NodeId, Origin>,
    /// For each connection, its number in the whole graph, unless it leads to a cell or a relay.
    pub connections: IdVec<ConnectionId, Option<ConnectionId>>,
}

/// Counterpart of a node in the whole graph.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Origin {
    /// A node.
    Node(NodeId),
    /// None: the node passes on the tokens of this port.
    Token(PortId),
}

/// Room for one token between two thread groups. Connections from one port to nodes of one group share a cell, but a
/// cell is either for synchronous or for asynchronous connections.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Cell {
    /// The port in the whole graph that sends the tokens.
    pub from: PortId,
    /// The part that puts tokens in; `None` for the watchdog.
    pub sender: Option<usize>,
    /// The part that takes tokens out.
    pub receiver: usize,
}

impl Part {
    /// The same port in the whole graph, if the node has a counterpart there.
    pub fn node(&self, end: PortId) -> Option<PortId> {
        matches!(self.origins[end.node], Origin::Node(_)).then(|| self.origin(end))
    }

    /// The same port in the whole graph. For a node that only passes tokens on: the port that they come from.
    pub fn origin(&self, end: PortId) -> PortId {
        match self.origins[end.node] {
            Origin::Node(node) => PortId { node, port: end.port },
            Origin::Token(from) => from,
        }
    }
}
