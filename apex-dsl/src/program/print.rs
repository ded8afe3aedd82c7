//! Operations as text: a line each.

use super::{
    After, Arg, Call, Cancel, Deadline, Entering, Failing, Fire, Flag, Op, Poll, Program, Reaction, SlotCall, Taken,
};
use crate::graph::PortId;

/// Lines with their indentation.
pub struct Lines<'p> {
    program: &'p Program<'p>,
    text: String,
    depth: usize,
}

impl<'p> Lines<'p> {
    /// No lines yet.
    pub const fn new(program: &'p Program<'p>) -> Self {
        Self { program, text: String::new(), depth: 0 }
    }

    /// The lines.
    pub fn finish(self) -> String {
        self.text
    }

    /// Adds a line.
    pub fn add(&mut self, line: &str) {
        self.text.extend(std::iter::repeat_n(' ', 2 * self.depth));
        self.text.push_str(line);
        self.text.push('\n');
    }

    /// Adds what stands deeper.
    pub fn inside(&mut self, add: impl FnOnce(&mut Self)) {
        self.depth += 1;
        add(self);
        self.depth -= 1;
    }

    /// Adds operations.
    pub fn ops(&mut self, ops: &[Op]) {
        ops.iter().for_each(|op| self.op(op));
    }

    fn with(&mut self, line: &str, ops: &[Op]) {
        self.add(line);
        self.inside(|lines| lines.ops(ops));
    }

    fn end(&self, port: PortId) -> String {
        self.program.lower.graph.end_name(port)
    }

    fn ends(&self, ports: &[PortId]) -> String {
        ports.iter().map(|port| self.end(*port)).collect::<Vec<_>>().join(", ")
    }

    fn flag(&self, flag: Flag) -> String {
        let path = |node| self.program.lower.graph.path(node);
        match flag {
            Flag::Active(node) => format!("active {}", path(node)),
            Flag::Gains(node) => format!("gains {}", path(node)),
            Flag::Loses(node) => format!("loses {}", path(node)),
            Flag::Enabled(node) => format!("enabled {}", path(node)),
            Flag::Carries(slot) => format!("carries {slot}"),
        }
    }

