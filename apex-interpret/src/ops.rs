//! Execution of operations: activity, events, slots and time.

use crate::{
    Value,
    run::{Place, Run},
};
use apex_dsl::{
    graph::{NodeId, PortId},
    program::{Cancel, Carries, Flag, Op, Taken},
    syntax::tree::PortKind,
};
use apex_rt::{Ctx, Observer, Time};

impl<'r, O: Observer> Run<'r, '_, O> {
    /// Executes operations in sequence.
    pub fn ops(&mut self, ops: &[Op], ctx: &Ctx, place: &mut Place<'_, 'r>) {
        let mut ctx = *ctx;
        for op in ops {
            if let Op::Stamp { upstream, stamps, leaves } = op {
                let clusters = upstream.iter().filter_map(|up| self.state.cluster_stamps.get(up).copied());
                let ages: Vec<Time> = clusters.chain(stamps.iter().map(|stamp| self.state.stamps[*stamp])).collect();
                ctx = ages.into_iter().min().map_or(ctx, |age| ctx.since(age.min(ctx.now())));
                if let Some(cluster) = leaves {
                    self.state.cluster_stamps.insert(*cluster, ctx.stamp());
                }
                continue;
            }
            self.op(op, &ctx, place);
        }
    }

    /// Executes operations outside of any cluster.
    pub fn outside(&mut self, ops: &[Op], ctx: &Ctx) {
        self.ops(ops, ctx, &mut Place::default());
    }

    fn op(&mut self, op: &Op, ctx: &Ctx, place: &mut Place<'_, 'r>) {
        match op {
            Op::Activate { node, then } => {
                if self.activate(*node, ctx) {
                    self.ops(then, ctx, place);
                }
            }
            Op::Deactivate { node, then } => {
                if self.deactivate(*node) {
                    self.ops(then, ctx, place);
                }
            }
            Op::TakeActivity { node, gains, loses } => {
                let gained = !gains.is_empty() && self.state.take(Flag::Gains(*node));
                let lost = !loses.is_empty() && self.state.take(Flag::Loses(*node));
                if gained {
                    self.ops(gains, ctx, place);
                } else if lost {
                    self.ops(loses, ctx, place);
                }
            }
            Op::HoldActivity(node) => {
                let gains = self.state.take(Flag::Gains(*node)).then_some(());
                self.state.held_activity.entry(*node).and_modify(|held| held.put(gains));
            }
            Op::ClearHeld(node) => {
                self.state.held_activity.entry(*node).and_modify(crate::delay::Delay::clear);
            }
            Op::Pass { port, then } => {
                if self.is_there(*port, place) && self.pass(*port) {
                    self.ops(then, ctx, place);
                }
            }
            Op::PassHeld(port) => {
                let held = self.state.held_activity.get_mut(&port.node).and_then(|held| held.take_at(0));
                if held.is_some() {
                    self.carry(*port);
                }
            }
            Op::Hook { node, active } => {
                if let Some(node) = self.state.nodes.get_mut(node) {
                    node.turned(*active);
                }
            }
            Op::CheckClaims => self.check_claims(),
            Op::ShowStates => self.show_states(),
            Op::Move { node, how } => self.call_machine(*node, |machine| machine.go(*how)),
            Op::TimeStates(node) => self.time_states(*node, ctx),
            Op::LeaveState { node, wait, call } => self.leave_state(*node, *wait, call, ctx),
            Op::Set(flag, value) => self.state.set(*flag, *value),
            Op::ForgetTokens => {
                self.state.flags.retain(|flag| !matches!(flag, Flag::Gains(_) | Flag::Carries(_)));
            }
            Op::ForgetCancelled(node) => drop(self.state.remembered.remove(node)),
            Op::GiveBack { interrupt, node, then } => {
                let remembered = self.state.remembered.get_mut(interrupt);
                if remembered.is_some_and(|nodes| nodes.remove(node)) {
                    self.ops(then, ctx, place);
                }
            }
            Op::Cancel(cancel) => self.cancel(cancel, ctx, place),
            Op::Clear(port) => drop(self.state.tokens.remove(port)),
            Op::Trigger(port) => self.state.trigger(*port),
            Op::Send(port) => self.send(*port, ctx),
            Op::Taking { port, body } => {
                place.taken = self.state.tokens.remove(port);
                self.ops(body, ctx, place);
                place.taken = None;
            }
            Op::Settle(row) => self.state.conditions.settle(&self.code.program.rows, *row),
            Op::Serve { slot, unless_exit } => {
                let exits = *unless_exit && self.state.exit.is_some();
                if self.waits(*slot) && self.state.steps > 0 && !exits {
                    self.step();
                    self.serve(*slot, ctx);
                }
            }
            Op::ServeCircle(slots) => self.serve_circle(slots, ctx),
            Op::Call { slot, taken, call } => {
                if let Some(call) = call {
                    let token = self.slot_token(*slot, *taken, place);
                    self.call_slot(*slot, call, token, ctx);
                }
            }
            Op::SeeSlot { slot, taken } => {
                let node = self.code.program.wiring.slots[*slot].node;
                if let Some(token) = self.slot_token(*slot, *taken, place) {
                    self.state.probes.entry(node).or_default().push(token);
                }
            }
            Op::PutOut { slot, taken, room } => {
                let node = self.code.program.wiring.slots[*slot].node;
                if let Some(token) = self.slot_token(*slot, *taken, place) {
                    self.state.events.entry(node).or_insert(token);
                }
                if let Some(bit) = room {
                    self.state.conditions.set(*bit, false);
                }
            }
            Op::Exit(code) => self.state.exit = Some(*code),
            Op::Reset => {
                let code = self.code;
                self.ops(&code.program.reset, ctx, place);
            }
            Op::Interrupt(slot) => {
                let code = self.code;
                if let Some(ops) = code.program.interrupts.get(slot) {
                    self.ops(ops, ctx, place);
                }
            }
            Op::If { flag, is, then } => {
                if self.state.flags.contains(flag) == *is {
                    self.ops(then, ctx, place);
                }
            }
            Op::StartTimeout(timeout) => self.start_timeout(*timeout, ctx),
            Op::StopTimeout(timeout) => self.state.timeouts[*timeout].stop(),
            Op::Advance(timer) => self.state.timers[*timer].advance(),
            Op::Hear(silences) => {
                for silence in silences {
                    let after = self.silence(*silence);
                    self.state.silences[*silence].start(ctx.now(), after);
                }
            }
            Op::Stamp { .. } => {}
            Op::IfSent { tokens, then } => {
                if tokens.iter().any(|port| self.is_there(*port, place)) {
                    self.ops(then, ctx, place);
                }
            }
            _ => self.in_cluster(op, ctx, place),
        }
    }

    /// Returns `true` if there is a token at a port: of an output in its cluster, else in the state.
    fn is_there(&self, port: PortId, place: &Place<'_, 'r>) -> bool {
        match &place.local {
            Some(local) if self.code.graph().port(port).kind == PortKind::Output => {
                local.read(self.state, port).is_some()
            }
            _ => self.state.tokens.contains_key(&port),
        }
    }

    /// Activates a node. Returns `true` unless it was active.
    fn activate(&mut self, node: NodeId, ctx: &Ctx) -> bool {
        let turned = self.state.flags.insert(Flag::Active(node));
        if turned {
            if self.code.program.lower.is_observed(node) {
                self.observer.activity(self.number(node), true);
            }
            if let Some(timeout) = self.code.program.wiring.timeout(node) {
                self.start_timeout(timeout, ctx);
            }
        }
        turned
    }

    /// Deactivates a node. Returns `true` if it was active.
    fn deactivate(&mut self, node: NodeId) -> bool {
        let turned = self.state.take(Flag::Active(node));
        if turned {
            if self.code.program.lower.is_observed(node) {
                self.observer.activity(self.number(node), false);
            }
            if let Some(timeout) = self.code.program.wiring.timeout(node) {
                self.state.timeouts[timeout].stop();
            }
        }
        turned
    }

    pub fn start_timeout(&mut self, timeout: usize, ctx: &Ctx) {
        let after = self.code.program.wiring.timeouts[timeout].after;
        self.state.timeouts[timeout].start(ctx.now(), after);
    }

    /// Passes activity on with the token at a port. Returns `true` if the activity of its node went along.
    fn pass(&mut self, port: PortId) -> bool {
        let code = self.code;
        let Some(row) = code.program.wiring.port(port) else { return false };
        row.takes_away.iter().for_each(|flag| self.state.set(*flag, true));
        let is_delay = code.graph().nodes[port.node].is_delay();
        let passes = row.passes.is_some() && !is_delay && self.deactivate(port.node);
        if passes {
            self.carry(port);
        }
        passes
    }

    /// Marks the tokens that come from a port as those that carry activity.
    fn carry(&mut self, port: PortId) {
        let along = self.code.program.wiring.port(port).and_then(|row| row.passes.as_deref());
        along.into_iter().flatten().for_each(|flag| self.state.set(*flag, true));
    }

    /// Sends the token at a port, if there is one; on some connections also ⊥.
    fn send(&mut self, port: PortId, ctx: &Ctx) {
        let code = self.code;
        let is_there = self.state.tokens.contains_key(&port);
        let sends = code.program.wiring.port(port).map_or(&[][..], |row| &row.sends);
        for send in sends.iter().filter(|send| send.absent || is_there) {
            self.state.queue.extend(send.queued);
            if let Some(bit) = send.raises {
                self.state.conditions.set(bit, true);
            }
            if let (Some(bit), true) = (send.occupies, send.queued.is_some() || send.raises.is_some()) {
                self.state.conditions.set(bit, false);
            }
            if let Some(stamp) = code.program.lower.stamp(send.connection) {
                self.state.stamps[stamp] = ctx.stamp();
            }
        }
    }

    /// The token of a slot, or the value in place of it.
    fn slot_token(&self, slot: usize, taken: bool, place: &Place<'_, 'r>) -> Option<Value> {
        let connection = self.code.program.wiring.slots[slot].connection;
        let from = self.code.graph().connections[connection].from;
        let token = if taken { place.taken.as_ref() } else { self.state.tokens.get(&from) };
        token.map(|token| self.state.given.get(&connection).unwrap_or(token).clone())
    }

    /// Returns `true` if a token waits for a slot.
    fn waits(&self, slot: usize) -> bool {
        let connection = self.code.program.wiring.slots[slot].connection;
        self.state.tokens.contains_key(&self.code.graph().connections[connection].from)
    }

    /// Takes a step, where they are counted.
    pub fn step(&mut self) {
        if self.code.program.lower.is_endless() {
            self.state.steps -= 1;
        }
    }

    fn serve_circle(&mut self, slots: &[usize], ctx: &Ctx) {
        while slots.iter().any(|slot| self.waits(*slot)) {
            for slot in slots {
                if self.waits(*slot) && self.state.steps > 0 {
                    self.step();
                    self.serve(*slot, ctx);
                }
            }
            if self.state.steps == 0 || self.state.exit.is_some() {
                break;
            }
        }
    }

    /// Serves slots from the queue until none is ready. Returns `true` if there was one.
    pub fn serve_queue(&mut self, ctx: &Ctx) -> bool {
        let code = self.code;
        let slots = &code.program.wiring.slots;
        let mut any = false;
        while self.state.steps > 0 && self.state.exit.is_none() {
            let ready = |slot: &usize| self.state.conditions.all(&slots[*slot].needs);
            let Some(slot) = self.state.queue.iter().position(ready).and_then(|at| self.state.queue.remove(at)) else {
                break;
            };
            self.step();
            self.serve(slot, ctx);
            any = true;
        }
        any
    }

    /// Takes the token that waits for a slot: its connection is free again, activity moves as the token says, and the
    /// slot is called.
    fn serve(&mut self, number: usize, ctx: &Ctx) {
        let code = self.code;
        let slot = &code.program.wiring.slots[number];
        if let Some(connection) = code.numbers.connections[slot.connection] {
            self.observer.handled(connection);
        }
        if let Some(bit) = slot.frees {
            self.state.conditions.set(bit, true);
        }
        let stamp = code.program.lower.stamp(slot.connection).map(|stamp| self.state.stamps[stamp]);
        let ctx = stamp.map_or(*ctx, |stamp| ctx.since(stamp));
        let turned = match slot.carries_to(code.graph()) {
            Carries::Nothing => false,
            Carries::Always => self.activate(slot.node, &ctx),
            Carries::Sometimes => self.state.take(Flag::Carries(number)) && self.activate(slot.node, &ctx),
            Carries::Away => self.deactivate(slot.node),
        };
        let served = &code.program.slots[number];
        self.outside(&served.clear, &ctx);
        if turned {
            self.outside(&served.turned, &ctx);
        }
        self.outside(&served.call, &ctx);
        self.observer.finished(self.number(slot.node));
        self.outside(&served.after, &ctx);
    }

    fn cancel(&mut self, cancel: &Cancel, ctx: &Ctx, place: &mut Place<'_, 'r>) {
        let Cancel { interrupt, remembers, is_reached, takes, cancelled } = cancel;
        let (mut taken, mut remembered) = (false, std::collections::BTreeSet::new());
        for Taken { node, on_the_way, remember, then } in takes {
            let mut found = false;
            on_the_way.iter().for_each(|flag| found |= self.state.take(*flag));
            found |= self.has(self.code.program.lower.spot(*node));
            if found {
                taken = true;
                remembered.extend(remember.iter().copied());
                self.ops(then, ctx, place);
            }
        }
        // Without activity there is nothing to remember instead.
        if *remembers && taken {
            self.state.remembered.insert(*interrupt, remembered);
        }
        taken |= *is_reached && self.state.take(Flag::Active(*interrupt));
        if let (Some((event, carries)), true) = (cancelled, taken) {
            self.state.trigger(*event);
            if *carries {
                self.state.set(Flag::Active(*interrupt), true);
            }
        }
    }
}
