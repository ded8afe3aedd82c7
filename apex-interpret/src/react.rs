//! Reactions: which cluster fires and which slot is served, and when.

use crate::{Interpreter, Value, run::Run};
use apex_dsl::{
    analyse::Guard,
    graph::{NodeId, NodeKind, PortId},
    program::{After, Entering, Entry, Firing, Flag, Poll},
    syntax::tree::PortKind,
};
use apex_rt::{Ctx, Next, Observer, Time};
use std::ops::ControlFlow;

/// Steps of a reaction; with more it is taken for an endless loop.
const BUDGET: u32 = 1_000_000;

impl Interpreter<'_> {
    /// Reacts at `now`: runs until nothing is ready, and says when it wants to be called next.
    pub fn react<O: Observer>(&mut self, now: Time, observer: &mut O) -> Next {
        let Self { parts, cells, library } = self;
        let mut next = vec![Next::Input; parts.len()];
        cells.wake_all();
        for round in 0..apex_rt::threads::MAX_ROUNDS {
            for (group, (code, state)) in parts.iter_mut().enumerate() {
                if !cells.take_woken(group) {
                    continue;
                }
                let mut run = Run { code, state, cells, library: *library, observer };
                next[group] = run.react(now, round == 0);
                if let Next::Exit(code) = next[group] {
                    return Next::Exit(code);
                }
            }
            if !cells.any_woken() {
                return next.into_iter().fold(Next::Input, Next::or);
            }
        }
        observer.endless(&[], &[]);
        Next::Now
    }

    /// Puts a token into an input or slot of the program, by the name of the port, unless one waits there. Returns
    /// `false` if there is no such port.
    pub fn put(&mut self, port: &str, token: Value) -> bool {
        let Some(node) = self.port(port, |kind| matches!(kind, PortKind::Input | PortKind::Slot)) else { return false };
        self.parts[0].1.put(node, token);
        true
    }

    /// The token that came out last at an output of the program.
    pub fn output(&self, port: &str) -> Option<Value> {
        let node = self.port(port, |kind| kind == PortKind::Output)?;
        self.parts[0].1.outputs.get(&node).cloned()
    }

    /// Takes the token of an event of the program.
    pub fn take(&mut self, event: &str) -> Option<Value> {
        let node = self.port(event, |kind| kind == PortKind::Event)?;
        self.parts[0].1.events.remove(&node)
    }

    /// The node of a port of the program. They belong to the main group.
    fn port(&self, name: &str, is_meant: impl Fn(PortKind) -> bool) -> Option<NodeId> {
        let graph = self.parts[0].0.graph();
        graph
            .nodes
            .position(|node| node.name == name && matches!(node.kind, NodeKind::Boundary(kind) if is_meant(kind)))
    }
}

impl<O: Observer> Run<'_, '_, O> {
    /// A reaction of a part. It `begins` one, or goes on with it because other parts did something meanwhile.
    fn react(&mut self, now: Time, begins: bool) -> Next {
        let program = &self.code.program;
        if !program.has_time() {
            return match self.state.exit {
                Some(code) => Next::Exit(code),
                None => match self.instant(now, now, begins) {
                    ControlFlow::Break(next) => next,
                    ControlFlow::Continue(next) => next.or(self.sources()),
                },
            };
        }
        let now = self.state.time.of(now, self.observer);
        if let Some(code) = self.state.exit {
            return Next::Exit(code);
        }
        if !program.has_instants() {
            self.state.time.begin(now);
            return match self.instant(now, now, begins) {
                ControlFlow::Break(next) => next,
                ControlFlow::Continue(next) => self.state.time.outside(next.or(self.sources())),
            };
        }
        self.skip(now);
        loop {
            let at = self.next_instant(now);
            self.state.time.begin(at);
            let completes = at >= now || self.observer.ends_early();
            match self.instant(at, now, begins && completes) {
                ControlFlow::Break(next) => return next,
                ControlFlow::Continue(next) if completes => {
                    // Instants that are left come before anything else.
                    let next = if next.is_at_most(now) { next } else { next.or(self.sources()) };
                    return self.state.time.outside(next);
                }
                ControlFlow::Continue(_) => {}
            }
        }
    }

    /// The earliest time after the last instant at which something is due, else `now`.
    fn next_instant(&self, now: Time) -> Time {
        let (state, last) = (&*self.state, self.state.time.last());
        let at = state.timers.iter().fold(now, |at, timer| timer.instant(last, at));
        state.timeouts.iter().chain(&state.silences).fold(at, |at, timeout| timeout.instant(last, at))
    }

