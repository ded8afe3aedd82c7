//! Nodes whose calls send what a script says, and note what they found.

use crate::oracle::call;
use apex_rt::prelude::*;

/// Two outputs.
#[derive(Outputs)]
pub struct ScriptedPair {
    /// One.
    pub a: Option<i64>,
    /// Another.
    pub b: Option<i64>,
}

/// A source.
#[node]
pub struct ScSource {
    /// Its number.
    #[param]
    id: i64,
    /// Seed, mode and limit.
    #[param]
    script: [i64; 3],
    calls: i64,
}

#[node]
impl ScSource {
    fn process(&mut self) -> Option<i64> {
        let now = call(self.id, self.script, &mut self.calls, &[]);
        now.value("out")
    }
}

/// A source with an event and a slot.
#[node]
pub struct ScSourceE {
    /// Its number.
    #[param]
    id: i64,
    /// Seed, mode and limit.
    #[param]
    script: [i64; 3],
    calls: i64,
}

#[node]
impl ScSourceE {
    fn process(&mut self, e: Event<i64>) -> Option<i64> {
        let now = call(self.id, self.script, &mut self.calls, &[]);
        now.event("e", e);
        now.value("out")
    }
    #[slot]
    fn s(&mut self, token: &i64, e: Event<i64>) {
        let now = call(self.id, self.script, &mut self.calls, &[Some(*token)]);
        now.event("e", e);
    }
}

/// A source of events.
#[node]
pub struct ScTicker {
    /// Its number.
    #[param]
    id: i64,
    /// Seed, mode and limit.
    #[param]
    script: [i64; 3],
    calls: i64,
}

#[node]
impl ScTicker {
    fn process(&mut self, e: Event<i64>) {
        let now = call(self.id, self.script, &mut self.calls, &[]);
        now.event("e", e);
    }
}

/// One input, one output.
#[node]
pub struct ScPass {
    /// Its number.
    #[param]
    id: i64,
    /// Seed, mode and limit.
    #[param]
    script: [i64; 3],
    calls: i64,
}

#[node]
impl ScPass {
    fn process(&mut self, x: &i64) -> Option<i64> {
        let now = call(self.id, self.script, &mut self.calls, &[Some(*x)]);
        now.value("out")
    }
}

/// One input, two outputs.
#[node]
pub struct ScSplit {
    /// Its number.
    #[param]
    id: i64,
    /// Seed, mode and limit.
    #[param]
    script: [i64; 3],
    calls: i64,
}

#[node]
impl ScSplit {
    fn process(&mut self, x: &i64) -> ScriptedPair {
        let now = call(self.id, self.script, &mut self.calls, &[Some(*x)]);
        ScriptedPair { a: now.value("a"), b: now.value("b") }
    }
}

/// Two inputs.
#[node]
pub struct ScJoin {
    /// Its number.
    #[param]
    id: i64,
    /// Seed, mode and limit.
    #[param]
    script: [i64; 3],
    calls: i64,
}

#[node]
impl ScJoin {
    fn process(&mut self, x: &i64, y: &i64) -> Option<i64> {
        let now = call(self.id, self.script, &mut self.calls, &[Some(*x), Some(*y)]);
        now.value("out")
    }
}

/// Two inputs, one of them optional.
#[node]
pub struct ScMaybe {
    /// Its number.
    #[param]
    id: i64,
    /// Seed, mode and limit.
    #[param]
    script: [i64; 3],
    calls: i64,
}

#[node]
impl ScMaybe {
    fn process(&mut self, x: &i64, y: Option<&i64>) -> Option<i64> {
        let now = call(self.id, self.script, &mut self.calls, &[Some(*x), y.copied()]);
        now.value("out")
    }
}

/// An input, an output and an event.
#[node]
pub struct ScEvent {
    /// Its number.
    #[param]
    id: i64,
    /// Seed, mode and limit.
    #[param]
    script: [i64; 3],
    calls: i64,
}

#[node]
impl ScEvent {
    fn process(&mut self, x: &i64, e: Event<i64>) -> Option<i64> {
        let now = call(self.id, self.script, &mut self.calls, &[Some(*x)]);
        now.event("e", e);
        now.value("out")
    }
}

/// All kinds of ports.
#[node]
pub struct ScFull {
    /// Its number.
    #[param]
    id: i64,
    /// Seed, mode and limit.
    #[param]
    script: [i64; 3],
    calls: i64,
}

