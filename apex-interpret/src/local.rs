//! Tokens of a firing of a cluster.

use crate::{Value, state::State};
use apex_dsl::{
    graph::PortId,
    program::{Lower, Plan, Storage},
};
use std::collections::BTreeMap;

/// Tokens of a firing of a cluster.
pub struct Local<'a> {
    /// The program.
    pub lower: Lower<'a>,
    /// Places of its tokens.
    pub plan: &'a Plan,
    /// Tokens that only this firing has.
    pub tokens: BTreeMap<PortId, Value>,
    /// Tokens of an iteration with several rates.
    pub arrays: BTreeMap<PortId, Vec<Option<Value>>>,
    /// Number of the firing in the iteration.
    pub firing: usize,
}

impl<'a> Local<'a> {
    /// No tokens yet.
    pub fn new(lower: Lower<'a>, plan: &'a Plan) -> Self {
        Self { lower, plan, tokens: BTreeMap::new(), arrays: BTreeMap::new(), firing: 0 }
    }

    /// The token at an output; in an iteration, the first that this firing sends.
    pub fn read(&self, state: &State<'_>, port: PortId) -> Option<Value> {
        match self.plan.storage(port) {
            Storage::Buffer | Storage::Outside => state.tokens.get(&port).cloned(),
            Storage::Array => {
                let place = self.firing * self.lower.graph.port(port).rate;
                self.arrays.get(&port).and_then(|tokens| tokens.get(place).cloned().flatten())
            }
            _ => self.tokens.get(&port).cloned(),
        }
    }

    /// The token that arrives at an input.
    pub fn arriving(&self, state: &State<'_>, to: PortId) -> Option<Value> {
        let from = self.lower.incoming(to)?;
        if self.plan.storage(from) != Storage::Array {
            return self.read(state, from);
        }
        let tokens = self.arrays.get(&from)?;
        if !self.lower.is_batched(to) {
            return tokens.get(self.firing).cloned().flatten();
        }
        let rate = self.lower.graph.port(to).rate;
        let batch = tokens.get(self.firing * rate..(self.firing + 1) * rate)?;
        let batch: Option<Vec<Value>> = batch.iter().cloned().collect();
        batch.map(|batch| std::rc::Rc::new(batch) as Value)
    }

    /// Puts a token at an output.
    pub fn write(&mut self, state: &mut State<'_>, port: PortId, token: Option<Value>) {
        match self.plan.storage(port) {
            Storage::Array => self.spread(port, token),
            Storage::Buffer => put(&mut state.tokens, port, token),
            _ => put(&mut self.tokens, port, token),
        }
    }

    fn spread(&mut self, port: PortId, token: Option<Value>) {
        let rate = self.lower.graph.port(port).rate;
        let is_batched = self.lower.is_batched(port);
        let Some(places) = self.arrays.get_mut(&port) else { return };
        match token {
            Some(token) if is_batched => {
                let batch = token.downcast_ref::<Vec<Value>>().cloned().unwrap_or_default();
                for (place, token) in places.iter_mut().skip(self.firing * rate).zip(batch) {
                    *place = Some(token);
                }
            }
            None if is_batched => {}
            token => places[self.firing] = token,
        }
    }
}

/// Puts a token in a place, or empties it.
pub fn put(tokens: &mut BTreeMap<PortId, Value>, port: PortId, token: Option<Value>) {
    match token {
        Some(token) => drop(tokens.insert(port, token)),
        None => drop(tokens.remove(&port)),
    }
}
