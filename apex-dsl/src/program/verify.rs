//! Verifier of programs: what must hold in each, whatever its graph. It runs in tests and in debug builds.

use super::{
    After, Arg, Carries, Deadline, Failing, Fire, Flag, Lower, Op, Plan, Poll, Program, Reaction, Send, Storage,
};
use crate::{
    graph::{Flow, NodeId, NodeKind, PortId},
    syntax::tree::PortKind,
};
use std::collections::{BTreeMap, BTreeSet};

impl Program<'_> {
    /// Faults of the program, each a fault of the compiler.
    ///
    /// - In a cluster each token is written before it is read, and each node fires once.
    /// - The token of each slot is served; a slot is queued by its own connection.
    /// - Each condition that a token clears is raised somewhere, and each that it raises is taken.
    /// - Each flag that is set is taken.
    pub fn faults(&self) -> Vec<String> {
        let Self { plans, clusters, .. } = self;
        let mut faults = vec![];
        for (cluster, ops) in clusters.iter_enumerated().filter(|(c, _)| self.lower.analysis.clusters[*c].fires) {
            let (lower, plan) = (self.lower, &plans[cluster]);
            let nodes = &lower.analysis.clusters[cluster].nodes;
            let mut tokens = Tokens { lower, plan, nodes, fired: BTreeSet::new(), faults: vec![] };
            tokens.ops(ops, &mut BTreeSet::new());
            let missing = self.lower.analysis.clusters[cluster].schedule().into_iter();
            let missing = missing
                .filter(|node| !(tokens.fired.contains(node) || plan.is_multirate && self.is_taken_first(*node)));
            let missing: Vec<String> = missing.map(|node| format!("{} does not fire", self.path(node))).collect();
            faults.extend(tokens.faults.into_iter().chain(missing));
        }
        let firing = clusters.iter_enumerated().filter(|(c, _)| self.lower.analysis.clusters[*c].fires);
        let effects = Effects::new(self, firing.map(|(_, ops)| ops));
        faults.extend(self.unserved(&effects));
        faults.extend(self.unsent(&effects));
        faults.extend(self.conditions());
        faults.extend(self.flags(&effects));
        faults
    }

    /// The port from which the token of a slot comes.
    fn source_of(&self, slot: usize) -> PortId {
        self.lower.graph.connections[self.wiring.slots[slot].connection].from
    }

    /// Returns `true` if a node is in a cluster that can fire.
    fn fires(&self, node: NodeId) -> bool {
        let analysis = self.lower.analysis;
        analysis.clusters.get(analysis.cluster_of[node]).is_some_and(|c| c.fires && c.nodes.contains(&node))
    }

    fn path(&self, node: NodeId) -> String {
        self.lower.graph.path(node)
    }

    /// In regions with several rates, an input of the program and a delay only take tokens.
    fn is_taken_first(&self, node: NodeId) -> bool {
        use NodeKind::{Boundary, Delay};
        matches!(self.lower.graph.nodes[node].kind, Boundary(PortKind::Input) | Delay(_))
    }

    /// Events that every node has are triggered only if they are connected: nothing keeps their tokens otherwise.
    fn unsent(&self, effects: &Effects) -> Vec<String> {
        let is_unsent = |end: &&PortId| {
            self.lower.graph.port(**end).standard.is_some_and(|standard| !standard.kind().is_synchronous())
                && !self.lower.is_sent_event(**end)
        };
        let unsent = effects.written.all.iter().filter(is_unsent);
        unsent.map(|end| format!("{} is triggered, but not connected", self.lower.graph.end_name(*end))).collect()
    }

    fn unserved(&self, effects: &Effects) -> Vec<String> {
        let mut faults = vec![];
        for (number, slot) in self.wiring.slots.iter().enumerate() {
            let text = || self.lower.graph.connection_text(slot.connection);
            if effects.written.all.contains(&self.source_of(number))
                && !self.lower.has_queue()
                && !effects.served.contains(&number)
            {
                faults.push(format!("slot {number} of `{}` is never served", text()));
            }
        }
        for send in self.wiring.ports().flat_map(|port| &port.sends) {
            let queued = send.queued.and_then(|slot| self.wiring.slots.get(slot));
            if send.queued.is_some() && queued.is_none_or(|slot| slot.connection != send.connection) {
                faults.push(format!("a slot of another connection is queued on {}", send.connection.index()));
            }
        }
        faults
    }

    fn conditions(&self) -> Vec<String> {
        let Lower { graph, .. } = self.lower;
        let of_rows = |set: usize| self.rows.iter().flat_map(move |row| row.sets[set].iter().copied());
        let polls = &self.reaction.polls;
        let senders =
            || polls.iter().filter_map(|poll| if let Poll::Sender(sender) = poll { Some(sender) } else { None });
        let raised: BTreeSet<usize> = of_rows(5)
            .chain(self.wiring.slots.iter().filter_map(|slot| slot.frees))
            .chain(senders().map(|sender| sender.free))
            .collect();
        let taken: BTreeSet<usize> = of_rows(1).chain(senders().map(|sender| sender.token)).collect();
        // A token that leads to a cluster that never fires waits forever.
        let fires = |send: &&Send| {
            let c = &graph.connections[send.connection];
            let is_sender = matches!(graph.nodes[c.to.node].kind, NodeKind::Sender(_));
            graph.flow(c) == Flow::ToSlot || is_sender || self.fires(c.to.node)
        };
        let sends = self.wiring.ports().flat_map(|port| &port.sends).filter(fires);
        let faults = sends.flat_map(|send| {
            let stays = send.occupies.filter(|bit| !raised.contains(bit));
            let unused = send.raises.filter(|bit| !taken.contains(bit));
            let text = graph.connection_text(send.connection);
            let stays = stays.map(|bit| format!("`{text}` stays occupied: nothing raises condition {bit}"));
            let unused = unused.map(|bit| format!("the token of `{text}` stays: nothing takes condition {bit}"));
            stays.into_iter().chain(unused)
        });
        faults.collect()
    }

    fn flags(&self, effects: &Effects) -> Vec<String> {
        let passed = self.wiring.ports().flat_map(|port| port.takes_away.iter().chain(port.passes.iter().flatten()));
        let set = passed.chain(&effects.set);
        let polls = &self.reaction.polls;
        let far = polls.iter().filter_map(|poll| match poll {
            Poll::Sender(sender) => Some(sender.node),
            _ => None,
        });
        let far: BTreeSet<NodeId> = far.collect();
        let is_taken = |flag: &Flag| match *flag {
            Flag::Carries(slot) => self.wiring.slots.get(slot).is_some_and(|slot| slot.carries == Carries::Sometimes),
            // What takes activity away goes to the other group with the token.
            Flag::Gains(node) | Flag::Loses(node) => {
                effects.taken.contains(flag) || far.contains(&node) || !self.fires(node)
            }
            Flag::Active(_) | Flag::Enabled(_) => true,
        };
        let left: BTreeSet<&Flag> = set.filter(|flag| !is_taken(flag)).collect();
        left.into_iter().map(|flag| format!("nothing takes the flag {flag:?}")).collect()
    }
}

