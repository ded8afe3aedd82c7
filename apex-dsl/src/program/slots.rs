//! Lowering of slots and timeouts, and of what is sent when a firing ends.

use super::{Carries, Flag, Lowering, Op, Ops, Served, Timeout};
use crate::{
    analyse::{Delivery, ordered},
    catalog::ArgSig,
    graph::{ConnectionId, NodeId, NodeKind, PortId, Standard},
    syntax::tree::PortKind,
};

impl Lowering<'_> {
    /// The tokens of a node's asynchronous connections are on their way, as far as there are any: those for slots
    /// are queued, those for inputs lie there. A slot sends on events only.
    pub fn emit(&self, node: NodeId, by_process: bool) -> Ops {
        self.emit_from(node, &|end| by_process || self.lower.graph.port(end).kind == PortKind::Event)
    }

    /// The same for the events that activity came, or went.
    pub fn tell(&self, node: NodeId) -> Ops {
        self.emit_from(node, &|end| self.lower.graph.port(end).tells_of_activity())
    }

    /// The tokens of some ports of a node are on their way.
    pub fn emit_from(&self, node: NodeId, wanted: &dyn Fn(PortId) -> bool) -> Ops {
        let rows = self.wiring.of(node).iter().filter(|port| wanted(port.end) && !port.sends.is_empty());
        rows.map(|port| Op::Send(port.end)).collect()
    }

    /// A step of a node ends: its activity goes with the first of its `events` that were triggered, and all of them are
    /// on their way.
    fn leave(&self, node: NodeId, events: &dyn Fn(PortId) -> bool) -> Ops {
        let mut ops = self.pass_activity(node, events);
        ops.extend(self.emit_from(node, events));
        ops
    }

    /// Events of a node that are connected are empty before it may trigger them.
    pub fn clear_events(&self, node: NodeId) -> Ops {
        self.clear(node, &|_| true)
    }

    /// The events `activated` and `deactivated` of a node are empty before its activity changes.
    pub fn clear_told(&self, node: NodeId) -> Ops {
        self.clear(node, &|end| self.lower.graph.port(end).tells_of_activity())
    }

    /// Some events of a node are empty before it may trigger them.
    pub fn clear(&self, node: NodeId, wanted: &dyn Fn(PortId) -> bool) -> Ops {
        let ends = (0..self.lower.graph.nodes[node].ports.len()).map(|port| PortId { node, port });
        ends.filter(|end| wanted(*end) && self.lower.is_sent_event(*end)).map(Op::Clear).collect()
    }

    /// Operations for the token of a slot.
    pub fn served(&self, number: usize) -> Served {
        let slot = &self.wiring.slots[number];
        let (connection, node, graph) = (slot.connection, slot.node, self.lower.graph);
        let brings = slot.carries_to(graph);
        let turns = brings != Carries::Nothing;
        let turned = if turns { self.turn_effects(node, brings != Carries::Away) } else { vec![] };
        let triggers = |end: PortId| match graph.port(end).tells_of_activity() {
            true => turns,
            false => self.may_trigger(connection, end),
        };
        let taken = self.takes(connection);
        let body = self.call_slot(number, taken);
        let call = match taken {
            true => vec![Op::Taking { port: graph.connections[connection].from, body }],
            false => body,
        };
        let call = self.check_claims().filter(|_| turns).into_iter().chain(call).collect();
        let mut after = self.leave(node, &|end| self.lower.is_sent_event(end) && triggers(end));
        after.extend(slot.settles.map(Op::Settle));
        Served { clear: self.clear(node, &triggers), turned, call, after }
    }

    /// Returns `true` if a slot removes its token. Without a queue, the last slot that a token reaches does.
    fn takes(&self, connection: ConnectionId) -> bool {
        let from = self.lower.graph.connections[connection].from;
        let same = |c: &&ConnectionId| self.lower.graph.connections[**c].from == from;
        self.lower.analysis.asynchronous.delivery != Delivery::Queued
            && self.lower.links.sends[from.node].iter().rfind(same) == Some(&connection)
    }

    /// Returns `true` if the call of a slot may trigger an event: one that is an argument, or tells how the call went.
    fn may_trigger(&self, connection: ConnectionId, event: PortId) -> bool {
        let to = self.lower.graph.connections[connection].to;
        let Some(signature) = self.lower.signature(to.node) else { return true };
        match signature.slots.iter().find(|slot| slot.port == to.port) {
            Some(slot) => {
                let is_argument = slot.args.iter().any(|arg| matches!(arg, ArgSig::Port(port) if *port == event.port));
                is_argument || self.lower.graph.port(event).standard.is_some()
            }
            // `enable` and `disable` call nothing.
            None => false,
        }
    }

    /// The call of a slot's method, or what the slot of a built-in node does.
    fn call_slot(&self, slot: usize, taken: bool) -> Ops {
        let graph = self.lower.graph;
        let c = &graph.connections[self.wiring.slots[slot].connection];
        let node = c.to.node;
        match (&graph.nodes[node].kind, graph.port(c.to).standard) {
            (_, Some(Standard::Disable)) => vec![Op::Set(Flag::Enabled(node), false)],
            (_, Some(Standard::Enable)) if graph.nodes[node].can_be_disabled() => {
                // It was told to be silent: that is over now.
                let watch = self.watch_silence(node);
                let watch = watch.map(|watch| Op::If { flag: Flag::Enabled(node), is: false, then: vec![watch] });
                watch.into_iter().chain([Op::Set(Flag::Enabled(node), true)]).collect()
            }
            // `enable` of a node that nothing disables is called only for the activity that it carries.
            (NodeKind::Library(_), Some(_)) => vec![],
            (NodeKind::Library(_), None) if graph.nodes[node].can_be_disabled() => {
                let call = self.call_and_time(node, Op::Call { slot, taken, call: self.slot_call(c.to) });
                vec![Op::If { flag: Flag::Enabled(node), is: true, then: call }]
            }
            (NodeKind::Library(_), None) => {
                self.call_and_time(node, Op::Call { slot, taken, call: self.slot_call(c.to) })
            }
            (NodeKind::Probe, _) => vec![Op::SeeSlot { slot, taken }],
            (NodeKind::Exit(code), _) => vec![Op::Exit(*code)],
            (NodeKind::Reset, _) => vec![Op::Reset],
            (NodeKind::Interrupt(_), _) => {
                let call = Op::Interrupt(c.to);
                // Over `=>`, only activity is given back.
                match c.active && Standard::Resume.is_of_interrupt(c.to.port) {
                    true if !self.lower.is_active(node) => vec![],
                    true => vec![Op::If { flag: Flag::Active(node), is: true, then: vec![call] }],
                    false => vec![call],
                }
            }
            (NodeKind::Boundary(_), _) => {
                vec![Op::PutOut { slot, taken, room: self.wiring.bits.room().get(&node).copied() }]
            }
            _ => vec![],
        }
    }

    /// A call, after which the times of the states of a machine follow.
    fn call_and_time(&self, node: NodeId, call: Op) -> Ops {
        [call].into_iter().chain(self.time_states(node)).collect()
    }

    /// The timeout with this number has come: its event is triggered, with the activity of the node. A machine leaves
    /// its state.
    pub fn expired(&self, number: usize) -> Ops {
        let (graph, Timeout { node, wait, .. }) = (self.lower.graph, &self.wiring.timeouts[number]);
        let node = *node;
        let mut ops = vec![Op::StopTimeout(number)];
        if let Some(wait) = *wait {
            ops.extend(self.leave_state(node, wait));
            ops.extend(self.deliver(&self.lower.links.sends[node]));
            return ops;
        }
        let timeout = self.lower.standard_event(node, Standard::Timeout);
        ops.extend(self.clear(node, &|end| Some(end) != timeout));
        ops.extend(timeout.map(Op::Trigger));
        ops.extend(self.leave(node, &|end| {
            let sent = matches!(graph.port(end).standard, Some(Standard::Timeout | Standard::Deactivated));
            sent && self.lower.is_sent_event(end)
        }));
        ops.extend(self.deliver(&self.lower.links.sends[node]));
        ops
    }

    fn leave_state(&self, node: NodeId, wait: usize) -> Ops {
        let events = &self.lower.waits(node)[wait].events;
        let triggers = |end: PortId| events.contains(&end.port);
        let mut ops = self.clear(node, &triggers);
        let call = Op::LeaveState { node, wait, call: self.wait_call(node, wait) };
        ops.extend(self.call_and_time(node, call));
        ops.extend(self.leave(node, &|end| self.lower.is_sent_event(end) && triggers(end)));
        ops
    }

    /// Serves the slots that tokens on `sends` can come to, one after the other, where that needs no queue.
    pub fn deliver(&self, sends: &[ConnectionId]) -> Ops {
        let (graph, asynchronous) = (self.lower.graph, &self.lower.analysis.asynchronous);
        let slot = |c: &ConnectionId| asynchronous.slot(*c);
        match asynchronous.delivery {
            Delivery::Queued => vec![],
            Delivery::Single => {
                // At most one token is in flight. It may follow a circle.
                let (connections, circle) = asynchronous.following(sends);
                let slots: Vec<usize> = connections.iter().map(slot).collect();
                match circle {
                    true => vec![Op::ServeCircle(slots)],
                    false => slots.into_iter().map(|slot| Op::Serve { slot, unless_exit: false }).collect(),
                }
            }
            Delivery::Ordered => {
                let connections = ordered(graph, self.lower.links, asynchronous, sends).unwrap_or_default();
                let ends =
                    |c: &ConnectionId| matches!(graph.nodes[graph.connections[*c].to.node].kind, NodeKind::Exit(_));
                let last = connections.iter().position(ends).unwrap_or(connections.len());
                let serves = connections.iter().enumerate();
                serves.map(|(at, c)| Op::Serve { slot: slot(c), unless_exit: at > last }).collect()
            }
        }
    }
}