#[node]
impl ScFull {
    fn process(&mut self, x: &i64, y: &i64, e: Event<i64>, f: Event<i64>) -> Option<i64> {
        let now = call(self.id, self.script, &mut self.calls, &[Some(*x), Some(*y)]);
        now.event("e", e);
        now.event("f", f);
        now.value("out")
    }
    #[slot]
    fn s(&mut self, token: &i64, e: Event<i64>, f: Event<i64>) {
        let now = call(self.id, self.script, &mut self.calls, &[Some(*token)]);
        now.event("e", e);
        now.event("f", f);
    }
    #[slot]
    fn t(&mut self, token: &i64, e: Event<i64>, f: Event<i64>) {
        let now = call(self.id, self.script, &mut self.calls, &[Some(*token)]);
        now.event("e", e);
        now.event("f", f);
    }
}

/// A sink.
#[node]
pub struct ScSink {
    /// Its number.
    #[param]
    id: i64,
    /// Seed, mode and limit.
    #[param]
    script: [i64; 3],
    calls: i64,
}

#[node]
impl ScSink {
    fn process(&mut self, x: &i64) {
        call(self.id, self.script, &mut self.calls, &[Some(*x)]);
    }
}

/// A sink with a slot and an event.
#[node]
pub struct ScSinkS {
    /// Its number.
    #[param]
    id: i64,
    /// Seed, mode and limit.
    #[param]
    script: [i64; 3],
    calls: i64,
}

#[node]
impl ScSinkS {
    fn process(&mut self, x: &i64, e: Event<i64>) {
        let now = call(self.id, self.script, &mut self.calls, &[Some(*x)]);
        now.event("e", e);
    }
    #[slot]
    fn s(&mut self, token: &i64, e: Event<i64>) {
        let now = call(self.id, self.script, &mut self.calls, &[Some(*token)]);
        now.event("e", e);
    }
}

/// A sink that is told of ⊥.
#[node]
pub struct ScKeen {
    /// Its number.
    #[param]
    id: i64,
    /// Seed, mode and limit.
    #[param]
    script: [i64; 3],
    calls: i64,
}

#[node]
impl ScKeen {
    fn process(&mut self, x: &i64) {
        call(self.id, self.script, &mut self.calls, &[Some(*x)]);
    }
    #[no_message]
    fn nothing(&mut self) {
        call(self.id, self.script, &mut self.calls, &[None]);
    }
}

/// Slots and events.
#[node]
pub struct ScHandler {
    /// Its number.
    #[param]
    id: i64,
    /// Seed, mode and limit.
    #[param]
    script: [i64; 3],
    calls: i64,
}

#[node]
impl ScHandler {
    #[slot]
    fn s(&mut self, token: &i64, e: Event<i64>, f: Event<i64>) {
        let now = call(self.id, self.script, &mut self.calls, &[Some(*token)]);
        now.event("e", e);
        now.event("f", f);
    }
    #[slot]
    fn t(&mut self, token: &i64, e: Event<i64>, f: Event<i64>) {
        let now = call(self.id, self.script, &mut self.calls, &[Some(*token)]);
        now.event("e", e);
        now.event("f", f);
    }
}

/// Takes activity away.
#[node]
#[deactivates]
pub struct ScStop {
    /// Its number.
    #[param]
    id: i64,
    /// Seed, mode and limit.
    #[param]
    script: [i64; 3],
    calls: i64,
}

#[node]
impl ScStop {
    #[slot]
    fn s(&mut self, token: &i64, e: Event<i64>) {
        let now = call(self.id, self.script, &mut self.calls, &[Some(*token)]);
        now.event("e", e);
    }
}

/// A slot without a value.
#[node]
pub struct ScKick {
    /// Its number.
    #[param]
    id: i64,
    /// Seed, mode and limit.
    #[param]
    script: [i64; 3],
    calls: i64,
}

#[node]
impl ScKick {
    #[slot]
    fn s(&mut self, e: Event<i64>) {
        let now = call(self.id, self.script, &mut self.calls, &[None]);
        now.event("e", e);
    }
}

/// Sends lists.
#[node]
pub struct ScList {
    /// Its number.
    #[param]
    id: i64,
    /// Seed, mode and limit.
    #[param]
    script: [i64; 3],
    calls: i64,
}

#[node]
impl ScList {
    fn process(&mut self, x: &i64) -> Option<Vec<i64>> {
        let now = call(self.id, self.script, &mut self.calls, &[Some(*x)]);
        now.value("out").map(|value| vec![value; 2])
    }
}

/// A sink of lists.
#[node]
pub struct ScListSink {
    /// Its number.
    #[param]
    id: i64,
    /// Seed, mode and limit.
    #[param]
    script: [i64; 3],
    calls: i64,
}

#[node]
impl ScListSink {
    fn process(&mut self, x: &Vec<i64>) {
        call(self.id, self.script, &mut self.calls, &[x.first().copied()]);
    }
}