/// Reachable effects of a program: ports at which there may be tokens, slots that are served, and flags that are set
/// and taken.
#[derive(Default)]
struct Effects {
    written: Reached,
    served: BTreeSet<usize>,
    set: BTreeSet<Flag>,
    taken: BTreeSet<Flag>,
    /// `cancel`s and `resume`s that are called.
    interrupts: Reached,
}

/// Ports that were reached, and those of them that were not looked at yet.
#[derive(Default)]
struct Reached {
    all: BTreeSet<PortId>,
    new: Vec<PortId>,
}

impl Reached {
    fn insert(&mut self, port: PortId) {
        if self.all.insert(port) {
            self.new.push(port);
        }
    }

    fn extend(&mut self, ports: impl IntoIterator<Item = PortId>) {
        ports.into_iter().for_each(|port| self.insert(port));
    }
}

impl Effects {
    /// Effects if these clusters fire.
    fn new<'o>(program: &Program<'_>, clusters: impl Iterator<Item = &'o Vec<Op>>) -> Self {
        let mut effects = Self::default();
        clusters.for_each(|ops| effects.ops(program, ops));
        let Reaction { start, before, polls, firings, left, .. } = &program.reaction;
        effects.ops(program, left);
        let served = before.iter().chain(firings).map(|firing| &firing.served);
        for after in served.chain(start) {
            if let After::Slots(ops) = after {
                effects.ops(program, ops);
            }
        }
        polls.iter().for_each(|poll| effects.poll(program, poll));
        program.timeouts.iter().for_each(|ops| effects.ops(program, ops));
        effects.ops(program, &program.first);
        effects.ops(program, &program.reset);
        // A slot is called only if there may be a token for it, and may then cause others.
        let mut slots: BTreeMap<PortId, Vec<usize>> = BTreeMap::new();
        (0..program.wiring.slots.len()).for_each(|slot| slots.entry(program.source_of(slot)).or_default().push(slot));
        loop {
            if let Some(port) = effects.written.new.pop() {
                for slot in slots.get(&port).into_iter().flatten() {
                    let served = &program.slots[*slot];
                    let all = [&served.clear, &served.turned, &served.call, &served.after];
                    all.into_iter().for_each(|ops| effects.ops(program, ops));
                }
            } else if let Some(slot) = effects.interrupts.new.pop() {
                effects.ops(program, program.interrupts.get(&slot).map_or(&[], Vec::as_slice));
            } else {
                return effects;
            }
        }
    }

    fn poll(&mut self, program: &Program<'_>, poll: &Poll) {
        let first = |node: NodeId| PortId { node, port: 0 };
        match poll {
            Poll::Slots(slots) => {
                self.written.extend(slots.iter().map(|slot| first(slot.node)));
                slots.iter().for_each(|slot| self.ops(program, &slot.then));
            }
            Poll::SetBack(slot) => self.ops(program, &slot.then),
            Poll::Receiver(receiver) => {
                self.written.insert(first(receiver.node));
                receiver.then.iter().for_each(|ops| self.ops(program, ops));
            }
            Poll::Room { .. } | Poll::Input { .. } | Poll::Timers | Poll::Sender(_) => {}
        }
    }

    fn ops(&mut self, program: &Program<'_>, ops: &[Op]) {
        for op in ops {
            match op {
                Op::Trigger(port) => self.written.insert(*port),
                Op::Fire { node, fire } => self.fire(program, *node, fire),
                Op::Call { slot, call: Some(call), .. } => {
                    let node = program.wiring.slots[*slot].node;
                    self.called(&call.args, call.failing, call.deadline);
                    self.written.extend(program.lower.moved(node));
                }
                Op::LeaveState { call, .. } => self.called(&call.args, call.failing, call.deadline),
                Op::Move { node, .. } => self.written.extend(program.lower.moved(*node)),
                Op::Cancel(cancel) => self.written.extend(cancel.cancelled.map(|(event, _)| event)),
                Op::Interrupt(slot) => self.interrupts.insert(*slot),
                Op::Serve { slot, .. } => drop(self.served.insert(*slot)),
                Op::ServeCircle(slots) => self.served.extend(slots),
                Op::Set(flag, true) => drop(self.set.insert(*flag)),
                Op::HoldActivity(node) => drop(self.taken.insert(Flag::Gains(*node))),
                Op::TakeActivity { node, gains, loses } => {
                    if !gains.is_empty() {
                        self.taken.insert(Flag::Gains(*node));
                    }
                    if !loses.is_empty() {
                        self.taken.insert(Flag::Loses(*node));
                    }
                }
                _ => {}
            }
            op.inner().into_iter().for_each(|ops| self.ops(program, ops));
        }
    }

    fn fire(&mut self, program: &Program<'_>, node: NodeId, fire: &Fire) {
        let Fire::Call(call) = fire else {
            let ports = program.lower.graph.nodes[node].ports.iter().enumerate();
            let outputs = ports.filter(|(_, port)| port.kind == PortKind::Output);
            return self.written.extend(outputs.map(|(port, _)| PortId { node, port }));
        };
        self.called(call.args.as_deref().unwrap_or_default(), call.failing, call.deadline);
        self.written.extend(call.results.iter().map(|result| result.output).chain(call.buffers.iter().copied()));
        self.written.extend(call.param_outputs.iter().map(|param| param.output).chain(call.processed));
    }

    /// Events that a call may trigger.
    fn called(&mut self, args: &[Arg], failing: Failing, deadline: Option<Deadline>) {
        let events = args.iter().filter_map(|arg| match arg {
            Arg::Event { event, sent: true } => Some(*event),
            _ => None,
        });
        self.written.extend(events);
        if let Failing::Contained { event, .. } = failing {
            self.written.extend(event);
        }
        self.written.extend(deadline.and_then(|deadline| deadline.event));
    }
}