    fn op(&mut self, op: &Op) {
        let path = |node| self.program.lower.graph.path(node);
        match op {
            Op::Activate { node, then } => self.with(&format!("activate {}", path(*node)), then),
            Op::Deactivate { node, then } => self.with(&format!("deactivate {}", path(*node)), then),
            Op::TakeActivity { node, gains, loses } => {
                for (flag, ops) in [(Flag::Gains(*node), gains), (Flag::Loses(*node), loses)] {
                    if !ops.is_empty() {
                        let line = format!("take {}", self.flag(flag));
                        self.with(&line, ops);
                    }
                }
            }
            Op::HoldActivity(node) => self.add(&format!("hold activity in {}", path(*node))),
            Op::ClearHeld(node) => self.add(&format!("clear activity in {}", path(*node))),
            Op::Pass { port, then } => {
                let line = format!("pass with {}: {}", self.end(*port), self.passed(*port));
                self.with(&line, then);
            }
            Op::PassHeld(port) => self.add(&format!("pass held with {}: {}", self.end(*port), self.passed(*port))),
            Op::Hook { node, active: true } => self.add(&format!("on_activate {}", path(*node))),
            Op::Hook { node, active: false } => self.add(&format!("on_deactivate {}", path(*node))),
            Op::CheckClaims => self.add("check claims"),
            Op::Set(flag, value) => {
                let line = format!("{} {}", if *value { "set" } else { "clear" }, self.flag(*flag));
                self.add(&line);
            }
            Op::ForgetTokens => self.add("clear gains, carries"),
            Op::ForgetCancelled(node) => self.add(&format!("forget {}", path(*node))),
            Op::GiveBack { interrupt, node, then } => {
                self.with(&format!("if {} remembers {}", path(*interrupt), path(*node)), then);
            }
            Op::Cancel(cancel) => self.cancel(cancel),
            Op::Clear(port) => self.add(&format!("clear {}", self.end(*port))),
            Op::Trigger(port) => self.add(&format!("trigger {}", self.end(*port))),
            Op::Send(port) => self.add(&format!("send {}: {}", self.end(*port), self.sent(*port))),
            Op::Taking { port, body } => self.with(&format!("take {}", self.end(*port)), body),
            Op::Settle(row) => self.add(&format!("settle row {row}")),
            Op::Serve { slot, unless_exit } => {
                let unless = if *unless_exit { " unless the program ends" } else { "" };
                self.add(&format!("serve slot {slot}{unless}"));
            }
            Op::ServeCircle(slots) => self.add(&format!("serve slots {} again and again", numbers(slots))),
            Op::Call { slot, call, .. } => self.slot_call(*slot, call.as_ref()),
            Op::SeeSlot { slot, .. } => self.add(&format!("show the token of slot {slot} to a test")),
            Op::PutOut { slot, room, .. } => {
                let room = room.map(|bit| format!(", clear {bit}")).unwrap_or_default();
                self.add(&format!("put the token of slot {slot} out{room}"));
            }
            Op::Exit(code) => self.add(&format!("exit {code}")),
            Op::Reset => self.add("reset"),
            Op::Interrupt(slot) => self.add(&self.end(*slot)),
            Op::If { flag, is, then } => {
                let line = format!("if {}{}", if *is { "" } else { "not " }, self.flag(*flag));
                self.with(&line, then);
            }
            Op::Move { node, how } => self.add(&format!("{} {}", how.method(), path(*node))),
            Op::ShowStates => {}
            Op::TimeStates(node) => self.add(&format!("time the states of {}", path(*node))),
            Op::LeaveState { node, wait, call } => {
                let args: Vec<String> = call.args.iter().map(|arg| self.arg(arg)).collect();
                let method = &self.program.lower.waits(*node)[*wait].method;
                let after = after_call(call.failing, call.deadline);
                self.add(&format!("call {}.{method}({}){after}", path(*node), args.join(", ")));
            }
            Op::StartTimeout(timeout) => self.add(&format!("start timeout {timeout}")),
            Op::StopTimeout(timeout) => self.add(&format!("stop timeout {timeout}")),
            Op::Advance(timer) => self.add(&format!("advance timer {timer}")),
            Op::Hear(silences) => self.add(&format!("start silence {}", numbers(silences))),
            Op::Stamp { upstream, stamps, leaves } => {
                let clusters = upstream.iter().map(|cluster| format!("cluster {}", cluster.index()));
                let stamps = stamps.iter().map(|stamp| format!("stamp {stamp}"));
                let ages: Vec<String> = clusters.chain(stamps).collect();
                let left = leaves.map(|cluster| format!(", left in cluster {}", cluster.index())).unwrap_or_default();
                self.add(&format!(
                    "as old as {}{left}",
                    if ages.is_empty() { "now".to_owned() } else { ages.join(", ") }
                ));
            }
            Op::Take(port) => self.add(&format!("take {}", path(port.node))),
            Op::Declare(port) => self.add(&format!("declare {}", self.end(*port))),
            Op::Block { tokens, body, .. } => self.with(&format!("if {}", self.ends(tokens)), body),
            Op::Iteration { runs, firings } => {
                for run in runs {
                    self.with(
                        &format!("firings {} to {} of {}", run.from, run.to - 1, path(run.node)),
                        &firings[&run.node],
                    );
                }
            }
            Op::TakeDelayed(node) => self.add(&format!("take {}", path(*node))),
            Op::IfArrived { inputs, body } => self.with(&format!("if {}", self.ends(inputs)), body),
            Op::Fire { node, fire } => {
                let line = format!("fire {}{}", path(*node), self.fired(fire));
                self.add(&line);
            }
            Op::IfSent { tokens, then } => self.with(&format!("if any of {}", self.ends(tokens)), then),
            // Only recorders look at it.
            Op::Observe(_) => {}
            Op::Store(port) => self.add(&format!("store {}", self.end(*port))),
            Op::HoldIteration(node) => self.add(&format!("hold the tokens of the iteration in {}", path(*node))),
        }
    }

