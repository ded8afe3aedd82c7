//! Calls of nodes, with their arguments and results.

use crate::{Args, Value, local::Local, run::Run};
use apex_dsl::{
    graph::{NodeId, PortId},
    program::{Arg, Call, Deadline, Failing, Fire, Flag, ParamOutput, SlotCall},
};
use apex_rt::{Ctx, Failure, Observer, contain};
use std::{cell::RefCell, rc::Rc, time::Duration};

impl<'r, O: Observer> Run<'r, '_, O> {
    /// Fires a node.
    pub fn fire(&mut self, node: NodeId, fire: &Fire, ctx: &Ctx, local: &mut Local<'r>) {
        let input = PortId { node, port: 0 };
        match fire {
            Fire::Call(call) => self.call(node, call, ctx, local),
            Fire::Each(deadline) => {
                self.fire_each(node, ctx, local);
                self.late(node, *deadline, ctx);
            }
            Fire::Hold => {
                let token = local.arriving(self.state, input);
                self.state.held.entry(node).and_modify(|held| held.put(token));
            }
            Fire::Output => match local.arriving(self.state, input) {
                Some(token) => drop(self.state.outputs.insert(node, token)),
                None => drop(self.state.outputs.remove(&node)),
            },
            Fire::Relay => {
                let token = local.arriving(self.state, input);
                local.write(self.state, PortId { node, port: 1 }, token);
            }
            Fire::See => {
                if let Some(token) = local.arriving(self.state, input) {
                    self.state.probes.entry(node).or_default().push(token);
                }
            }
            Fire::Nothing => {}
        }
    }

    fn call(&mut self, node: NodeId, call: &Call, ctx: &Ctx, local: &mut Local<'r>) {
        let Some(args) = &call.args else { return self.set_params(node, call, local) };
        if call.is_gated && !self.state.flags.contains(&Flag::Enabled(node)) {
            return self.nothing(call, local);
        }
        let number = self.number(node);
        self.observer.fired(number);
        self.set_params(node, call, local);
        let is_missing = |input: &PortId| local.arriving(self.state, *input).is_none();
        if call.mandatory.iter().flatten().any(is_missing) {
            self.nothing(call, local);
            self.called(node, call.failing, |boxed| {
                boxed.absent();
                Ok(())
            });
        } else if self.accepts_all(node, call, local) {
            let args = self.args(node, args, None, ctx, Some(local));
            if let Some(event) = call.processed {
                self.state.trigger(event);
            }
            let result = self.called(node, call.failing, |boxed| boxed.process(&args));
            self.all_triggered(node, args);
            self.nothing(call, local);
            for (port, token) in result.into_iter().flatten() {
                local.write(self.state, PortId { node, port }, token);
            }
        } else {
            self.nothing(call, local);
        }
        for ParamOutput { param, arrived, output } in &call.param_outputs {
            let value = match arrived {
                Some(input) => local.arriving(self.state, *input),
                None => self.state.nodes.get_mut(&node).and_then(|node| node.param(*param)),
            };
            local.write(self.state, *output, value);
        }
        self.late(node, call.deadline, ctx);
        self.observer.finished(number);
    }

    /// Puts tokens at parameter ports into the fields of a node.
    fn set_params(&mut self, node: NodeId, call: &Call, local: &Local<'r>) {
        for (param, input) in &call.sets {
            if let Some(value) = local.arriving(self.state, *input)
                && self.accepts(node, *param, &value)
                && let Some(node) = self.state.nodes.get_mut(&node)
            {
                node.put_param(*param, &value);
            }
        }
    }

    /// Returns `true` if a value of a parameter is in its range, and reports it if not.
    fn accepts(&mut self, node: NodeId, param: usize, value: &Value) -> bool {
        let Some(boxed) = self.state.nodes.get(&node) else { return false };
        match boxed.accepts(param, value) {
            Ok(()) => true,
            Err((name, value)) => {
                self.observer.refused(self.number(node), name, &format_args!("{value}"));
                false
            }
        }
    }

    /// Returns `true` if the parameters of a function that have arrived are in their ranges.
    fn accepts_all(&mut self, node: NodeId, call: &Call, local: &Local<'r>) -> bool {
        call.checks.iter().all(|(param, input)| {
            let value = local.arriving(self.state, *input);
            value.is_some_and(|value| self.accepts(node, *param, &value))
        })
    }

    /// A node sends ⊥.
    fn nothing(&mut self, call: &Call, local: &mut Local<'r>) {
        let results = call.results.iter().map(|result| result.output);
        for port in results.chain(call.buffers.iter().copied()) {
            local.write(self.state, port, None);
        }
    }

    /// Calls the method of a slot.
    pub fn call_slot(&mut self, slot: usize, call: &SlotCall, token: Option<Value>, ctx: &Ctx) {
        let to = self.code.graph().connections[self.code.program.wiring.slots[slot].connection].to;
        let uses_token = call.args.iter().any(|arg| matches!(arg, Arg::OfSlot));
        if token.is_some() || !uses_token {
            if self.state.machines.contains_key(&to.node) {
                self.call_machine(to.node, |machine| machine.slot(to.port, token.as_ref()));
            } else {
                let args = self.args(to.node, &call.args, token, ctx, None);
                self.called(to.node, call.failing, |boxed| boxed.slot(to.port, &args));
                self.all_triggered(to.node, args);
            }
        }
        self.late(to.node, call.deadline, ctx);
    }

    /// The events that a call has triggered.
    fn all_triggered(&mut self, node: NodeId, args: Args) {
        args.events.into_inner().into_iter().for_each(|(port, token)| self.triggered(PortId { node, port }, token));
    }

    /// An event that is triggered.
    pub fn triggered(&mut self, event: PortId, token: Value) {
        if self.code.program.lower.is_sent_event(event) {
            self.state.tokens.insert(event, token);
        }
    }

    /// Arguments of a call.
    fn args(&self, node: NodeId, args: &[Arg], token: Option<Value>, ctx: &Ctx, local: Option<&Local<'r>>) -> Args {
        let is_active = self.state.flags.contains(&Flag::Active(node));
        let mut made = Args { ctx: ctx.of_node(is_active), tokens: vec![], params: vec![], events: RefCell::default() };
        let arriving = |input: &PortId| local.and_then(|local| local.arriving(self.state, *input));
        for arg in args {
            match arg {
                Arg::Token { input, .. } => made.tokens.push(arriving(input)),
                Arg::Tokens { inputs, .. } => made.tokens.extend(inputs.iter().map(arriving)),
                Arg::OfSlot => made.tokens.push(token.clone()),
                Arg::Arrived { param, input } => made.params.extend(arriving(input).map(|value| (*param, value))),
                Arg::Checked(param) => {
                    let input = self.code.program.lower.param_source(node, *param);
                    made.params.extend(input.and_then(|input| arriving(&input)).map(|value| (*param, value)));
                }
                Arg::Context | Arg::Buffer(_) | Arg::Event { .. } | Arg::Param(_) => {}
            }
        }
        made
    }

    /// Calls a node. Its failure is reported, and contained where the text says so.
    fn called<T>(
        &mut self,
        node: NodeId,
        failing: Failing,
        call: impl FnOnce(&mut dyn crate::Node) -> Result<T, Failure>,
    ) -> Option<T> {
        let boxed = self.state.nodes.get_mut(&node)?;
        let result = match failing {
            Failing::Contained { .. } => contain(|| call(&mut **boxed)).and_then(|result| result),
            Failing::Never | Failing::Reported => call(&mut **boxed),
        };
        match result {
            Ok(value) => Some(value),
            Err(failure) => {
                self.observer.failed(self.number(node), &failure);
                if let Failing::Contained { event, restart, .. } = failing {
                    if let Some(event) = event {
                        self.state.tokens.insert(event, Rc::new(failure));
                    }
                    if restart {
                        self.restart(node);
                    }
                }
                None
            }
        }
    }

    /// Makes a node again. Its parameters stay as they are.
    fn restart(&mut self, node: NodeId) {
        let lower = self.code.program.lower;
        let apex_dsl::graph::NodeKind::Library(library) = &lower.graph.nodes[node].kind else { return };
        let signature = &lower.catalog.signatures[library.signature];
        let made = self.library.make(self.number(node), signature, library);
        let (Some(mut made), Some(old)) = (made, self.state.nodes.get_mut(&node)) else { return };
        for param in 0..signature.params.len() {
            if let Some(value) = old.param(param) {
                made.put_param(param, &value);
            }
        }
        self.state.nodes.insert(node, made);
    }

    /// Reports a node that has finished later than its `deadline` allows.
    pub fn late(&mut self, node: NodeId, deadline: Option<Deadline>, ctx: &Ctx) {
        let Some(Deadline { time, event }) = deadline else { return };
        if ctx.is_late(self.number(node), time, self.observer)
            && let Some(event) = event
        {
            self.state.trigger(event);
        }
    }

    /// Duration of a silence: the shortest of its nodes.
    pub fn silence(&mut self, silence: usize) -> Duration {
        let wiring = &self.code.program.wiring;
        let state = &mut *self.state;
        let times =
            wiring.missed_by(&wiring.silences[silence]).filter_map(|node| Some(state.nodes.get_mut(&node)?.silence()));
        times.min().unwrap_or(Duration::MAX)
    }
}
