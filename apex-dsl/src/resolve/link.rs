//! Connections as written, for tools that show them. The graph itself contains only the resulting connections of nodes.

use crate::{catalog::Type, graph::Flow, source::Span, syntax::tree::PortKind};

/// A connection that an arrow makes; lists make one for each pair of their ends.
#[derive(Debug, Clone)]
pub struct Link {
    /// The arrow.
    pub arrow: Span,
    /// `true` for `=>`, on which activity passes.
    pub active: bool,
    /// `true` if `.*` stands at its ends.
    pub by_name: bool,
    /// Origin of the tokens.
    pub from: Side,
    /// Destination of the tokens.
    pub to: Side,
}

/// An end of a connection.
#[derive(Debug, Clone)]
pub struct Side {
    /// The port that is meant, as it would be named in the graph: `node.port`, or a port of the graph.
    pub name: String,
    /// Kind of the port, seen from the arrow.
    pub kind: PortKind,
    /// Type of the tokens, as far as it is declared.
    pub ty: Type,
}

impl Side {
    /// Name of the port alone.
    pub fn port(&self) -> &str {
        self.name.rsplit('.').next().unwrap_or(&self.name)
    }
}

impl Link {
    /// Manner in which tokens travel.
    pub fn flow(&self) -> Flow {
        match (self.from.kind, self.to.kind) {
            (_, PortKind::Slot) => Flow::ToSlot,
            (PortKind::Output, _) => Flow::Synchronous,
            _ => Flow::ToInput,
        }
    }
}
