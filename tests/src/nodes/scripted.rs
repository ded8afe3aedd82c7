//! Nodes that send tokens according to a script, and record the tokens that they take.

use crate::oracle::call;
use apex_rt::prelude::*;

/// Two outputs.
#[derive(Outputs)]
pub struct ScriptedPair {
    /// First output.
    pub a: Option<i64>,
    /// Second output.
    pub b: Option<i64>,
}

/// A source.
#[node]
pub struct ScSource {
    /// Identifier of the node.
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
    /// Identifier of the node.
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
    /// Identifier of the node.
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
    /// Identifier of the node.
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
    /// Identifier of the node.
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
    /// Identifier of the node.
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
    /// Identifier of the node.
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
    /// Identifier of the node.
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
    /// Identifier of the node.
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
    /// Identifier of the node.
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
    /// Identifier of the node.
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

/// A sink that is notified of ⊥.
#[node]
pub struct ScKeen {
    /// Identifier of the node.
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
    /// Identifier of the node.
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

/// Removes activity.
#[node]
#[deactivates]
pub struct ScStop {
    /// Identifier of the node.
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
    /// Identifier of the node.
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
        // The number of a token that no scripted node has sent.
        let now = call(self.id, self.script, &mut self.calls, &[Some(7)]);
        now.event("e", e);
    }
}

/// An input without a value.
#[node]
pub struct ScTock {
    /// Identifier of the node.
    #[param]
    id: i64,
    /// Seed, mode and limit.
    #[param]
    script: [i64; 3],
    calls: i64,
}

#[node]
impl ScTock {
    fn process(&mut self, _x: &(), e: Event<i64>) -> Option<i64> {
        let now = call(self.id, self.script, &mut self.calls, &[Some(7)]);
        now.event("e", e);
        now.value("out")
    }
}

/// Sends lists.
#[node]
pub struct ScList {
    /// Identifier of the node.
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
    /// Identifier of the node.
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
