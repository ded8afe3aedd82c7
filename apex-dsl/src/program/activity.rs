//! Lowering of activity (execution semantics, section 5), for the nodes that activity can reach. All others are never
//! active, and nothing is done for them.

use super::{Carries, Flag, Lowering, Op, Ops};
use crate::{
    graph::{Flow, NodeId, NodeKind, PortId, Standard},
    machine::Move,
};

impl Lowering<'_> {
    /// Activation of a node, unless it is active already.
    pub fn activate(&self, node: NodeId) -> Op {
        Op::Activate { node, then: self.turn_effects(node, true) }
    }

    /// Deactivation of a node, if it is active.
    pub fn deactivate(&self, node: NodeId) -> Op {
        Op::Deactivate { node, then: self.turn_effects(node, false) }
    }

    /// Event and hook of a node whose activity has changed.
    pub fn turn_effects(&self, node: NodeId, active: bool) -> Ops {
        let event = if active { Standard::Activated } else { Standard::Deactivated };
        let has_hook = self.lower.signature(node).is_some_and(|signature| match active {
            true => signature.on_activate.is_some(),
            false => signature.on_deactivate.is_some(),
        });
        let hook = has_hook.then_some(Op::Hook { node, active });
        self.trigger(node, event).into_iter().chain(hook).collect()
    }

    /// Triggers an event that every node has, if it is connected.
    pub fn trigger(&self, node: NodeId, standard: Standard) -> Option<Op> {
        self.lower.standard_event(node, standard).map(Op::Trigger)
    }

    /// Activity has moved: the claims are looked at, if there are any.
    pub fn check_claims(&self) -> Option<Op> {
        self.lower.checks_claims().then_some(Op::CheckClaims)
    }

    /// A1 for the inputs of a node: what its tokens carried counts now.
    pub fn take_activity(&self, node: NodeId) -> Option<Op> {
        if !self.lower.is_active(node) || self.lower.graph.nodes[node].is_delay() {
            return None;
        }
        let turn = |what: &[Carries], active: bool| -> Ops {
            if !self.lower.inputs_carry(node, what) {
                return vec![];
            }
            let turn = if active { self.activate(node) } else { self.deactivate(node) };
            [turn].into_iter().chain(self.check_claims()).collect()
        };
        let (gains, loses) = (turn(&[Carries::Always, Carries::Sometimes], true), turn(&[Carries::Away], false));
        (!gains.is_empty() || !loses.is_empty()).then_some(Op::TakeActivity { node, gains, loses })
    }

    /// A2 and A5 for the ports of a node that may have `sent`: its activity goes with the first token over an active
    /// connection.
    pub fn pass_activity(&self, node: NodeId, sent: &dyn Fn(PortId) -> bool) -> Ops {
        let is_delay = self.lower.graph.nodes[node].is_delay();
        let mut ops = vec![];
        for row in self.wiring.of(node).iter().filter(|row| row.is_active && sent(row.end)) {
            let port = row.end;
            match row.passes {
                None if row.takes_away.is_empty() => {}
                None => ops.push(Op::Pass { port, then: vec![] }),
                Some(_) if is_delay => {
                    if !row.takes_away.is_empty() {
                        ops.push(Op::Pass { port, then: vec![] });
                    }
                    ops.push(Op::PassHeld(port));
                }
                Some(_) => {
                    let mut then = self.turn_effects(node, false);
                    then.extend(self.check_claims());
                    ops.push(Op::Pass { port, then });
                }
            }
        }
        ops
    }

    /// `start`: the nodes that are active from the beginning, and the tokens of its events.
    fn begin(&self) -> Ops {
        let graph = self.lower.graph;
        let mut ops = vec![];
        for (node, n) in graph.nodes.iter_enumerated() {
            if n.starts_active && self.lower.is_active(node) {
                ops.push(self.activate(node));
                ops.extend(self.tell(node));
            }
            let end = PortId { node, port: 0 };
            if matches!(n.kind, NodeKind::Start) && self.lower.is_sent_event(end) {
                ops.push(Op::Trigger(end));
                ops.extend(self.started(end).into_iter().map(|flag| Op::Set(flag, true)));
                ops.extend(self.emit(node, false));
            }
        }
        ops.extend(self.check_claims());
        ops
    }

    /// Flags of the tokens of `start`, which carry activity.
    fn started(&self, end: PortId) -> Vec<Flag> {
        let graph = self.lower.graph;
        let sent = graph.connections.iter_enumerated().filter(|(_, c)| c.from == end);
        let flags = sent.filter_map(|(i, c)| match self.lower.carries(i) {
            Carries::Sometimes => Some(self.lower.flag(i)),
            // A slot knows that its token always carries activity.
            Carries::Always if graph.flow(c) != Flow::ToSlot => Some(self.lower.flag(i)),
            _ => None,
        });
        flags.collect()
    }

    /// Operations before the first reaction.
    pub fn first(&self) -> Ops {
        let watches = self.lower.graph.nodes.ids().filter_map(|node| self.watch_silence(node));
        let waits = self.lower.graph.nodes.ids().filter_map(|node| self.time_states(node));
        watches.chain([Op::ShowStates]).chain(waits).chain(self.begin()).collect()
    }

    /// The times of the states of a machine follow its moves.
    pub fn time_states(&self, node: NodeId) -> Option<Op> {
        (!self.lower.waits(node).is_empty()).then_some(Op::TimeStates(node))
    }

    /// `reset`: nothing is active, no token under way carries activity, and `start` is triggered again.
    pub fn reset(&self) -> Ops {
        let graph = self.lower.graph;
        let mut ops = vec![];
        for &node in &self.lower.analysis.active {
            if graph.nodes[node].is_delay() {
                ops.push(Op::ClearHeld(node));
                continue;
            }
            ops.extend(self.clear_told(node));
            ops.push(self.deactivate(node));
            // Those that `start` makes active again say both at once.
            if !graph.nodes[node].starts_active {
                ops.extend(self.tell(node));
            }
        }
        ops.push(Op::ForgetTokens);
        let remembering = self.lower.analysis.active.iter().copied().filter(|node| self.lower.remembers(*node));
        ops.extend(remembering.map(Op::ForgetCancelled));
        ops.extend(graph.nodes.ids().flat_map(|node| self.move_machine(node, Move::Restart)));
        ops.extend(self.begin());
        ops
    }

    /// Moves a state machine to another state, and sends its events. Nothing for other nodes.
    pub fn move_machine(&self, node: NodeId, how: Move) -> Ops {
        if self.lower.machine(node).is_none() {
            return vec![];
        }
        // Its other events may still be on their way.
        let comes = |end: PortId| self.lower.graph.port(end).comes_with_moves;
        let mut ops = self.clear(node, &comes);
        ops.push(Op::Move { node, how });
        ops.extend(self.time_states(node));
        ops.extend(self.emit_from(node, &comes));
        ops
    }

    /// The time of a source's silence begins.
    pub fn watch_silence(&self, node: NodeId) -> Option<Op> {
        self.lower.watches_silence(node)?;
        self.wiring.timeout(node).map(Op::StartTimeout)
    }
}