    /// Effects of the activity that goes with a token.
    fn passed(&self, port: PortId) -> String {
        let Some(row) = self.program.wiring.port(port) else { return String::new() };
        let away = row.takes_away.iter().map(|flag| format!("set {}", self.flag(*flag)));
        let leaves = row.passes.iter().map(|_| format!("deactivate {}", self.program.lower.graph.path(port.node)));
        let along = row.passes.iter().flatten().map(|flag| format!("set {} if it was active", self.flag(*flag)));
        away.chain(leaves).chain(along).collect::<Vec<_>>().join(", ")
    }

    /// Effects of a token that is sent.
    fn sent(&self, port: PortId) -> String {
        let sends = self.program.wiring.port(port).map_or(&[][..], |row| &row.sends);
        let effects = sends.iter().flat_map(|send| {
            let absent = if send.absent { ", also ⊥" } else { "" };
            let stamp = self.program.lower.stamp(send.connection);
            [
                send.queued.map(|slot| format!("queue slot {slot}")),
                send.raises.map(|bit| format!("raise {bit}{absent}")),
                send.occupies.map(|bit| format!("clear {bit}")),
                stamp.map(|stamp| format!("set stamp {stamp}")),
            ]
        });
        let effects: Vec<String> = effects.flatten().collect();
        if effects.is_empty() { "serve".to_owned() } else { effects.join(", ") }
    }

    fn cancel(&mut self, cancel: &Cancel) {
        let path = |node| self.program.lower.graph.path(node);
        for Taken { node, on_the_way, remember, then } in &cancel.takes {
            let flags: Vec<String> = on_the_way.iter().map(|flag| self.flag(*flag)).collect();
            let flags = if flags.is_empty() { String::new() } else { format!(" or {}", flags.join(" or ")) };
            self.add(&format!("if active {}{flags}", path(*node)));
            self.inside(|lines| {
                remember.iter().for_each(|node| lines.add(&format!("remember {}", path(*node))));
                lines.ops(then);
            });
        }
        if let Some((event, carries)) = cancel.cancelled {
            let along = if carries { " with activity" } else { "" };
            self.add(&format!("trigger {}{along} if there was activity", self.end(event)));
        }
    }

    fn fired(&self, fire: &Fire) -> String {
        match fire {
            Fire::Call(call) => self.called(call),
            Fire::Each(deadline) => format!(" for each element{}", late(*deadline)),
            Fire::Hold => ": hold".to_owned(),
            Fire::Output => ": put out".to_owned(),
            Fire::Relay => ": pass on".to_owned(),
            Fire::See => ": show to a test".to_owned(),
            Fire::Nothing => String::new(),
        }
    }

    fn called(&self, call: &Call) -> String {
        let sets = call.sets.iter().map(|(param, input)| format!("parameter {param} = {}", self.end(*input)));
        let sets: String = sets.map(|set| format!(", {set}")).collect();
        let args = call.args.iter().flatten();
        let args: Vec<String> = args.map(|arg| self.arg(arg)).collect();
        let results: Vec<PortId> = call.results.iter().map(|result| result.output).collect();
        let params = call.param_outputs.iter().map(|param| param.output);
        let results: Vec<PortId> = results.into_iter().chain(call.buffers.iter().copied()).chain(params).collect();
        let sends = if results.is_empty() { String::new() } else { format!(" -> {}", self.ends(&results)) };
        let gate = if call.is_gated { " if enabled" } else { "" };
        let absent = call.mandatory.as_ref().map(|inputs| format!(", or ⊥ without {}", self.ends(inputs)));
        let (absent, after) = (absent.unwrap_or_default(), after_call(call.failing, call.deadline));
        format!("({}){sends}{gate}{sets}{absent}{after}", args.join(", "))
    }

    fn arg(&self, arg: &Arg) -> String {
        let maybe = |optional: bool| if optional { "?" } else { "" };
        match arg {
            Arg::Context => "context".to_owned(),
            Arg::Token { input, optional } => format!("{}{}", self.end(*input), maybe(*optional)),
            Arg::Tokens { inputs, optional } => format!("[{}]{}", self.ends(inputs), maybe(*optional)),
            Arg::OfSlot => "token".to_owned(),
            Arg::Buffer(output) => format!("place of {}", self.end(*output)),
            Arg::Event { event, sent: true } => format!("event {}", self.end(*event)),
            Arg::Event { sent: false, .. } => "event of nothing".to_owned(),
            Arg::Param(param) => format!("parameter {param}"),
            Arg::Arrived { input, .. } => self.end(*input),
            Arg::Checked(param) => format!("parameter {param} in range"),
        }
    }

