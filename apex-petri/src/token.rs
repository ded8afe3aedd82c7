//! Tokens with colours.

use super::PlaceId;
use apex_dsl::{
    graph::{Graph, NodeId, PortId},
    index::IdVec,
};
use std::collections::VecDeque;

/// Origin of a token.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Origin {
    /// The port that sent it.
    pub end: PortId,
    /// Number of previous calls of `process` and slots of that node.
    pub call: usize,
}

impl Origin {
    /// Origin of the values that the text gives to slots.
    pub fn given(graph: &Graph) -> Self {
        Self { end: PortId { node: NodeId::from(graph.nodes.len()), port: 0 }, call: 0 }
    }
}

/// A token. Places that carry no messages hold the default.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Token {
    /// Origin; `None` for an initial token.
    pub origin: Option<Origin>,
    /// `true` for a value, `false` for ⊥.
    pub value: bool,
    /// Effect on the activity of the node that takes it: 0, +1 or −1.
    pub modifier: i8,
}

/// Tokens at each place.
pub type Marking = IdVec<PlaceId, VecDeque<Token>>;
