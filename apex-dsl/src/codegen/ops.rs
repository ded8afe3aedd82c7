//! Operations of a program as Rust.

use super::{
    activity::followed,
    emitter::Writer,
    generator::Generator,
    stamps,
    tokens::{ident, nanos},
    view::ProgramView,
};
use crate::{
    graph::{NodeId, PortId},
    machine::Move,
    program::{Cancel, Flag, Op, Taken},
    syntax::tree::PortKind,
};
use proc_macro2::{Literal, TokenStream};
use quote::quote;

impl Generator<'_> {
    /// Operations that do not belong to a cluster.
    pub fn ops(&self, view: ProgramView<'_>, ops: &[Op]) -> TokenStream {
        Writer { generator: self, view, inside: None }.ops(ops)
    }
}

impl Writer<'_> {
    /// Operations in sequence.
    pub fn ops(&self, ops: &[Op]) -> TokenStream {
        let mut code = quote!();
        let mut at = 0;
        while at < ops.len() {
            match self.leave(ops, at) {
                Some(leave) => {
                    code.extend(leave);
                    at += 2;
                }
                None => {
                    code.extend(self.op(&ops[at]));
                    at += 1;
                }
            }
        }
        code
    }

    /// The two operations from `at` on as one call, if activity goes with a token that is then sent, and nothing else
    /// goes or is sent there.
    fn leave(&self, ops: &[Op], at: usize) -> Option<TokenStream> {
        let (Op::Pass { port, then }, Op::Send(sent)) = (ops.get(at)?, ops.get(at + 1)?) else { return None };
        let others = at.checked_sub(1).into_iter().chain([at + 2]).filter_map(|other| ops.get(other));
        let is_alone = !others.into_iter().any(|op| matches!(op, Op::Pass { .. } | Op::PassHeld(_) | Op::Send(_)));
        let is_plain = then.is_empty() && self.generator.observed_event(self.view.graph, *port).is_none();
        if port != sent || !is_alone || !is_plain || self.inside.is_some() || self.op(&ops[at + 1]).is_empty() {
            return None;
        }
        let (row, token) = (self.generator.port_row(self.view, *port), self.generator.kept(*port));
        Some(quote! { core.leave(&#row, #token, ctx, observer); })
    }

    fn op(&self, op: &Op) -> TokenStream {
        let (generator, view) = (self.generator, self.view);
        match op {
            Op::Activate { node, then } => {
                let row = generator.node_constant(view, *node);
                followed(&quote!(core.activate(&#row, ctx, observer)), &self.ops(then))
            }
            Op::Deactivate { node, then } => {
                let row = generator.node_constant(view, *node);
                followed(&quote!(core.deactivate(&#row, observer)), &self.ops(then))
            }
            Op::TakeActivity { node, gains, loses } => self.take_activity(*node, gains, loses),
            Op::HoldActivity(node) => {
                let (held, gains) = (generator.held_activity(*node), generator.take(Flag::Gains(*node)));
                quote! { state.#held.put(#gains.then_some(())); }
            }
            Op::ClearHeld(node) => {
                let held = generator.held_activity(*node);
                quote! { state.#held.clear(); }
            }
            Op::Pass { port, then } => {
                let (row, token) = (generator.port_row(view, *port), self.presence(*port));
                followed(&quote!(core.pass(&#row, #token, observer)), &self.ops(then))
            }
            Op::PassHeld(port) => {
                let (row, held) = (generator.port_row(view, *port), generator.held_activity(port.node));
                quote! { if state.#held.take().is_some() { core.carry(&#row); } }
            }
            Op::Hook { node, active } => generator.hook(view.graph, *node, *active),
            Op::CheckClaims => quote! { Self::check_claims(state, core, observer); },
            Op::Set(flag, value) => generator.set(*flag, *value),
            Op::ForgetTokens => {
                let sets = generator.activity_state(view).into_iter().map(|kept| kept.name);
                let sets = sets.filter(|name| ["gains", "carries"].iter().any(|set| name == set));
                quote! { #(core.#sets = ::apex_rt::Bits::NONE;)* }
            }
            Op::ForgetCancelled(node) => {
                let name = generator.held(*node);
                quote! { state.#name = ::apex_rt::Bits::NONE; }
            }
            Op::GiveBack { interrupt, node, then } => {
                let (remembered, then) = (generator.held(*interrupt), self.ops(then));
                let bit = Literal::usize_unsuffixed(generator.index(*node));
                quote! { if state.#remembered.take(#bit) { #then } }
            }
            Op::Cancel(cancel) => self.cancel(cancel),
            Op::Clear(end) => {
                let name = generator.name(*end);
                quote! { state.#name = None; }
            }
            Op::Trigger(end) => {
                let name = generator.name(*end);
                quote! { state.#name = Some(()); }
            }
            Op::Send(end) => match view.wiring.port(*end) {
                Some(port) => generator.send(view, port),
                None => generator.bug(view.graph.nodes[end.node].span, "a port that sends has no row"),
            },
            Op::Taking { port, body } => {
                let body = self.ops(body);
                generator.taken(view.graph, *port, &body)
            }
            Op::Settle(row) => quote! { core.dispatcher.settle(Self::CLUSTERS, #row); },
            Op::Serve { slot, unless_exit } => generator.serve_one(view, *slot, *unless_exit),
            Op::ServeCircle(slots) => generator.serve_circle(view, slots),
            Op::Call { slot, taken, call } => generator.call_method(view, *slot, *taken, call.as_ref()),
            Op::SeeSlot { slot, taken } => generator.see_slot(view, *slot, *taken),
            Op::PutOut { slot, taken, room } => generator.put_out(view, *slot, *taken, *room),
            Op::Exit(code) => quote! { state.exit = Some(#code); },
            Op::Reset => quote! { Self::reset(nodes, state, core, ctx, observer); },
            Op::Interrupt(slot) => {
                let name = generator.interrupt_function(view, *slot);
                quote! { Self::#name(nodes, state, core, ctx, observer); }
            }
            Op::If { flag, is, then } => {
                let (not, test, then) = ((!is).then(|| quote!(!)), generator.is_set(*flag), self.ops(then));
                quote! { if #not #test { #then } }
            }
            Op::Move { node, how } => self.move_machine(*node, *how),
            Op::ShowStates => generator.initial_states(),
            Op::TimeStates(node) => self.time_states(*node),
            Op::LeaveState { node, wait, call } => generator.leave_state(view, *node, *wait, call),
            Op::StartTimeout(timeout) => {
                let after = nanos(view.wiring.timeouts[*timeout].after);
                quote! { core.start_timeout(#timeout, #after, ctx); }
            }
            Op::StopTimeout(timeout) => quote! { core.stop_timeout(#timeout); },
            Op::Advance(timer) => match view.wiring.has_agenda() {
                true => quote! { core.agenda.advance(&mut core.timers[#timer]); },
                false => quote! { core.timers[#timer].advance(); },
            },
            Op::Hear(silences) => generator.hear(view, silences),
            Op::Stamp { upstream, stamps, leaves } => stamps::of_firing(upstream, stamps, *leaves),
            _ => match self.inside {
                Some((emitter, block)) => emitter.op(op, block),
                None => generator.bug(view.graph.span, "an operation of a cluster stands outside of one"),
            },
        }
    }

    /// Expression that tells the functions of the runtime if a token is there.
    fn presence(&self, port: PortId) -> TokenStream {
        match self.inside {
            Some((emitter, block)) if self.view.graph.port(port).kind == PortKind::Output => {
                let token = emitter.option(port, block);
                quote!(&#token)
            }
            _ => self.generator.kept(port),
        }
    }

    fn take_activity(&self, node: NodeId, gains: &[Op], loses: &[Op]) -> TokenStream {
        let (take_gains, take_loses) = (self.generator.take(Flag::Gains(node)), self.generator.take(Flag::Loses(node)));
        let (has_gains, has_loses) = (!gains.is_empty(), !loses.is_empty());
        let (gains, loses) = (self.ops(gains), self.ops(loses));
        match (has_gains, has_loses) {
            (_, false) => quote! { if #take_gains { #gains } },
            (false, true) => quote! { if #take_loses { #loses } },
            (true, true) => quote! {
                match (#take_gains, #take_loses) {
                    (true, _) => { #gains }
                    (false, true) => { #loses }
                    _ => {}
                }
            },
        }
    }

    fn cancel(&self, cancel: &Cancel) -> TokenStream {
        let generator = self.generator;
        let Cancel { interrupt, remembers, is_reached, takes, cancelled } = cancel;
        let brought = if *is_reached { generator.take(Flag::Active(*interrupt)) } else { quote!(false) };
        let remembered = remembers.then(|| generator.held(*interrupt));
        let forget = remembered.as_ref().map(|_| quote! { let mut remembered = ::apex_rt::Bits::NONE; });
        // Without activity there is nothing to remember instead.
        let keep = remembered.as_ref().map(|kept| quote! { if taken { state.#kept = remembered; } });
        let takes = takes.iter().map(|Taken { node, on_the_way, remember, then }| {
            let flags = on_the_way.iter().map(|flag| generator.take(*flag));
            let found = flags.chain([generator.has_activity(self.view.program.lower.spot(*node))]);
            let bits = remember.iter().map(|node| Literal::usize_unsuffixed(generator.index(*node)));
            let then = self.ops(then);
            quote! { if #(#found)|* { taken = true; #(remembered.set(#bits, true);)* #then } }
        });
        let sends = cancelled.map(|(event, carries)| {
            let name = generator.name(event);
            let activity = carries.then(|| generator.set(Flag::Active(*interrupt), true));
            quote! { if taken { state.#name = Some(()); #activity } }
        });
        quote! {
            #[allow(unused_mut)]
            let mut taken = false;
            #forget
            #(#takes)*
            #keep
            let taken = #brought | taken;
            #sends
        }
    }

    fn time_states(&self, node: NodeId) -> TokenStream {
        let (generator, view) = (self.generator, self.view);
        let Some(first) = view.wiring.first_wait(node) else {
            return generator.bug(view.graph.nodes[node].span, "the states of a machine have no timeouts");
        };
        let (place, first) = (generator.node_place(view.graph, node), Literal::usize_unsuffixed(first));
        let times = view.program.lower.waits(node).iter().map(|wait| nanos(wait.after));
        quote! { core.time_states(#first, #place.waits(), [#(#times),*], ctx); }
    }

    fn move_machine(&self, node: NodeId, how: Move) -> TokenStream {
        let (generator, graph) = (self.generator, self.view.graph);
        let events = self.view.program.lower.moved(node);
        let events = events.map(|event| generator.event(event, self.view.program.lower.is_sent_event(event)));
        let (place, method) = (generator.node_place(graph, node), ident(how.method()));
        generator.states_told(graph, node, quote! { #place.#method(#(#events),*); })
    }
}