/// Tokens of a cluster.
struct Tokens<'a> {
    lower: Lower<'a>,
    plan: &'a Plan,
    /// Nodes of the cluster.
    nodes: &'a [NodeId],
    fired: BTreeSet<NodeId>,
    faults: Vec<String>,
}

impl Tokens<'_> {
    /// Operations before which the tokens `known` were written. What a block writes is known outside of it only if it
    /// was declared there.
    fn ops(&mut self, ops: &[Op], known: &mut BTreeSet<PortId>) {
        for op in ops {
            match op {
                Op::Take(port) => drop(known.insert(*port)),
                Op::TakeDelayed(node) => drop(known.insert(PortId { node: *node, port: 1 })),
                Op::Declare(port) => drop(known.insert(*port)),
                Op::Block { tokens, body, .. } => {
                    tokens.iter().for_each(|port| self.read(*port, known));
                    self.ops(body, &mut known.clone());
                }
                Op::Iteration { firings, .. } => firings.values().for_each(|ops| self.ops(ops, known)),
                Op::IfArrived { inputs, body } => {
                    inputs.iter().for_each(|input| self.arrives(*input, known));
                    self.ops(body, known);
                }
                Op::Fire { node, fire } => self.fire(*node, fire, known),
                Op::IfSent { tokens, .. } => {
                    let outputs = tokens.iter().filter(|port| self.is_output(**port));
                    outputs.copied().collect::<Vec<_>>().into_iter().for_each(|port| self.read(port, known));
                }
                Op::Pass { port, .. } if self.is_output(*port) => self.read(*port, known),
                Op::Observe(port) | Op::Store(port) => self.read(*port, known),
                _ => {}
            }
        }
    }

    fn is_output(&self, port: PortId) -> bool {
        self.lower.graph.port(port).kind == PortKind::Output
    }

    fn fire(&mut self, node: NodeId, fire: &Fire, known: &mut BTreeSet<PortId>) {
        if !self.fired.insert(node) {
            self.faults.push(format!("{} fires twice", self.lower.graph.path(node)));
        }
        let input = PortId { node, port: 0 };
        match fire {
            Fire::Call(call) => {
                let tokens = call.args.iter().flatten().flat_map(|arg| match arg {
                    Arg::Token { input, .. } | Arg::Arrived { input, .. } => vec![*input],
                    Arg::Tokens { inputs, .. } => inputs.clone(),
                    _ => vec![],
                });
                let params = call.sets.iter().chain(&call.checks).map(|(_, input)| *input);
                let all: Vec<PortId> = tokens.chain(params).chain(call.mandatory.iter().flatten().copied()).collect();
                all.into_iter().for_each(|input| self.arrives(input, known));
                known.extend(call.results.iter().map(|result| result.output));
                known.extend(call.param_outputs.iter().map(|param| param.output));
                known.extend(&call.buffers);
            }
            Fire::Each(_) => {
                let ports = || self.lower.graph.nodes[node].ports.iter().enumerate();
                let of = |kind: PortKind| {
                    ports().filter(move |(_, p)| p.kind == kind).map(|(port, _)| PortId { node, port })
                };
                let (inputs, outputs): (Vec<PortId>, Vec<PortId>) =
                    (of(PortKind::Input).collect(), of(PortKind::Output).collect());
                inputs.into_iter().for_each(|input| self.arrives(input, known));
                known.extend(outputs);
            }
            Fire::Hold | Fire::Output | Fire::See => self.arrives(input, known),
            Fire::Relay => {
                self.arrives(input, known);
                known.insert(PortId { node, port: 1 });
            }
            Fire::Nothing => {}
        }
    }

    fn arrives(&mut self, input: PortId, known: &BTreeSet<PortId>) {
        if let Some(from) = self.lower.incoming(input) {
            self.read(from, known);
        }
    }

    fn read(&mut self, port: PortId, known: &BTreeSet<PortId>) {
        let is_outside =
            matches!(self.plan.storage(port), Storage::Outside | Storage::Argument | Storage::MaybeArgument);
        if self.nodes.contains(&port.node) && !is_outside && !known.contains(&port) {
            self.faults.push(format!("{} is read before it is written", self.lower.graph.end_name(port)));
        }
    }
}
