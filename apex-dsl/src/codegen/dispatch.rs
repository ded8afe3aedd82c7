//! `react`: which cluster fires and which slot is served, and when.

use super::{
    cells::receivers,
    clusters::{FiringCode, fire, table},
    field::{Kind, StateField},
    generator::Generator,
    sets::{cluster_rows, set, set_type},
    tokens::ident,
    view::ProgramView,
};
use crate::{
    analyse::{Delivery, Guard, MANY},
    graph::{Graph, NodeId, NodeKind},
    program::{After, Firing, Poll, Reaction},
};
use proc_macro2::{Literal, TokenStream};
use quote::quote;
use syn::Ident;

impl Generator<'_> {
    /// Fields of the program's state that the dispatcher needs, with what they start as.
    pub fn dispatcher_state(&self, view: ProgramView<'_>) -> Vec<StateField> {
        let bits = &view.wiring.bits;
        let mut fields = vec![];
        let mut field = |name: &str, ty, make| {
            fields.push(StateField::new(Kind::Dispatcher, name.to_owned(), ident(name), ty, make));
        };
        let (words, slots) = (bits.words(), view.analysis.asynchronous.slots.len());
        if words > 0 {
            let initial = bits.initial().into_iter().map(Literal::usize_unsuffixed);
            let make = quote!(::apex_rt::Dispatcher::new(::apex_rt::Bits::of(&[#(#initial),*])));
            // Fewer clusters are as fast tested as passed over.
            let tracks = bits.dispatched().len() >= 3;
            field("dispatcher", quote!(::apex_rt::Dispatcher<#words, #tracks>), make);
        }
        if slots > 0 && view.analysis.asynchronous.delivery == Delivery::Queued {
            field("queue", quote!(::apex_rt::Queue<#slots>), quote!(::apex_rt::Queue::new()));
        }
        if view.analysis.asynchronous.endless {
            let kinds = slots + bits.dispatched().len();
            field("steps", quote!(::apex_rt::Steps<#kinds>), quote!(::apex_rt::Steps::new()));
        }
        if view.wiring.may_get_stuck {
            field("stuck", quote!(usize), quote!(0));
        }
        if view.program.lower.has_exit() {
            field("exit", quote!(::core::option::Option<u8>), quote!(None));
        }
        if view.program.lower.has_start() {
            field("started", quote!(bool), quote!(false));
        }
        if view.wiring.has_agenda() {
            field("agenda", quote!(::apex_rt::Agenda), quote!(::apex_rt::Agenda::new()));
        }
        if view.program.has_time() {
            field("time", quote!(::apex_rt::ProgramTime), quote!(::apex_rt::ProgramTime::new()));
        }
        for (cell, _) in receivers(view.graph) {
            let name = Self::holding(cell).to_string();
            field(&name, quote!(bool), quote!(false));
        }
        for node in view.graph.nodes.ids().filter(|node| matches!(view.graph.nodes[*node].kind, NodeKind::SetBack)) {
            field(&Self::told_ahead(node).to_string(), quote!(i64), quote!(0));
        }
        fields
    }

    /// The tables of the dispatcher, and the functions that serve slots.
    pub fn dispatcher(&self, view: ProgramView<'_>) -> TokenStream {
        let ProgramView { analysis, wiring, .. } = view;
        let bits = &wiring.bits;
        let (set, rows) = (set_type(bits), cluster_rows(view));
        let mut code = quote!();
        if bits.words() > 0 {
            let count = rows.len();
            code.extend(quote! {
                const CLUSTERS: &'static [::apex_rt::Cluster<#set>; #count] = { use ::apex_rt::Cluster; &[#(#rows),*] };
            });
        }
        let missing = self.missing_rows(view);
        if !missing.is_empty() {
            let count = missing.len();
            code.extend(quote! { const MISSING: &'static [::apex_rt::Missing<#set>; #count] = &[#(#missing),*]; });
        }
        if !analysis.asynchronous.slots.is_empty() {
            code.extend(self.slot_functions(view));
            if analysis.asynchronous.delivery == Delivery::Queued {
                code.extend(self.serve(view));
            }
        }
        code.extend(self.expire_functions(view));
        code.extend(self.patience_functions(view));
        if view.program.lower.has_start() {
            let begin = self.ops(view, &view.program.first);
            code.extend(quote! {
                fn begin<O: ::apex_rt::Observer>(&mut self, ctx: &::apex_rt::Ctx, observer: &mut O) {
                    let Self { nodes, state, core, .. } = self;
                    #begin
                }
            });
        }
        if view.program.lower.has_reset() {
            let reset = self.ops(view, &view.program.reset);
            let (nodes, [state, core]) = (self.nodes_type(view), self.state_types(view));
            code.extend(quote! {
                fn reset<O: ::apex_rt::Observer>(nodes: &mut #nodes, state: &mut #state, core: &mut #core, ctx: &::apex_rt::Ctx, observer: &mut O) {
                    #reset
                }
            });
        }
        code.extend(self.interrupts(view));
        if analysis.asynchronous.endless {
            code.extend(quote! {
                /// Sets how many steps a reaction may take before it is reported as an endless loop.
                pub fn set_budget(&mut self, steps: u32) { self.state.steps.set_budget(steps); }
            });
        }
        code
    }

    /// `react_with`; where it is recorded, what is inside of that.
    pub fn react(&self, view: ProgramView<'_>) -> TokenStream {
        let bits = &view.wiring.bits;
        let ProgramView { graph, analysis, program, .. } = view;
        let Reaction { start, once, before, polls, firings, has_rounds, left } = &program.reaction;
        let endless = program.lower.is_endless();
        let (raises, expires, wishes) = (self.raises(view, polls), self.expires_first(view), self.wishes(view));
        let next = self.next(view);
        let has_exit = program.lower.has_exit();
        let exit =
            has_exit.then(|| quote! { if let Some(code) = self.state.exit { return ::apex_rt::Next::Exit(code); } });
        let fired = |firing: &Firing| FiringCode {
            cluster: firing.cluster,
            row: firing.row,
            fire: fire(view, firing.cluster),
            served: self.served(view, &firing.served),
        };
        let inside: Vec<FiringCode> = firings.iter().map(fired).collect();
        let before: Vec<FiringCode> = before.iter().map(fired).collect();
        let steps = endless.then_some(analysis.asynchronous.slots.len());
        let before: TokenStream = before.iter().map(|firing| firing.straight(steps, false, exit.as_ref())).collect();
        let in_turn = inside.iter().any(|firing| firing.row.is_none());
        let clusters = match inside.len() > MANY && !bits.dispatched().is_empty() {
            true => table(&inside, analysis.clusters.len(), steps, exit.as_ref()),
            false => inside.iter().map(|firing| firing.straight(steps, true, exit.as_ref())).collect(),
        };
        // In a reaction that makes no cluster ready none is looked at.
        let inside = match (bits.dispatched().is_empty(), in_turn) {
            (true, _) => clusters,
            (false, true) => quote! { if self.core.dispatcher.take_news() || first { #clusters } },
            (false, false) => quote! { if self.core.dispatcher.take_news() { #clusters } },
        };
        let start = start.as_ref().map(|serve| {
            let serve = self.served(view, serve);
            quote! { if !::core::mem::replace(&mut self.state.started, true) { self.begin(ctx, observer); #serve } }
        });
        let begin_steps = endless.then(|| {
            // What the reaction before left when its steps were used up.
            let serve = self.ops(view, left);
            let ready = (!bits.dispatched().is_empty()).then(|| quote! { self.core.dispatcher.look_again(); });
            quote! { self.state.steps.begin(); #ready #serve }
        });
        // What was served before the clusters may have ended the program.
        let ended = exit.clone().filter(|_| start.is_some() || endless);
        let used_up = endless.then(|| self.used_up(view));
        let leave = if has_exit {
            quote!(if quiet || self.state.exit.is_some() {
                break;
            })
        } else {
            quote!(if quiet {
                break;
            })
        };
        let stuck = self.stuck(view);
        let stop = endless.then(|| quote! { if self.state.steps.is_used_up() { break; } });
        let serve_first = program.lower.has_queue().then(|| {
            quote! { if !self.core.queue.is_empty() && self.serve(ctx, observer) { quiet = false; } }
        });
        let over = has_exit.then(|| quote! { if self.state.exit.is_some() { break; } });
        let has_instants = program.has_instants();
        // Sources without a period fire when the reaction has made up for all that is late.
        let begins = match (self.part.is_some(), has_instants) {
            (true, true) => quote!(begins && completes),
            (true, false) => quote!(begins),
            (false, true) => quote!(completes),
            (false, false) => quote!(true),
        };
        let body = has_rounds.then(|| {
            quote! {
                let mut first = #begins;
                loop {
                    let mut quiet = true;
                    #raises
                    #serve_first
                    #over
                    #inside
                    first = false;
                    #stop
                    #expires
                    #leave
                }
            }
        });
        let begin = (!once.is_empty() || !before.is_empty()).then(|| match self.part.is_some() || has_instants {
            true => quote! { if #begins { #(self.core.dispatcher.raise(#once);)* #before } },
            false => quote! { #(self.core.dispatcher.raise(#once);)* #before },
        });
        let signature = self.signature(graph);
        let instant = quote! {
            let ctx = &::apex_rt::Ctx::at(at, now);
            #begin_steps
            #start
            #ended
            #begin
            #body
            #exit
            #used_up
            #stuck
            #[allow(unused_mut)]
            let mut next = ::apex_rt::Next::Input;
            #wishes
        };
        let next = quote!(next.or(#next));
        let (instant_begins, skips) = (self.next_instant(view), self.skips(view));
        let own_time = quote! { let now = self.state.time.of(now, observer); };
        let reaction = match (view.program.has_time(), has_instants) {
            (false, _) => quote! {
                #exit
                let at = now;
                #instant
                #next
            },
            (true, false) => quote! {
                #own_time
                #exit
                let at = now;
                self.state.time.begin(at);
                #instant
                self.state.time.outside(#next)
            },
            (true, true) => quote! {
                #own_time
                #exit
                #skips
                loop {
                    #instant_begins
                    let completes = at >= now || observer.ends_early();
                    #instant
                    if completes {
                        // Instants that are left come before anything else.
                        let next = if next.is_at_most(now) { next } else { #next };
                        return self.state.time.outside(next);
                    }
                }
            },
        };
        quote! {
            #signature {
                #reaction
            }
        }
    }

    /// The name of the function that reacts.
    pub fn reaction(&self) -> Ident {
        ident(if self.channels.is_some() { "reaction" } else { "react_with" })
    }

    /// The head of the function that reacts. A part of a program has ends of cells besides, and goes on with a reaction
    /// when other parts did something meanwhile.
    fn signature(&self, graph: &Graph) -> TokenStream {
        match self.part {
            Some(_) => {
                let ends = self.item(graph, "Ends");
                quote! {
                    fn react_part<O: ::apex_rt::Observer, W: ::apex_rt::threads::Wake>(
                        &mut self,
                        now: ::apex_rt::Time,
                        begins: bool,
                        ends: &mut #ends<'_>,
                        wake: &W,
                        observer: &mut O,
                    ) -> ::apex_rt::Next
                }
            }
            None => {
                let name = self.reaction();
                // Without the hint it would not be inlined where a caller of another module compiles it.
                quote! {
                    #[inline]
                    fn #name<O: ::apex_rt::Observer>(&mut self, now: ::apex_rt::Time, observer: &mut O) -> ::apex_rt::Next
                }
            }
        }
    }

    /// When a program wants to be called because of sources without a pace. If it waits for other thread groups, they
    /// wake it.
    fn next(&self, view: ProgramView<'_>) -> TokenStream {
        let bits = &view.wiring.bits;
        let guards = &view.analysis.guards;
        let mut plain =
            view.analysis.clusters.iter().flat_map(|c| &c.own_guards).filter(|g| guards[**g] == Guard::React);
        if self.part.is_none() {
            return if plain.next().is_some() { quote!(::apex_rt::Next::Now) } else { quote!(::apex_rt::Next::Input) };
        }
        let fired = plain.map(|guard| match bits.guard(*guard) {
            Some(bit) => quote!(!self.core.dispatcher.has(#bit)),
            None => quote!(true),
        });
        quote!(if false #(|| #fired)* { ::apex_rt::Next::Now } else { ::apex_rt::Next::Input })
    }

    /// Function that reports the tokens that clusters wait for, to explain a deadlock.
    pub fn waiting(&self, view: ProgramView<'_>) -> TokenStream {
        if self.missing_rows(view).is_empty() {
            return quote!();
        }
        quote! {
            fn waiting(&self, mut found: impl FnMut(usize)) {
                for missing in Self::MISSING {
                    if self.core.dispatcher.misses(missing) { found(missing.connection); }
                }
            }
        }
    }

    /// A reaction that took all its steps says so, and goes on in the next one.
    fn used_up(&self, view: ProgramView<'_>) -> TokenStream {
        let bits = &view.wiring.bits;
        let graph = view.graph;
        let slots = view.analysis.asynchronous.slots.iter().map(|c| graph.connections[*c].to.node);
        let clusters = bits.dispatched().iter().map(|c| view.analysis.clusters[*c].nodes.first().copied());
        let nodes = slots.chain(clusters.map(|n| n.unwrap_or(NodeId::from(0)))).map(|n| self.index(n));
        quote! {
            if self.state.steps.is_used_up() {
                let counts = self.state.steps.counts();
                observer.endless(&[#(#nodes),*], &counts);
                return ::apex_rt::Next::Now;
            }
        }
    }

    /// Tokens that wait for one another after a reaction are reported, once.
    fn stuck(&self, view: ProgramView<'_>) -> TokenStream {
        if !view.wiring.may_get_stuck {
            return quote!();
        }
        let (claim, slots) = (self.undecided_live(), self.slot_rows(view));
        let before = claim.map(|_| quote! { let before = state.stuck; });
        let claim = claim.map(|claim| quote! { if before == 0 && state.stuck > 0 { observer.claim_failed(#claim); } });
        quote! {
            if !self.core.queue.is_empty() {
                let Self { state, core, .. } = self;
                #before
                core.queue.stuck(#slots, &mut state.stuck, |connection| observer.stuck(connection));
                #claim
            }
        }
    }

    /// Service of slots when something has sent tokens.
    fn served(&self, view: ProgramView<'_>, after: &After) -> TokenStream {
        match after {
            After::Queue => quote! { if !self.core.queue.is_empty() { self.serve(ctx, observer); } },
            After::Slots(ops) => self.ops(view, ops),
        }
    }

    /// Polls of each round of a reaction.
    fn raises(&self, view: ProgramView<'_>, polls: &[Poll]) -> TokenStream {
        let polls = polls.iter().map(|poll| match poll {
            Poll::Room { event, bit } => {
                let port = ident(&view.graph.nodes[*event].name);
                quote! { if !self.events.#port.is_full() { self.core.dispatcher.raise(#bit); } }
            }
            Poll::Input { input, bit } => {
                let port = ident(&view.graph.nodes[*input].name);
                quote! { if self.inputs.#port.is_full() { self.core.dispatcher.raise(#bit); } }
            }
            Poll::Timers => {
                let due = self.timers_due(view);
                match view.wiring.has_agenda() {
                    true => quote! { if self.core.agenda.is_due(at) { #due } },
                    false => due,
                }
            }
            Poll::Slots(slots) => match slots.as_slice() {
                [slot] => self.enter(view, slot),
                several => self.enter_in_order(view, several),
            },
            Poll::Sender(sender) => self.send_far(view, sender),
            Poll::Receiver(receiver) => self.receive_far(view, receiver),
            Poll::SetBack(entering) => self.goes_back(view, entering),
        });
        polls.collect()
    }

    /// Code for one timeout or silence, if nothing else is left to do at an instant: what came in time counts before
    /// them. Only the first of them happens, as others may then be void.
    fn expires_first(&self, view: ProgramView<'_>) -> TokenStream {
        let budget = view.analysis.asynchronous.endless.then(|| quote!(&&!self.state.steps.is_used_up()));
        let timeouts = (!view.wiring.timeouts.is_empty())
            .then(|| quote! { if quiet #budget && self.expire(at, ctx, observer) { quiet = false; } });
        let silences = self.silences_end(view);
        if timeouts.is_none() && silences.is_empty() {
            return quote!();
        }
        let is_due = view.wiring.has_agenda().then(|| quote!(&&self.core.agenda.is_due(at)));
        quote! { if quiet #is_due { #silences #timeouts } }
    }

    /// Further conditions of a step: connections are free, and the steps of the reaction are not used up.
    pub fn allows(&self, view: ProgramView<'_>, free: &[usize]) -> TokenStream {
        const MOST_STRAIGHT: usize = 4;
        let free = if free.len() > MOST_STRAIGHT {
            let (ty, free) = (set_type(&view.wiring.bits), set(&view.wiring.bits, free));
            quote!(&& { const FREE: #ty = #free; self.core.dispatcher.holds(&FREE) })
        } else {
            quote!(#(&& self.core.dispatcher.has(#free))*)
        };
        let budget = view.analysis.asynchronous.endless.then(|| quote!(&&!self.state.steps.is_used_up()));
        quote!(#free #budget)
    }
}
