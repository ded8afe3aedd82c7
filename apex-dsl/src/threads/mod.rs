//! Thread groups: a graph whose nodes run on several threads becomes one graph for each group, with cells between them.
//!
//! Every connection from one group to another leads through a cell: from a [`Sender`](crate::graph::NodeKind::Sender) in
//! the graph of the one to a [`Receiver`](crate::graph::NodeKind::Receiver) in that of the other. For its sender the cell is a
//! connection that stays occupied until the other side is done with the token (R4, R6, R7); for its receiver it is an event.
//! So each group is analysed, and runs, as any graph does.

mod check;
mod split;

use crate::{
    analyse::Analysis,
    graph::{End, Graph, NodeId},
};

pub use check::check;
pub use split::{groups, split};

/// The graphs of all thread groups.
#[derive(Debug)]
pub struct Split {
    /// One for each group, that of the main group first, the others in the order of the text.
    pub parts: Vec<Part>,
    /// What is between them.
    pub cells: Vec<Cell>,
}

/// The graph of a thread group.
#[derive(Debug)]
pub struct Part {
    /// The name of the group.
    pub group: String,
    /// Its nodes, and the ends of cells.
    pub graph: Graph,
    /// What is known about it.
    pub analysis: Analysis,
    /// For each node what it is in the whole graph.
    pub origins: Vec<Origin>,
    /// For each connection its number in the whole graph, unless it leads to a cell.
    pub connections: Vec<Option<usize>>,
}

/// What a node of a part is in the whole graph.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Origin {
    /// A node.
    Node(NodeId),
    /// Nothing: it passes on the tokens of this port.
    Token(End),
}

/// Room for one token between two thread groups. All connections from a port to nodes of one group share it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Cell {
    /// The port in the whole graph whose tokens it takes.
    pub from: End,
    /// The part that puts tokens in; who watches the threads is none.
    pub sender: Option<usize>,
    /// The part that takes them out.
    pub receiver: usize,
}

impl Part {
    /// A port of a node in the whole graph, if it has that node.
    pub fn node(&self, end: End) -> Option<End> {
        matches!(self.origins[end.node], Origin::Node(_)).then(|| self.origin(end))
    }

    /// A port of a node in the whole graph; for what passes tokens on, the port that they come from.
    pub fn origin(&self, end: End) -> End {
        match self.origins[end.node] {
            Origin::Node(node) => End { node, port: end.port },
            Origin::Token(from) => from,
        }
    }
}
