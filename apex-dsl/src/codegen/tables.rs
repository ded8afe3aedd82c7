//! Tables of many slots and timeouts, and the code that serves them by number. Only parts with types of their own are
//! code: the calls of slots, and the fields of the tokens of events.

use super::{
    Generator,
    activity::ProgramView,
    stamps,
    types::nanos,
    wiring::{Flag, Port, Slot},
};
use crate::{
    analyse::Delivery,
    graph::{NodeId, PortId, Standard},
};
use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};
use std::collections::BTreeMap;

/// The rows of ports, with their nodes and tokens.
struct Ports<'a> {
    rows: Vec<&'a Port>,
    /// The rows of each node: the first of them, and the end.
    of: BTreeMap<NodeId, (usize, usize)>,
    /// The tokens, by number.
    tokens: Vec<PortId>,
}

impl<'a> Ports<'a> {
    /// The ports of all nodes that have slots or timeouts.
    fn new(generator: &Generator<'_>, view: ProgramView<'a>) -> Self {
        let wiring = view.wiring;
        let nodes = wiring.slots.iter().map(|slot| slot.node).chain(wiring.timeouts.iter().map(|t| t.node));
        let mut ports = Self { rows: vec![], of: BTreeMap::new(), tokens: vec![] };
        for node in nodes {
            if ports.of.contains_key(&node) {
                continue;
            }
            let first = ports.rows.len();
            ports.rows.extend(wiring.of(node).iter().filter(|port| generator.is_sent_event(view, port.end)));
            ports.of.insert(node, (first, ports.rows.len()));
        }
        ports.tokens = ports.rows.iter().map(|port| port.end).collect();
        ports.tokens.sort_unstable();
        ports.tokens.dedup();
        ports
    }

