//! Lowering of `cancel` and `resume`: activity is taken out of a node or nested graph, and given back.

use super::{Cancel, Carries, Flag, Lower, Lowering, Op, Ops, Taken};
use crate::{
    graph::{ConnectionId, Interrupt, NodeId, PortId, Standard},
    machine::Move,
};
use std::collections::{BTreeMap, BTreeSet};

impl Lower<'_> {
    /// Returns `true` if a node interrupts, and has to remember for its `resume` what it took.
    pub fn remembers(self, node: NodeId) -> bool {
        let interrupts = self.graph.nodes[node].interrupts().is_some() && self.is_active(node);
        interrupts && self.is_called(node, Standard::Resume)
    }

    fn is_called(self, node: NodeId, standard: Standard) -> bool {
        let called = |c: &ConnectionId| {
            let to = self.graph.connections[*c].to;
            to.node == node && standard.is_of_interrupt(to.port)
        };
        self.analysis.asynchronous.slots.iter().any(called)
    }
}

impl Lowering<'_> {
    /// The slots `cancel` and `resume` that are called, and what they do.
    pub fn interrupts(&self) -> Vec<(PortId, Ops)> {
        let mut found = vec![];
        for Interrupt { node, takes, .. } in self.lower.graph.interrupts() {
            let nodes: Vec<NodeId> = takes.iter().copied().filter(|node| self.lower.is_active(*node)).collect();
            for standard in [Standard::Cancel, Standard::Resume] {
                let Some(port) = standard.of_interrupt().filter(|_| self.lower.is_called(node, standard)) else {
                    continue;
                };
                let (body, how) = match standard {
                    Standard::Cancel => (self.cancel(node, &nodes), Move::Cancel),
                    _ => (self.resume(node, &nodes), Move::Resume),
                };
                let machines = takes.iter().flat_map(|node| self.move_machine(*node, how));
                found.push((PortId { node, port }, machines.chain(body).collect()));
            }
        }
        found
    }

    /// Takes the activity of nodes and of tokens on their way to them. It goes along with the event `cancelled`.
    fn cancel(&self, interrupt: NodeId, nodes: &[NodeId]) -> Ops {
        let among: BTreeSet<NodeId> = nodes.iter().copied().collect();
        let mut carrying: BTreeMap<NodeId, Vec<Flag>> = BTreeMap::new();
        for (number, slot) in self.wiring.slots.iter().enumerate().filter(|(_, s)| s.carries == Carries::Sometimes) {
            carrying.entry(slot.node).or_default().push(Flag::Carries(number));
        }
        let is_reached = self.lower.is_active(interrupt);
        let remembers = self.lower.remembers(interrupt);
        let takes = nodes.iter().map(|&node| {
            let mut on_the_way = vec![];
            if self.lower.inputs_carry(node, &[Carries::Always, Carries::Sometimes]) {
                on_the_way.push(Flag::Gains(node));
            }
            on_the_way.extend(carrying.get(&node).into_iter().flatten());
            if self.lower.graph.nodes[node].is_delay() {
                return Taken { node, on_the_way, remember: vec![], then: vec![Op::ClearHeld(node)] };
            }
            let receivers = self.lower.graph.receivers(node).into_iter();
            let remember = receivers.filter(|node| remembers && among.contains(node)).collect();
            let mut then = self.clear_told(node);
            then.push(self.deactivate(node));
            then.extend(self.tell(node));
            Taken { node, on_the_way, remember, then }
        });
        let takes = takes.collect();
        let event = Standard::Cancelled.of_interrupt().map(|port| PortId { node: interrupt, port });
        let cancelled = event.filter(|event| self.lower.is_sent_event(*event)).map(|event| {
            let passes = self.wiring.of(interrupt).iter().any(|port| port.is_active && port.passes.is_some());
            (event, passes && is_reached)
        });
        let cancel = Op::Cancel(Cancel { interrupt, remembers, is_reached, takes, cancelled });
        [cancel].into_iter().chain(self.check_claims()).collect()
    }

    /// Gives activity back to the nodes from which `cancel` took it.
    fn resume(&self, interrupt: NodeId, nodes: &[NodeId]) -> Ops {
        if !self.lower.remembers(interrupt) {
            return vec![];
        }
        let mut ops = vec![Op::Set(Flag::Active(interrupt), false)];
        for &node in nodes.iter().filter(|node| !self.lower.graph.nodes[**node].is_delay()) {
            let mut then = self.clear_told(node);
            then.push(self.activate(node));
            then.extend(self.tell(node));
            ops.push(Op::GiveBack { interrupt, node, then });
        }
        ops.extend(self.check_claims());
        ops
    }
}
