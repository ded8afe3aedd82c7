//! Connections as they are written, for tools that show them. The graph itself knows only what they lead to in the end.

use crate::{catalog::Type, graph::Flow, source::Span, syntax::tree::PortKind};

/// What one arrow connects; lists have one for each pair of their ends.
#[derive(Debug, Clone)]
pub struct Link {
    /// The arrow.
    pub arrow: Span,
    /// Whether activity passes.
    pub active: bool,
    /// Where tokens come from.
    pub from: Side,
    /// Where they go.
    pub to: Side,
}

/// One side of an arrow.
#[derive(Debug, Clone)]
pub struct Side {
    /// What is written there.
    pub span: Span,
    /// The port that is meant.
    pub port: String,
    /// Its kind, seen from the arrow.
    pub kind: PortKind,
    /// The type of its tokens, as far as it is declared.
    pub ty: Type,
}

impl Link {
    /// How tokens travel.
    pub fn flow(&self) -> Flow {
        match (self.from.kind, self.to.kind) {
            (_, PortKind::Slot) => Flow::ToSlot,
            (PortKind::Output, _) => Flow::Synchronous,
            _ => Flow::ToInput,
        }
    }
}