    fn slot_call(&mut self, slot: usize, call: Option<&SlotCall>) {
        let to = self.program.lower.graph.connections[self.program.wiring.slots[slot].connection].to;
        let args = call.map_or(&[][..], |call| &call.args);
        let args: Vec<String> = args.iter().map(|arg| self.arg(arg)).collect();
        let after = call.map(|call| after_call(call.failing, call.deadline)).unwrap_or_default();
        let line = format!("call {}({}){after}", self.end(to), args.join(", "));
        self.add(&line);
    }

    /// Adds a reaction; `cluster` returns the name of a cluster.
    pub fn reaction(&mut self, reaction: &Reaction, cluster: &dyn Fn(crate::analyse::ClusterId) -> String) {
        let Reaction { start, once, before, polls, firings, has_rounds, left } = reaction;
        self.add("reaction");
        self.depth += 1;
        self.ops(left);
        if let Some(served) = start {
            self.add("start, once");
            self.inside(|lines| lines.served(served));
        }
        if !once.is_empty() {
            self.add(&format!("raise {}", numbers(once)));
        }
        for firing in before {
            self.add(&format!("fire {}", cluster(firing.cluster)));
            self.inside(|lines| lines.served(&firing.served));
        }
        if *has_rounds {
            self.add("until nothing happens");
            self.depth += 1;
            polls.iter().for_each(|poll| self.poll(poll));
            if self.program.lower.has_queue() {
                self.add("serve the queue");
            }
            for firing in firings {
                let when = firing.row.map_or("once".to_owned(), |row| format!("if row {row} is ready"));
                self.add(&format!("fire {} {when}", cluster(firing.cluster)));
                self.inside(|lines| lines.served(&firing.served));
            }
            self.depth -= 1;
        }
        self.depth -= 1;
    }

    fn served(&mut self, after: &After) {
        match after {
            After::Queue => self.add("serve the queue"),
            After::Slots(ops) => self.ops(ops),
        }
    }

    fn poll(&mut self, poll: &Poll) {
        let path = |node| self.program.lower.graph.path(node);
        match poll {
            Poll::Room { event, bit } => self.add(&format!("raise {bit} if event {} was taken", path(*event))),
            Poll::Input { input, bit } => self.add(&format!("raise {bit} if {} holds a token", path(*input))),
            Poll::Timers => self.add("timers"),
            Poll::Slots(slots) => slots.iter().for_each(|slot| self.entering("enter", slot)),
            Poll::SetBack(slot) => self.entering("if the time went back", slot),
            Poll::Sender(sender) => self.add(&format!("send {} to cell {}", self.end(sender.from), sender.end.cell)),
            Poll::Receiver(receiver) => {
                self.add(&format!("receive {} from cell {}", path(receiver.node), receiver.end.cell));
                self.inside(|lines| receiver.then.iter().for_each(|ops| lines.ops(ops)));
            }
        }
    }

    fn entering(&mut self, word: &str, Entering { node, free, then }: &Entering) {
        let free = if free.is_empty() { String::new() } else { format!(" if {}", numbers(free)) };
        let path = self.program.lower.graph.path(*node);
        self.with(&format!("{word} {path}{free}"), then);
    }
}

/// Consequences of a call.
fn after_call(failing: Failing, deadline: Option<Deadline>) -> String {
    let failing = match failing {
        Failing::Never => "",
        Failing::Reported => ", may fail",
        Failing::Contained { restart: false, .. } => ", contained",
        Failing::Contained { restart: true, .. } => ", contained, restarts",
    };
    format!("{failing}{}", late(deadline))
}

fn late(deadline: Option<Deadline>) -> String {
    deadline.map(|deadline| format!(", deadline {:?}", deadline.time)).unwrap_or_default()
}

/// Numbers in a list: `2, 5`.
pub fn numbers(numbers: &[usize]) -> String {
    numbers.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ")
}
