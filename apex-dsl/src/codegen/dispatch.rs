//! `react`: which cluster fires and which slot is served, and when.

use super::{
    Flag, Generator,
    activity::Whole,
    bits::Bits,
    cells::{ends_name, receivers},
    state::{Kept, Kind},
    types::ident,
};
use crate::{
    analyse::{Delivery, Guard, at_start},
    graph::{Graph, NodeId, NodeKind, Standard},
    syntax::tree::PortKind,
};
use proc_macro2::TokenStream;
use quote::{format_ident, quote};
use std::collections::BTreeMap;
use syn::Ident;

impl Generator<'_> {
    /// Fields of the program's state that the dispatcher needs, with what they start as.
    pub fn dispatcher_state(&self, whole: Whole<'_>, bits: &Bits) -> Vec<Kept> {
        let mut fields = vec![];
        let mut field = |name: &str, ty, make| {
            fields.push(Kept::new(Kind::Dispatcher, name.to_owned(), ident(name), ty, make));
        };
        let (words, slots) = (bits.words(), whole.analysis.asynchronous.slots.len());
        if words > 0 {
            let initial = bits.initial();
            let make = quote!(::apex_rt::Dispatcher::new(::apex_rt::Bits::of(&[#(#initial),*])));
            field("dispatcher", quote!(::apex_rt::Dispatcher<#words>), make);
        }
        if slots > 0 && whole.analysis.asynchronous.delivery == Delivery::Queued {
            field("queue", quote!(::apex_rt::Queue<#slots>), quote!(::apex_rt::Queue::new()));
        }
        if whole.analysis.asynchronous.endless {
            let kinds = slots + bits.dispatched().len();
            field("steps", quote!(::apex_rt::Steps<#kinds>), quote!(::apex_rt::Steps::new()));
        }
        if self.has_exit(whole.graph) {
            field("exit", quote!(::core::option::Option<u8>), quote!(None));
        }
        if self.has_start(whole) {
            field("started", quote!(bool), quote!(false));
        }
        if self.has_agenda(whole) {
            field("agenda", quote!(::apex_rt::Agenda), quote!(::apex_rt::Agenda::new()));
        }
        for (cell, _) in receivers(whole.graph) {
            let name = Self::holding(cell).to_string();
            field(&name, quote!(bool), quote!(false));
        }
        fields
    }

    /// Whether a token can end the program.
    pub fn has_exit(&self, graph: &Graph) -> bool {
        graph.nodes.iter().any(|n| matches!(n.kind, NodeKind::Exit(_)))
    }

    fn has_start(&self, whole: Whole<'_>) -> bool {
        let started = |n: &crate::graph::Node| n.starts_active || matches!(n.kind, NodeKind::Start);
        let watches = |node: NodeId| self.watches_silence(whole, node).is_some();
        whole.graph.nodes.iter().any(started) || (0..whole.graph.nodes.len()).any(watches)
    }

    /// The tables of the dispatcher, and the functions that serve slots.
    pub fn dispatcher(&self, whole: Whole<'_>, bits: &Bits) -> TokenStream {
        let Whole { graph, analysis, links } = whole;
        let (words, rows) = (bits.words(), bits.rows(graph, analysis, links));
        let mut code = quote!();
        if words > 0 {
            let count = rows.len();
            code.extend(quote! { const CLUSTERS: [::apex_rt::Cluster<#words>; #count] = [#(#rows),*]; });
        }
        let missing = bits.missing(analysis, &|c| self.connection(c));
        if !missing.is_empty() {
            let count = missing.len();
            code.extend(quote! { const MISSING: [::apex_rt::Missing<#words>; #count] = [#(#missing),*]; });
        }
        for (node, bit) in bits.room() {
            let name = Bits::room_name(*node);
            code.extend(quote! { const #name: usize = #bit; });
        }
        if !analysis.asynchronous.slots.is_empty() {
            code.extend(self.slot_functions(whole, bits));
            if analysis.asynchronous.delivery == Delivery::Queued {
                code.extend(self.serve(whole, bits));
            }
        }
        if self.has_start(whole) {
            let begin = self.first(whole, bits);
            code.extend(quote! {
                fn begin<O: ::apex_rt::Observer>(&mut self, ctx: &::apex_rt::Ctx, observer: &mut O) {
                    let Self { nodes, state, .. } = self;
                    #begin
                }
            });
        }
        if graph.nodes.iter().any(|n| matches!(n.kind, NodeKind::Reset)) {
            let (name, reset) = (&graph.name, self.reset(whole, bits));
            let (nodes, state) = (format_ident!("{name}Nodes"), format_ident!("{name}State"));
            code.extend(quote! {
                fn reset<O: ::apex_rt::Observer>(nodes: &mut #nodes, state: &mut #state, ctx: &::apex_rt::Ctx, observer: &mut O) {
                    #reset
                }
            });
        }
        if analysis.asynchronous.endless {
            code.extend(quote! {
                /// Sets how many steps a reaction may take before it is reported as an endless loop.
                pub fn set_budget(&mut self, steps: u32) { self.state.steps.set_budget(steps); }
            });
        }
        code
    }

    /// `react_with`; where it is recorded, what is inside of that.
    pub fn react(&self, whole: Whole<'_>, bits: &Bits) -> TokenStream {
        let Whole { graph, analysis, .. } = whole;
        let queued = analysis.asynchronous.delivery == Delivery::Queued;
        let serves = !analysis.asynchronous.slots.is_empty() && queued;
        let endless = analysis.asynchronous.endless;
        let (raises, wishes) = (self.raises(whole, bits), self.wishes(whole, bits));
        let once = analysis.guards.iter().enumerate().filter(|(_, g)| **g == Guard::React).filter_map(|(i, _)| {
            let bit = bits.guard(i)?;
            Some(quote! { self.state.dispatcher.raise(#bit); })
        });
        let next = self.next(whole, bits);
        let serve = |quiet: bool| match (serves, quiet) {
            (false, _) => quote!(),
            (true, true) => quote! { if !self.state.queue.is_empty() && self.serve(ctx, observer) { quiet = false; } },
            (true, false) => quote! { if !self.state.queue.is_empty() { self.serve(ctx, observer); } },
        };
        let loops = !bits.dispatched().is_empty() || !raises.is_empty();
        let any_stays = !bits.is_all_free();
        // Slots see in which order clusters fire: that of the text.
        let ordered = any_stays || !analysis.asynchronous.slots.is_empty();
        let has_exit = self.has_exit(graph);
        let exit =
            has_exit.then(|| quote! { if let Some(code) = self.state.exit { return ::apex_rt::Next::Exit(code); } });
        let firing: Vec<usize> = (0..analysis.clusters.len()).filter(|c| analysis.clusters[*c].fires).collect();
        let fires = firing.iter().map(|&cluster| {
            let name = format_ident!("cluster_{cluster}");
            let c = &analysis.clusters[cluster];
            let served = match queued {
                false => self.deliver(whole, &c.sends),
                true if c.sends.is_empty() && !any_stays => quote!(),
                true => serve(false),
            };
            let served = quote! { #served #exit };
            let Some(row) = bits.row(cluster) else {
                let fire = quote! { self.#name(ctx, observer); #served };
                return match (loops && ordered, endless) {
                    (true, true) => quote! { if first && !self.state.steps.is_used_up() { #fire } },
                    (true, false) => quote! { if first { #fire } },
                    (false, true) => quote! { if !self.state.steps.is_used_up() { #fire } },
                    (false, false) => fire,
                };
            };
            let timers = c.own_guards.iter().filter_map(|g| match analysis.guards[*g] {
                Guard::Timer(node) => Some(self.timer(node)),
                _ => None,
            });
            let has_agenda = self.has_agenda(whole);
            let open = has_agenda.then(|| quote! { self.state.agenda.open(); });
            let advances = timers.map(|timer| quote! { self.state.#timer.advance(); #open });
            let kind = analysis.asynchronous.slots.len() + row;
            let (budget, step) = match endless {
                true => (quote!(!self.state.steps.is_used_up() &&), quote! { self.state.steps.take(#kind); }),
                false => (quote!(), quote!()),
            };
            quote! {
                if #budget self.state.dispatcher.start(&Self::CLUSTERS[#row]) {
                    #step
                    #(#advances)*
                    self.#name(ctx, observer);
                    self.state.dispatcher.finish(&Self::CLUSTERS, #row);
                    #served
                    quiet = false;
                }
            }
        });
        let is_dispatched = |c: &usize| bits.row(*c).is_some();
        let fires: BTreeMap<usize, TokenStream> = firing.iter().copied().zip(fires).collect();
        let (inside, before): (Vec<usize>, Vec<usize>) =
            firing.into_iter().partition(|c| loops && (is_dispatched(c) || ordered));
        let in_turn = inside.iter().any(|c| !is_dispatched(c));
        let (before, inside) = (before.iter().map(|c| &fires[c]), inside.iter().map(|c| &fires[c]));
        // In a reaction that makes no cluster ready none is looked at.
        let inside = match (bits.dispatched().is_empty(), in_turn) {
            (true, _) => quote! { #(#inside)* },
            (false, true) => quote! { if self.state.dispatcher.take_news() || first { #(#inside)* } },
            (false, false) => quote! { if self.state.dispatcher.take_news() { #(#inside)* } },
        };
        let start = self.has_start(whole).then(|| {
            let serve = if queued { serve(false) } else { self.deliver(whole, &at_start(graph, analysis)) };
            quote! { if !::core::mem::replace(&mut self.state.started, true) { self.begin(ctx, observer); #serve } }
        });
        let begin_steps = endless.then(|| {
            // What the reaction before left when its steps were used up.
            let serve = self.deliver(whole, &analysis.asynchronous.slots);
            let ready = (!bits.dispatched().is_empty()).then(|| quote! { self.state.dispatcher.look_again(); });
            quote! { self.state.steps.begin(); #ready #serve }
        });
        let used_up = endless.then(|| self.used_up(whole, bits));
        let leave = if has_exit {
            quote!(if quiet || self.state.exit.is_some() {
                break;
            })
        } else {
            quote!(if quiet {
                break;
            })
        };
        let stop = endless.then(|| quote! { if self.state.steps.is_used_up() { break; } });
        let serve_first = serve(true);
        let begins = if self.part.is_some() { quote!(begins) } else { quote!(true) };
        let body = loops.then(|| {
            quote! {
                let mut first = #begins;
                loop {
                    let mut quiet = true;
                    #raises
                    #serve_first
                    #inside
                    first = false;
                    #stop
                    #leave
                }
            }
        });
        let signature = self.signature(graph);
        let begin = match self.part {
            Some(_) => quote! { if begins { #(#once)* #(#before)* } },
            None => quote! { #(#once)* #(#before)* },
        };
        quote! {
            #signature {
                let ctx = &::apex_rt::Ctx::new(now);
                #exit
                #begin_steps
                #start
                #begin
                #body
                #exit
                #used_up
                #[allow(unused_mut)]
                let mut next = #next;
                #wishes
                next
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
                let ends = ends_name(graph);
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
                quote! {
                    fn #name<O: ::apex_rt::Observer>(&mut self, now: ::apex_rt::Time, observer: &mut O) -> ::apex_rt::Next
                }
            }
        }
    }

    /// When a program wants to be called because of sources without a pace. If it waits for other thread groups, they wake it.
    fn next(&self, whole: Whole<'_>, bits: &Bits) -> TokenStream {
        let guards = &whole.analysis.guards;
        let mut plain =
            whole.analysis.clusters.iter().flat_map(|c| &c.own_guards).filter(|g| guards[**g] == Guard::React);
        if self.part.is_none() {
            return if plain.next().is_some() { quote!(::apex_rt::Next::Now) } else { quote!(::apex_rt::Next::Input) };
        }
        let fired = plain.map(|guard| match bits.guard(*guard) {
            Some(bit) => quote!(!self.state.dispatcher.holds(&::apex_rt::Bits::of(&[#bit]))),
            None => quote!(true),
        });
        quote!(if false #(|| #fired)* { ::apex_rt::Next::Now } else { ::apex_rt::Next::Input })
    }

    /// What clusters wait for, to tell a deadlock.
    pub fn waiting(&self, whole: Whole<'_>, bits: &Bits) -> TokenStream {
        if bits.missing(whole.analysis, &|c| self.connection(c)).is_empty() {
            return quote!();
        }
        quote! {
            fn waiting(&self, mut found: impl FnMut(usize)) {
                for missing in &Self::MISSING {
                    if self.state.dispatcher.misses(missing) { found(missing.connection); }
                }
            }
        }
    }

    /// A reaction that took all its steps says so, and goes on in the next one.
    fn used_up(&self, whole: Whole<'_>, bits: &Bits) -> TokenStream {
        let graph = whole.graph;
        let slots = whole.analysis.asynchronous.slots.iter().map(|c| graph.connections[*c].to.node);
        let clusters =
            bits.dispatched().iter().map(|c| whole.analysis.clusters[*c].nodes.first().copied().unwrap_or(0));
        let nodes = slots.chain(clusters).map(|n| self.index(n));
        quote! {
            if self.state.steps.is_used_up() {
                let counts = self.state.steps.counts();
                observer.endless(&[#(#nodes),*], &counts);
                return ::apex_rt::Next::Now;
            }
        }
    }

    /// What is looked at again and again while a program reacts: timers, mailboxes, timeouts.
    fn raises(&self, whole: Whole<'_>, bits: &Bits) -> TokenStream {
        let Whole { graph, analysis, .. } = whole;
        let mut raises = Raises { has_agenda: self.has_agenda(whole), code: quote!(), timed: quote!() };
        for (node, bit) in bits.room() {
            let port = ident(&graph.nodes[*node].name);
            raises.always(quote! { if !self.events.#port.is_full() { self.state.dispatcher.raise(#bit); } });
        }
        for (index, guard) in analysis.guards.iter().enumerate() {
            let Some(bit) = bits.guard(index) else { continue };
            match guard {
                Guard::Input(node) => {
                    let port = ident(&graph.nodes[*node].name);
                    raises.always(quote! { if self.inputs.#port.is_full() { self.state.dispatcher.raise(#bit); } });
                }
                Guard::Timer(node) => {
                    let timer = self.timer(*node);
                    raises.timed(quote! { if self.state.#timer.is_due(now) { self.state.dispatcher.raise(#bit); } });
                }
                Guard::React | Guard::Token(_) | Guard::Events(_) => {}
            }
        }
        for (id, node) in graph.nodes.iter().enumerate() {
            if matches!(node.kind, NodeKind::Boundary(PortKind::Slot)) && !whole.links.sends[id].is_empty() {
                raises.always(self.enter(whole, bits, id));
            }
            match node.kind {
                NodeKind::Sender(far) => raises.always(self.send_far(whole, bits, id, far)),
                NodeKind::Receiver(far) => raises.always(self.receive_far(whole, bits, id, far)),
                _ => {}
            }
            if self.has_timeout(whole, id) {
                raises.timed(self.expire(whole, bits, id));
            }
        }
        raises.finish()
    }

    /// When a program wants to be called because of its timers.
    fn wishes(&self, whole: Whole<'_>, bits: &Bits) -> TokenStream {
        let guards = whole.analysis.guards.iter().enumerate().filter(|(index, _)| bits.guard(*index).is_some());
        let timers = guards.filter_map(|(_, guard)| match guard {
            Guard::Timer(node) => Some(self.timer(*node)),
            _ => None,
        });
        let timeouts = (0..whole.graph.nodes.len()).filter(|n| self.has_timeout(whole, *n));
        let timeouts: Vec<Ident> = timeouts.map(|node| self.flag(Flag::Timeout, node)).collect();
        let all: Vec<Ident> = timers.chain(timeouts.iter().cloned()).collect();
        if !self.has_agenda(whole) {
            return quote! { #(next = next.or(self.state.#all.wish(now));)* };
        }
        quote! {
            if self.state.agenda.is_due(now) {
                let mut wish = ::apex_rt::Next::Input;
                #(wish = wish.or(self.state.#all.wish(now));)*
                let held_back = false #(|| self.state.#timeouts.is_due(now))*;
                self.state.agenda.close(wish, held_back);
            }
            next = next.or(self.state.agenda.wish());
        }
    }

    /// What a step tests besides its own cause: connections are free, and the steps of the reaction are not used up.
    pub fn allows(&self, whole: Whole<'_>, free: &[usize]) -> TokenStream {
        let free =
            (!free.is_empty()).then(|| quote!(&& self.state.dispatcher.holds(&::apex_rt::Bits::of(&[#(#free),*]))));
        let budget = whole.analysis.asynchronous.endless.then(|| quote!(&&!self.state.steps.is_used_up()));
        quote!(#free #budget)
    }

    /// A node was active for as long as its `timeout` says: it triggers the event, with its activity. A node that is
    /// disabled sends nothing; it does so when it is enabled, if it is still active.
    fn expire(&self, whole: Whole<'_>, bits: &Bits, node: NodeId) -> TokenStream {
        let graph = whole.graph;
        let timeout = self.flag(Flag::Timeout, node);
        let free: Vec<usize> =
            whole.analysis.asynchronous.holding_back(graph, whole.links, node).filter_map(|c| bits.free(c)).collect();
        let mut test = self.allows(whole, &free);
        if graph.nodes[node].can_be_disabled() {
            let enabled = self.flag(Flag::Enabled, node);
            test.extend(quote!(&& self.state.#enabled));
        }
        let (clear, open) = (self.clear_events(whole, node), self.open_agenda(whole));
        let trigger = self.trigger(graph, node, Standard::Timeout);
        let pass = self.pass_activity(whole, node, &|end| {
            let standard = graph.port(end).standard;
            let sent = matches!(standard, Some(Standard::Timeout | Standard::Deactivated));
            self.sent_event(whole, end).filter(|_| sent)
        });
        let emit = self.emit(whole, bits, node, false);
        let serve = self.deliver(whole, &whole.links.sends[node]);
        quote! {
            if self.state.#timeout.is_due(now) #test {
                let Self { nodes, state, .. } = self;
                state.#timeout.stop();
                #open
                #clear #trigger #pass #emit #serve
                quiet = false;
            }
        }
    }
}

/// Code that looks at what may have happened, in the order of the program: at timers only if one of them may be due.
struct Raises {
    has_agenda: bool,
    code: TokenStream,
    /// What looks at timers, one after the other.
    timed: TokenStream,
}

impl Raises {
    fn always(&mut self, code: TokenStream) {
        self.flush();
        self.code.extend(code);
    }

    fn timed(&mut self, code: TokenStream) {
        self.timed.extend(code);
    }

    fn flush(&mut self) {
        let timed = std::mem::take(&mut self.timed);
        self.code.extend(match self.has_agenda && !timed.is_empty() {
            true => quote! { if self.state.agenda.is_due(now) { #timed } },
            false => timed,
        });
    }

    fn finish(mut self) -> TokenStream {
        self.flush();
        self.code
    }
}