    fn range(&self, node: NodeId) -> TokenStream {
        // Nodes without rows have no events to send.
        let (first, end) = self.of.get(&node).copied().unwrap_or_default();
        let (first, end) = (Literal::usize_unsuffixed(first), Literal::usize_unsuffixed(end));
        quote!(#first, #end)
    }
}

/// Numbers in a list.
fn list(numbers: impl Iterator<Item = usize>) -> TokenStream {
    let numbers = numbers.map(Literal::usize_unsuffixed);
    quote!(&[#(#numbers),*])
}

impl Generator<'_> {
    /// The tables of slots and timeouts, and what serves them.
    pub fn tables(&self, view: ProgramView<'_>) -> TokenStream {
        let ports = Ports::new(self, view);
        let rows: Vec<TokenStream> = ports.rows.iter().map(|port| self.port_row(view, &ports, port)).collect();
        let slots: Vec<TokenStream> = view.wiring.slots.iter().map(|slot| self.slot_row(view, &ports, slot)).collect();
        let (port_count, slot_count) = (rows.len(), slots.len());
        let (token, clear, leave) =
            (self.token_function(view, &ports), self.clear_function(&ports), self.leave(view, &ports));
        let (slot, call, turns) = (self.slot_function(view), self.call_function(view), self.turns(view));
        let expire = self.expire_table(view, &ports);
        quote! {
            const PORTS: [::apex_rt::tables::Port; #port_count] = { use ::apex_rt::tables::Port; [#(#rows),*] };
            const SLOTS: [::apex_rt::tables::Slot; #slot_count] = { use ::apex_rt::tables::Slot; [#(#slots),*] };
            #token #clear #leave #slot #call #turns #expire
        }
    }

    fn port_row(&self, view: ProgramView<'_>, ports: &Ports<'_>, port: &Port) -> TokenStream {
        let Ok(token) = ports.tokens.binary_search(&port.end) else {
            return self.bug(view.graph.nodes[port.end.node].span, "the token of an event is in no table");
        };
        let token = Literal::usize_unsuffixed(token);
        let mut row = quote!(Port::new(#token));
        let mut add = |method: &str, lists: &[TokenStream]| {
            let method = format_ident!("{method}");
            row.extend(quote!(.#method(#(#lists),*)));
        };
        if !port.sends.is_empty() {
            let queued = list(port.sends.iter().filter_map(|send| send.queued));
            add("queues", &[queued, list(port.sends.iter().filter_map(|send| send.occupies))]);
        }
        if port.sends.iter().any(|send| send.raises.is_some()) {
            add("raises", &[list(port.sends.iter().filter_map(|send| send.raises))]);
        }
        let stamps: Vec<usize> = port.sends.iter().filter_map(|send| stamps::number(view, send.connection)).collect();
        if !stamps.is_empty() {
            add("stamps", &[list(stamps.into_iter())]);
        }
        let number = |flag: &Flag| match *flag {
            Flag::Active(node) | Flag::Gains(node) | Flag::Loses(node) | Flag::Enabled(node) => self.index(node),
            Flag::Carries(slot) => slot,
        };
        if !port.takes_away.is_empty() {
            add("takes_away", &[list(port.takes_away.iter().map(number))]);
        }
        if let Some(along) = &port.passes {
            let (carries, gains): (Vec<&Flag>, Vec<&Flag>) =
                along.iter().partition(|flag| matches!(flag, Flag::Carries(_)));
            add("passes", &[list(carries.into_iter().map(number)), list(gains.into_iter().map(number))]);
        }
        row
    }

    fn slot_row(&self, view: ProgramView<'_>, ports: &Ports<'_>, slot: &Slot) -> TokenStream {
        let (node, range) = (Literal::usize_unsuffixed(self.index(slot.node)), ports.range(slot.node));
        let needs = list(slot.needs.iter().copied());
        let mut row = quote!(Slot::new(#node, #range, #needs));
        let mut add = |method: &str, number: Option<usize>| {
            if let Some(number) = number {
                let (method, number) = (format_ident!("{method}"), Literal::usize_unsuffixed(number));
                row.extend(quote!(.#method(#number)));
            }
        };
        add("on", self.connection(slot.connection));
        add("frees", slot.frees);
        add("settles", slot.settles);
        add("stamp", stamps::number(view, slot.connection));
        row.extend(match slot.carries_to(view.graph) {
            super::activity::Carries::Nothing => quote!(),
            super::activity::Carries::Always => quote!(.always_activates()),
            super::activity::Carries::Sometimes => quote!(.activates()),
            super::activity::Carries::Away => quote!(.deactivates()),
        });
        row
    }

    /// The function that returns the field of an event's token.
    fn token_function(&self, view: ProgramView<'_>, ports: &Ports<'_>) -> TokenStream {
        let state = self.item(view.graph, "State");
        let Some((last, tokens)) = ports.tokens.split_last() else { return quote!() };
        let arms = tokens.iter().enumerate().map(|(number, end)| {
            let (number, name) = (Literal::usize_unsuffixed(number), self.name(*end));
            quote! { #number => &mut state.#name, }
        });
        let last = self.name(*last);
        quote! {
            /// The token of an event.
            fn token(state: &mut #state, number: usize) -> &mut dyn ::apex_rt::tables::Token {
                match number { #(#arms)* _ => &mut state.#last, }
            }
        }
    }

    /// The function that empties the events of a node before it may trigger them.
    fn clear_function(&self, ports: &Ports<'_>) -> TokenStream {
        let clear = (!ports.tokens.is_empty()).then(|| {
            quote! { for port in &Self::PORTS[first..end] { Self::token(&mut self.state, port.token).clear(); } }
        });
        quote! { fn clear(&mut self, (first, end): (usize, usize)) { #clear } }
    }

    /// The function that sends what a node has triggered, with its activity.
    fn leave(&self, view: ProgramView<'_>, ports: &Ports<'_>) -> TokenStream {
        if ports.tokens.is_empty() {
            return quote! {
                fn leave<O: ::apex_rt::Observer>(&mut self, node: usize, ports: (usize, usize), ctx: &::apex_rt::Ctx, observer: &mut O) {}
            };
        }
        let any = |has: &dyn Fn(&&&Port) -> bool| ports.rows.iter().any(|port| has(&port));
        let takes_away = any(&|port| !port.takes_away.is_empty()).then(|| {
            quote! { for other in port.takes_away { self.state.loses.set(*other as usize, true); } }
        });
        let passes = any(&|port| port.passes.is_some()).then(|| {
            let along = |flag: &dyn Fn(&Flag) -> bool| any(&|port| port.passes.iter().flatten().any(flag));
            let carries = along(&|flag| matches!(flag, Flag::Carries(_)))
                .then(|| quote! { for slot in port.carries { self.state.carries.set(*slot as usize, true); } });
            let gains = along(&|flag| matches!(flag, Flag::Gains(_)))
                .then(|| quote! { for other in port.gains { self.state.gains.set(*other as usize, true); } });
            let check = self.check_claims();
            quote! {
                if port.passes && self.deactivate(node, ctx, observer) {
                    #carries
                    #gains
                    let Self { state, .. } = self;
                    #check
                }
            }
        });
        let has_bits = view.wiring.bits.words() > 0;
        let queue = (view.analysis.asynchronous.delivery == Delivery::Queued && !view.wiring.slots.is_empty())
            .then(|| quote! { for slot in port.queued { self.state.queue.push(*slot); } });
        let bits = has_bits.then(|| {
            quote! {
                for bit in port.raises { self.state.dispatcher.raise(*bit as usize); }
                for bit in port.occupies { self.state.dispatcher.clear(*bit as usize); }
            }
        });
        let stamped = any(&|port| port.sends.iter().any(|send| stamps::number(view, send.connection).is_some()));
        let stamps =
            stamped.then(|| quote! { for stamp in port.stamps { self.state.stamps[*stamp as usize] = ctx.stamp(); } });
        let observed = self.observed_function(view, ports);
        let observe = observed.is_some().then(|| quote! { self.observed(port.token, observer); });
        quote! {
            /// Sends the events that a node has triggered. Its activity goes with the first over an active connection.
            fn leave<O: ::apex_rt::Observer>(
                &mut self,
                node: usize,
                (first, end): (usize, usize),
                ctx: &::apex_rt::Ctx,
                observer: &mut O,
            ) {
                for port in &Self::PORTS[first..end] {
                    if Self::token(&mut self.state, port.token).is_there() { #takes_away #passes }
                }
                for port in &Self::PORTS[first..end] {
                    if Self::token(&mut self.state, port.token).is_there() { #observe #queue #bits #stamps }
                }
            }
            #observed
        }
    }

    /// The function that shows the observer an event.
    fn observed_function(&self, view: ProgramView<'_>, ports: &Ports<'_>) -> Option<TokenStream> {
        let arms: Vec<TokenStream> = ports
            .tokens
            .iter()
            .enumerate()
            .filter_map(|(number, end)| Some((number, self.observed_event(view.graph, *end)?)))
            .map(|(number, code)| quote! { #number => { #code } })
            .collect();
        let function = quote! {
            /// Shows the observer an event that is sent.
            fn observed<O: ::apex_rt::Observer>(&mut self, token: usize, observer: &mut O) {
                let Self { state, .. } = self;
                match token { #(#arms)* _ => {} }
            }
        };
        (!arms.is_empty()).then_some(function)
    }

    /// The function that takes the token for a slot and does all that follows at once.
    fn slot_function(&self, view: ProgramView<'_>) -> TokenStream {
        let slots = &view.wiring.slots;
        if slots.is_empty() {
            return quote!();
        }
        let any = |has: &dyn Fn(&Slot) -> bool| slots.iter().any(has);
        let since = any(&|slot| stamps::number(view, slot.connection).is_some()).then(|| {
            quote! {
                let since = row.stamp.map_or(*ctx, |stamp| ctx.since(self.state.stamps[stamp]));
                let ctx = &since;
            }
        });
        let frees = any(&|slot| slot.frees.is_some())
            .then(|| quote! { if let Some(bit) = row.frees { self.state.dispatcher.raise(bit); } });
        let settles = any(&|slot| slot.settles.is_some()).then(|| {
            quote! { if let Some(cluster) = row.settles { self.state.dispatcher.settle(&Self::CLUSTERS, cluster); } }
        });
        let carries = |what| any(&|slot| slot.carries_to(view.graph) == what);
        use super::activity::Carries;
        let check = self.check_claims();
        let check = (!check.is_empty()).then(|| quote! { let Self { state, .. } = self; #check });
        let activates = [
            carries(Carries::Always).then(|| {
                quote! { ::apex_rt::tables::Carries::Always => { self.activate(row.node, ctx, observer); #check } }
            }),
            carries(Carries::Sometimes).then(|| {
                quote! {
                    ::apex_rt::tables::Carries::Sometimes => {
                        if self.state.carries.take(slot) { self.activate(row.node, ctx, observer); }
                        #check
                    }
                }
            }),
            carries(Carries::Away).then(|| {
                quote! { ::apex_rt::tables::Carries::Away => { self.deactivate(row.node, ctx, observer); #check } }
            }),
        ];
        let activity = activates.iter().any(Option::is_some).then(|| {
            let activates = activates.iter().flatten();
            quote! { match row.carries { #(#activates)* _ => {} } }
        });
        quote! {
            /// A slot takes the token that waits for it.
            fn slot<O: ::apex_rt::Observer>(&mut self, slot: usize, ctx: &::apex_rt::Ctx, observer: &mut O) {
                let row = &Self::SLOTS[slot];
                #since
                if let Some(connection) = row.connection { observer.handled(connection); }
                #frees
                self.clear(row.ports);
                #activity
                self.call(slot, ctx, observer);
                observer.finished(row.node);
                self.leave(row.node, row.ports, ctx, observer);
                #settles
            }
        }
    }

    /// The function that calls the method of a slot.
    fn call_function(&self, view: ProgramView<'_>) -> TokenStream {
        let slots = view.wiring.slots.iter().enumerate();
        let arms = slots.map(|(number, slot)| (number, self.call_slot(view, slot.connection)));
        let arms = arms.filter(|(_, call)| !call.is_empty()).map(|(number, call)| {
            let number = Literal::usize_unsuffixed(number);
            quote! { #number => { #call } }
        });
        quote! {
            fn call<O: ::apex_rt::Observer>(&mut self, slot: usize, ctx: &::apex_rt::Ctx, observer: &mut O) {
                let Self { nodes, state, inputs, outputs, events } = self;
                match slot { #(#arms)* _ => {} }
            }
        }
    }

    /// The functions by which a node becomes active, and ceases to be.
    fn turns(&self, view: ProgramView<'_>) -> TokenStream {
        let active = view.analysis.active.iter().copied().filter(|node| !view.graph.nodes[*node].is_delay());
        let active: Vec<NodeId> = active.collect();
        if active.is_empty() {
            return quote!();
        }
        let arms = |becomes: bool| -> TokenStream {
            let code = active.iter().map(|node| (self.index(*node), self.turn_effects(view, *node, becomes)));
            let arms = code.filter(|(_, code)| !code.is_empty()).map(|(number, code)| {
                let number = Literal::usize_unsuffixed(number);
                quote! { #number => { #code } }
            });
            let arms: Vec<TokenStream> = arms.collect();
            if arms.is_empty() {
                return quote!();
            }
            quote! {
                let Self { nodes, state, .. } = self;
                match node { #(#arms)* _ => {} }
            }
        };
        let unseen: Vec<Literal> = active
            .iter()
            .filter(|node| !super::activity::is_observed(view.graph, **node))
            .map(|node| Literal::usize_unsuffixed(self.index(*node)))
            .collect();
        let observe = |value: bool| match unseen.is_empty() {
            true => quote! { observer.activity(node, #value); },
            false => quote! { if !matches!(node, #(#unseen)|*) { observer.activity(node, #value); } },
        };
        let (on, off) = (observe(true), observe(false));
        let open = self.open_agenda(view).map(|open| quote! { let Self { state, .. } = self; #open });
        let timeouts = !view.wiring.timeouts.is_empty();
        let start = timeouts.then(|| {
            quote! {
                if let Ok(timeout) = Self::TIMEOUTS.binary_search_by_key(&node, |timeout| timeout.node) {
                    self.state.timeouts[timeout].start(ctx.now(), Self::TIMEOUTS[timeout].after);
                    #open
                }
            }
        });
        let stop = timeouts.then(|| {
            quote! {
                if let Ok(timeout) = Self::TIMEOUTS.binary_search_by_key(&node, |timeout| timeout.node) {
                    self.state.timeouts[timeout].stop();
                    #open
                }
            }
        });
        let (begins, ends) = (arms(true), arms(false));
        quote! {
            /// A node becomes active, unless it is already.
            fn activate<O: ::apex_rt::Observer>(&mut self, node: usize, ctx: &::apex_rt::Ctx, observer: &mut O) {
                if self.state.active.has(node) { return; }
                self.state.active.set(node, true);
                #on #start #begins
            }
            /// A node is no longer active. Returns `true` if it was.
            fn deactivate<O: ::apex_rt::Observer>(&mut self, node: usize, ctx: &::apex_rt::Ctx, observer: &mut O) -> bool {
                if !self.state.active.take(node) { return false; }
                #off #stop #ends
                true
            }
        }
    }

    /// The table of timeouts, and the function that triggers their events.
    fn expire_table(&self, view: ProgramView<'_>, ports: &Ports<'_>) -> TokenStream {
        let timeouts = &view.wiring.timeouts;
        if timeouts.is_empty() {
            return quote!();
        }
        let rows = timeouts.iter().map(|timeout| {
            let (node, range) = (Literal::usize_unsuffixed(self.index(timeout.node)), ports.range(timeout.node));
            let (after, gated) = (nanos(timeout.after), view.graph.nodes[timeout.node].can_be_disabled());
            let needs = list(timeout.needs.iter().copied());
            quote!(Timeout::new(#node, #range, #after, #needs, #gated))
        });
        let count = timeouts.len();
        let arms = timeouts
            .iter()
            .enumerate()
            .map(|(number, timeout)| (number, self.trigger(view.graph, timeout.node, Standard::Timeout)));
        let arms = arms.filter(|(_, code)| !code.is_empty()).map(|(number, code)| {
            let number = Literal::usize_unsuffixed(number);
            quote! { #number => { #code } }
        });
        let open = self.open_agenda(view);
        quote! {
            const TIMEOUTS: [::apex_rt::tables::Timeout; #count] = { use ::apex_rt::tables::Timeout; [#(#rows),*] };
            /// The `timeout` of a node is triggered.
            fn expire<O: ::apex_rt::Observer>(&mut self, timeout: usize, ctx: &::apex_rt::Ctx, observer: &mut O) {
                let row = &Self::TIMEOUTS[timeout];
                self.clear(row.ports);
                let Self { state, .. } = self;
                state.timeouts[timeout].stop();
                #open
                match timeout { #(#arms)* _ => {} }
                self.leave(row.node, row.ports, ctx, observer);
            }
        }
    }

    /// The first timeout that is due expires.
    pub fn first_expires(&self, view: ProgramView<'_>) -> TokenStream {
        let timeouts = &view.wiring.timeouts;
        if timeouts.is_empty() {
            return quote!();
        }
        let test = self.allows(view, &[]);
        let free = (view.wiring.bits.words() > 0).then(|| quote!(&&self.state.dispatcher.holds(&row.needs)));
        let gated = timeouts
            .iter()
            .any(|timeout| view.graph.nodes[timeout.node].can_be_disabled())
            .then(|| quote!(&&(!row.gated || self.state.enabled.has(row.node))));
        quote! {
            for (timeout, row) in Self::TIMEOUTS.iter().enumerate() {
                if quiet && self.state.timeouts[timeout].is_due(at) #free #gated #test {
                    self.expire(timeout, ctx, observer);
                    quiet = false;
                }
            }
        }
    }
}
