//! Activity that tokens may carry.

use super::{
    flags::{Carries, Flag},
    lower::Lower,
};
use crate::{
    analyse::takes_activity,
    graph::{ConnectionId, Flow, NodeId, NodeKind},
};

impl Lower<'_> {
    /// Activity that the tokens on `connection` may carry.
    pub fn carries(self, connection: ConnectionId) -> Carries {
        let c = &self.graph.connections[connection];
        let checked = self.checks_claims();
        // Claims have to know of activity on its way to the end of the program.
        let ends = checked && matches!(self.graph.nodes[c.to.node].kind, NodeKind::Exit(_));
        if !c.active || !(ends || self.is_active(c.to.node)) {
            return Carries::Nothing;
        }
        match &self.graph.nodes[c.from.node].kind {
            // The activity of a token that waits can be cancelled.
            NodeKind::Start if checked || self.analysis.cancelled.contains(&c.to.node) => Carries::Sometimes,
            NodeKind::Start => Carries::Always,
            _ if takes_activity(self.graph, self.catalog, c.from.node) => Carries::Away,
            _ if self.is_active(c.from.node) => Carries::Sometimes,
            _ => Carries::Nothing,
        }
    }

    /// Flag of activity that the token on `connection` carries.
    pub fn flag(self, connection: ConnectionId) -> Flag {
        let c = &self.graph.connections[connection];
        match self.graph.flow(c) {
            Flow::ToSlot => Flag::Carries(self.analysis.asynchronous.slot(connection)),
            Flow::Synchronous | Flow::ToInput => Flag::Gains(c.to.node),
        }
    }

    /// The connections into the inputs of a node whose tokens may carry one of `what`.
    pub fn inputs_carry(self, node: NodeId, what: &[Carries]) -> bool {
        self.links.inputs[node].iter().any(|c| what.contains(&self.carries(*c)))
    }
}