    /// Sources with `skip` leave out the firings that they have missed.
    fn skip(&mut self, now: Time) {
        for (timer, (node, _)) in self.state.timers.iter_mut().zip(&self.code.program.wiring.timers) {
            if self.code.program.lower.graph.nodes[*node].modifiers.skip {
                timer.skip(now);
            }
        }
    }

    /// Next call that sources without a pace need. If a part waits for others, they wake it.
    fn sources(&self) -> Next {
        let (analysis, bits) = (self.code.program.lower.analysis, &self.code.program.wiring.bits);
        let mut guards = analysis.clusters.iter().flat_map(|c| &c.own_guards);
        let has_fired = |guard: usize| bits.guard(guard).is_none_or(|bit| !self.state.conditions.has(bit));
        let wants =
            |guard: &usize| analysis.guards[*guard] == Guard::React && (!self.code.is_part || has_fired(*guard));
        if guards.any(wants) { Next::Now } else { Next::Input }
    }

    /// One instant of a reaction. Breaks if the reaction is over because of an exit or of too many steps; else goes on
    /// with the next time at which something is due. Sources without a period fire if it `begins` a reaction.
    fn instant(&mut self, at: Time, now: Time, begins: bool) -> ControlFlow<Next, Next> {
        let code = self.code;
        let reaction = &code.program.reaction;
        let ctx = &Ctx::at(at, now);
        self.state.steps = BUDGET;
        self.outside(&reaction.left, ctx);
        if let Some(served) = &reaction.start
            && !std::mem::replace(&mut self.state.started, true)
        {
            self.outside(&code.program.first, ctx);
            self.after(served, ctx);
        }
        if let Some(code) = self.state.exit {
            return ControlFlow::Break(Next::Exit(code));
        }
        if begins {
            reaction.once.iter().for_each(|bit| self.state.conditions.set(*bit, true));
            for firing in &reaction.before {
                self.fires(firing, true, ctx);
            }
        }
        if reaction.has_rounds {
            self.rounds(at, begins, ctx);
        }
        if let Some(code) = self.state.exit {
            return ControlFlow::Break(Next::Exit(code));
        }
        if self.state.steps == 0 {
            self.observer.endless(&[], &[]);
            return ControlFlow::Break(Next::Now);
        }
        let timers = self.state.timers.iter().map(|timer| timer.wish(at));
        let timeouts = self.state.timeouts.iter().chain(&self.state.silences).map(|timeout| timeout.wish(at));
        ControlFlow::Continue(timers.chain(timeouts).fold(Next::Input, Next::or))
    }

    /// Rounds of an instant, until nothing is left to do. Sources without a period fire in the first one if a reaction
    /// `begins`.
    fn rounds(&mut self, at: Time, begins: bool, ctx: &Ctx) {
        let code = self.code;
        let mut first = begins;
        loop {
            let mut quiet = !self.poll(at, ctx);
            quiet &= !(code.program.lower.has_queue() && self.serve_queue(ctx));
            for firing in &code.program.reaction.firings {
                quiet &= !self.fires(firing, first, ctx);
            }
            first = false;
            if self.state.steps == 0 || self.state.exit.is_some() {
                return;
            }
            if quiet && !self.silence_ends(at) && !self.expire(at, ctx) {
                return;
            }
        }
    }

    /// Serves what follows from tokens that were sent.
    fn after(&mut self, after: &After, ctx: &Ctx) {
        match after {
            After::Queue => drop(self.serve_queue(ctx)),
            After::Slots(ops) => self.outside(ops, ctx),
        }
    }

    /// Fires a cluster if it is ready. One without a row fires once, in the `first` round. Returns `true` if it is a
    /// reason for another round.
    fn fires(&mut self, firing: &Firing, first: bool, ctx: &Ctx) -> bool {
        let code = self.code;
        if self.state.steps == 0 || self.state.exit.is_some() {
            return false;
        }
        let Some(row) = firing.row else {
            if first {
                self.fire_cluster(firing.cluster, ctx);
                self.after(&firing.served, ctx);
            }
            return false;
        };
        if !self.state.conditions.start(&code.program.rows[row]) {
            return false;
        }
        self.step();
        self.fire_cluster(firing.cluster, ctx);
        self.state.conditions.finish(&code.program.rows, row);
        self.after(&firing.served, ctx);
        true
    }

    /// Polls what may have happened. Returns `true` if a token went on.
    fn poll(&mut self, at: Time, ctx: &Ctx) -> bool {
        let code = self.code;
        let mut any = false;
        for poll in &code.program.reaction.polls {
            match poll {
                Poll::Room { event, bit } => {
                    if !self.state.events.contains_key(event) {
                        self.state.conditions.set(*bit, true);
                    }
                }
                Poll::Input { input, bit } => {
                    if self.state.inputs.contains_key(input) {
                        self.state.conditions.set(*bit, true);
                    }
                }
                Poll::Timers => {
                    for (timer, (_, bit)) in self.state.timers.iter().zip(&code.program.wiring.timers) {
                        if timer.is_due(at) {
                            self.state.conditions.set(*bit, true);
                        }
                    }
                }
                Poll::Slots(slots) => {
                    while let Some(slot) = self.first_arrival(slots) {
                        self.enter(slot, ctx);
                        any = true;
                        if slots.len() == 1 {
                            break;
                        }
                    }
                }
                Poll::SetBack(entering) => {
                    let (ahead, node) = (self.state.time.ahead(), entering.node);
                    let told = self.state.told_ahead.get(&node).copied().unwrap_or(0);
                    if told != ahead && self.may_enter(entering) {
                        self.state.told_ahead.insert(node, ahead);
                        self.outside(&entering.then, ctx);
                        any = true;
                    }
                }
                Poll::Sender(sender) => any |= self.send_far(sender),
                Poll::Receiver(receiver) => any |= self.receive_far(receiver, ctx),
            }
        }
        any
    }

    /// The slot of the program whose token came first, of those whose tokens can go on.
    fn first_arrival<'s>(&self, slots: &'s [Entering]) -> Option<&'s Entering> {
        let arrival = |slot: &&Entering| self.state.inputs.get(&slot.node).map(|(arrival, _)| *arrival);
        let waiting = slots.iter().filter(|slot| arrival(slot).is_some() && self.may_enter(slot));
        waiting.min_by_key(arrival)
    }

    fn may_enter(&self, entering: &Entering) -> bool {
        self.state.conditions.all(&entering.free) && self.state.steps > 0
    }

    /// Takes the token of a slot of the program.
    fn enter(&mut self, slot: &Entering, ctx: &Ctx) {
        let port = PortId { node: slot.node, port: 0 };
        if let Some((_, token)) = self.state.inputs.remove(&slot.node) {
            self.state.tokens.insert(port, token);
        }
        self.outside(&slot.then, ctx);
    }

    /// ⊥ takes the place of a token that did not come for too long. Returns `true` if one did not.
    fn silence_ends(&mut self, at: Time) -> bool {
        let code = self.code;
        for (timeout, silence) in code.program.wiring.silences.iter().enumerate() {
            if !self.state.silences[timeout].is_due(at) {
                continue;
            }
            match &silence.entry {
                Entry::Input { raises } if !self.state.conditions.has(*raises) => {
                    self.state.conditions.set(*raises, true);
                    return true;
                }
                Entry::Connection { connection, raises, occupies, free } if self.state.conditions.all(free) => {
                    self.state.tokens.remove(&code.graph().connections[*connection].from);
                    if let Some(stamp) = code.program.lower.stamp(*connection) {
                        self.state.stamps[stamp] = at;
                    }
                    self.state.conditions.set(*occupies, false);
                    self.state.conditions.set(*raises, true);
                    return true;
                }
                Entry::Input { .. } | Entry::Connection { .. } => {}
            }
        }
        false
    }

    /// The first timeout expires that is due and can. Returns `true` if there is one.
    fn expire(&mut self, at: Time, ctx: &Ctx) -> bool {
        let code = self.code;
        let timeouts = code.program.wiring.timeouts.iter().enumerate();
        let due = timeouts.filter(|(number, timeout)| {
            let is_disabled = code.graph().nodes[timeout.node].can_be_disabled()
                && !self.state.flags.contains(&Flag::Enabled(timeout.node));
            self.state.timeouts[*number].is_due(at) && self.state.conditions.all(&timeout.needs) && !is_disabled
        });
        let Some((number, _)) = due.into_iter().next() else { return false };
        if self.state.steps == 0 {
            return false;
        }
        self.outside(&code.program.timeouts[number], ctx);
        true
    }
}
