//! `react`: which cluster fires and which slot is served, and when.

use super::{
    Flag, Generator,
    activity::Whole,
    state::{Kept, Kind},
    types::ident,
};
use crate::{
    analyse::{Analysis, Delivery, Guard, Links, at_start, ordered},
    graph::{Flow, Graph, NodeId, NodeKind, Standard},
    syntax::tree::PortKind,
};
use proc_macro2::TokenStream;
use quote::{format_ident, quote};
use std::collections::{BTreeMap, BTreeSet};
use syn::Ident;

/// The conditions of the dispatcher, by number: for each dispatched cluster its guards, "enabled", and for each
/// connection to another cluster "holds a token" and "free"; for each asynchronous connection that may stay occupied
/// "free" and, if it leads to an input, "holds a token"; for each event of the program "has room".
pub struct Bits {
    dispatched: Vec<usize>,
    guards: BTreeMap<usize, usize>,
    enabled: BTreeMap<usize, usize>,
    edges: BTreeMap<(usize, usize), usize>,
    free: BTreeMap<usize, usize>,
    tokens: BTreeMap<usize, usize>,
    room: BTreeMap<NodeId, usize>,
    count: usize,
}

impl Bits {
    /// Numbers the conditions of a program.
    pub fn new(graph: &Graph, analysis: &Analysis) -> Self {
        let clusters = &analysis.clusters;
        let is_free = |c: &usize| clusters[*c].is_free(graph, analysis);
        let mut bits = Self {
            dispatched: (0..clusters.len()).filter(|c| clusters[*c].fires && !is_free(c)).collect(),
            guards: BTreeMap::new(),
            enabled: BTreeMap::new(),
            edges: BTreeMap::new(),
            free: BTreeMap::new(),
            tokens: BTreeMap::new(),
            room: BTreeMap::new(),
            count: 0,
        };
        for cluster in bits.dispatched.clone() {
            for &guard in &clusters[cluster].own_guards {
                if !matches!(analysis.guards[guard], Guard::Token(_) | Guard::Events(_)) {
                    let bit = bits.next();
                    bits.guards.insert(guard, bit);
                }
            }
            let bit = bits.next();
            bits.enabled.insert(cluster, bit);
            for &down in &clusters[cluster].downstream {
                let bit = bits.next();
                bits.next();
                bits.edges.insert((cluster, down), bit);
            }
        }
        for (index, c) in graph.connections.iter().enumerate() {
            if analysis.asynchronous.tracked[index] {
                let bit = bits.next();
                bits.free.insert(index, bit);
            }
            if analysis.asynchronous.live[index] && graph.flow(c) == Flow::ToInput {
                let bit = bits.next();
                bits.tokens.insert(index, bit);
            }
        }
        for (id, node) in graph.nodes.iter().enumerate() {
            if matches!(node.kind, NodeKind::Boundary(PortKind::Event)) {
                let bit = bits.next();
                bits.room.insert(id, bit);
            }
        }
        bits
    }

    fn next(&mut self) -> usize {
        self.count += 1;
        self.count - 1
    }

    fn words(&self) -> usize {
        self.count.div_ceil(64)
    }

    /// "free" of an asynchronous connection, if it may stay occupied.
    pub fn free(&self, connection: usize) -> Option<usize> {
        self.free.get(&connection).copied()
    }

    /// "holds a token" of an asynchronous connection to an input.
    pub fn token(&self, connection: usize) -> Option<usize> {
        self.tokens.get(&connection).copied()
    }

    /// The row of a cluster in the table.
    pub fn row(&self, cluster: usize) -> Option<usize> {
        self.dispatched.iter().position(|c| *c == cluster)
    }

    /// The constant with the number of the condition that a graph-level event has room.
    pub fn room_name(node: NodeId) -> Ident {
        format_ident!("ROOM_{node}")
    }

    /// At first every cluster is enabled and every connection free.
    fn initial(&self) -> Vec<usize> {
        let free = self.edges.values().map(|bit| bit + 1);
        self.enabled.values().copied().chain(free).chain(self.free.values().copied()).collect()
    }

    fn rows(&self, graph: &Graph, analysis: &Analysis, links: &Links) -> Vec<TokenStream> {
        let bit_set = |bits: &[usize]| quote!(::apex_rt::Bits::of(&[#(#bits),*]));
        let rows = self.dispatched.iter().map(|&index| {
            let c = &analysis.clusters[index];
            let mut takes: Vec<usize> = c.own_guards.iter().filter_map(|g| self.guards.get(g).copied()).collect();
            takes.push(self.enabled[&index]);
            takes.extend(c.upstream.iter().map(|up| self.edges[&(*up, index)]));
            let mut waits_for = vec![];
            let mut notifies = vec![self.enabled[&index]];
            notifies.extend(c.upstream.iter().map(|up| self.edges[&(*up, index)] + 1));
            for &guard in &c.own_guards {
                match analysis.guards[guard] {
                    Guard::Token(connection) => {
                        takes.push(self.tokens[&connection]);
                        notifies.push(self.free[&connection]);
                    }
                    Guard::Events(node) => {
                        let holding = analysis.asynchronous.holding_back(graph, links, node);
                        waits_for.extend(holding.map(|c| self.free[&c]));
                    }
                    _ => {}
                }
            }
            waits_for.extend(&takes);
            let sends: Vec<usize> = c.downstream.iter().map(|down| self.edges[&(index, *down)]).collect();
            let occupies: Vec<usize> = sends.iter().map(|bit| bit + 1).collect();
            let outputs = c.sends.iter().filter(|c| graph.port(graph.connections[**c].from).kind == PortKind::Output);
            let mut notified_by = occupies.clone();
            notified_by.extend(outputs.filter_map(|c| self.free(*c)));
            let above: Vec<usize> = above(graph, analysis, index).into_iter().filter_map(|c| self.row(c)).collect();
            let (waits_for, takes, sends, occupies) =
                (bit_set(&waits_for), bit_set(&takes), bit_set(&sends), bit_set(&occupies));
            let (notified_by, notifies, enabled) =
                (bit_set(&notified_by), bit_set(&notifies), bit_set(&[self.enabled[&index]]));
            quote! {
                ::apex_rt::Cluster {
                    waits_for: #waits_for,
                    takes: #takes,
                    sends: #sends,
                    occupies: #occupies,
                    notified_by: #notified_by,
                    notifies: #notifies,
                    enabled: #enabled,
                    above: &[#(#above),*],
                }
            }
        });
        rows.collect()
    }

    /// For each token from an event that a cluster needs: the other tokens that it needs.
    fn missing(&self, analysis: &Analysis) -> Vec<TokenStream> {
        let mut missing = vec![];
        for &index in &self.dispatched {
            let c = &analysis.clusters[index];
            let events: Vec<usize> = c
                .own_guards
                .iter()
                .filter_map(|g| if let Guard::Token(c) = analysis.guards[*g] { Some(c) } else { None })
                .collect();
            let edges: Vec<usize> = c.upstream.iter().map(|up| self.edges[&(*up, index)]).collect();
            for &connection in &events {
                let others = events.iter().filter(|c| **c != connection).map(|c| self.tokens[c]);
                let others: Vec<usize> = others.chain(edges.iter().copied()).collect();
                let token = self.tokens[&connection];
                if !others.is_empty() {
                    missing.push(quote! {
                        ::apex_rt::Missing {
                            others: ::apex_rt::Bits::of(&[#(#others),*]),
                            token: #token,
                            connection: #connection,
                        }
                    });
                }
            }
        }
        missing
    }

    /// What must hold for each slot to be served: its node can trigger its events (R5).
    fn needs(&self, graph: &Graph, analysis: &Analysis, links: &Links) -> Vec<Vec<usize>> {
        let needs = |connection: &usize| {
            let node = graph.connections[*connection].to.node;
            let events = analysis.asynchronous.not_yet_taken(graph, links, *connection);
            events.into_iter().filter_map(|c| self.free(c)).chain(self.room.get(&node).copied()).collect()
        };
        analysis.asynchronous.slots.iter().map(needs).collect()
    }
}

/// All clusters from which tokens come to `cluster`; behind each stand those from which its own tokens come.
fn above(graph: &Graph, analysis: &Analysis, cluster: usize) -> Vec<usize> {
    fn visit(graph: &Graph, analysis: &Analysis, cluster: usize, seen: &mut BTreeSet<usize>, order: &mut Vec<usize>) {
        let relayed = analysis.clusters[cluster].own_guards.iter().filter_map(|g| match analysis.guards[*g] {
            Guard::Token(c) if graph.port(graph.connections[c].from).kind == PortKind::Output => {
                Some(analysis.cluster_of[graph.connections[c].from.node])
            }
            _ => None,
        });
        let ups: Vec<usize> = analysis.clusters[cluster].upstream.iter().copied().chain(relayed).collect();
        for up in ups {
            if seen.insert(up) {
                visit(graph, analysis, up, seen, order);
                order.push(up);
            }
        }
    }
    let mut order = vec![];
    visit(graph, analysis, cluster, &mut BTreeSet::new(), &mut order);
    order.reverse();
    order
}

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
            let kinds = slots + bits.dispatched.len();
            field("steps", quote!(::apex_rt::Steps<#kinds>), quote!(::apex_rt::Steps::new()));
        }
        if self.has_exit(whole.graph) {
            field("exit", quote!(::core::option::Option<u8>), quote!(None));
        }
        if self.has_start(whole) {
            field("started", quote!(bool), quote!(false));
        }
        fields
    }

    fn has_exit(&self, graph: &Graph) -> bool {
        graph.nodes.iter().any(|n| matches!(n.kind, NodeKind::Exit(_)))
    }

    fn has_start(&self, whole: Whole<'_>) -> bool {
        let started = |n: &crate::graph::Node| n.starts_active || matches!(n.kind, NodeKind::Start);
        whole.graph.nodes.iter().any(started)
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
        let missing = bits.missing(analysis);
        if !missing.is_empty() {
            let count = missing.len();
            code.extend(quote! { const MISSING: [::apex_rt::Missing<#words>; #count] = [#(#missing),*]; });
        }
        for (node, bit) in &bits.room {
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
            let begin = self.begin(whole, bits);
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

    /// Serves slots until none is ready; says whether there was one.
    fn serve(&self, whole: Whole<'_>, bits: &Bits) -> TokenStream {
        let Whole { graph, analysis, links } = whole;
        let (words, needs) = (bits.words(), bits.needs(graph, analysis, links));
        let count = needs.len();
        let arms = (0..count).map(|slot| {
            let (number, name) = (slot as u16, format_ident!("slot_{slot}"));
            quote! { #number => self.#name(ctx, observer), }
        });
        let ready = if needs.iter().all(Vec::is_empty) {
            quote!(|_| true)
        } else {
            quote!(|slot| self.state.dispatcher.holds(&Self::NEEDS[slot as usize]))
        };
        let needs_table = needs.iter().any(|n| !n.is_empty()).then(|| {
            quote! { const NEEDS: [::apex_rt::Bits<#words>; #count] = [#(::apex_rt::Bits::of(&[#(#needs),*])),*]; }
        });
        let (budget, step) = match analysis.asynchronous.endless {
            true => (
                quote! { if self.state.steps.is_used_up() { break; } },
                quote! { self.state.steps.take(slot as usize); },
            ),
            false => (quote!(), quote!()),
        };
        let exit = self.has_exit(graph).then(|| quote! { if self.state.exit.is_some() { break; } });
        quote! {
            #needs_table
            #[inline]
            fn serve<O: ::apex_rt::Observer>(&mut self, ctx: &::apex_rt::Ctx, observer: &mut O) -> bool {
                let mut any = false;
                loop {
                    #budget
                    let Some(slot) = self.state.queue.next(#ready) else { break; };
                    #step
                    match slot { #(#arms)* _ => {} }
                    any = true;
                    #exit
                }
                any
            }
        }
    }

    /// Serves the slots that tokens on `sends` can come to, one after the other, where that needs no queue.
    pub fn deliver(&self, whole: Whole<'_>, sends: &[usize]) -> TokenStream {
        let asynchronous = &whole.analysis.asynchronous;
        match asynchronous.delivery {
            Delivery::Queued => quote!(),
            Delivery::Single => self.deliver_single(whole, sends),
            Delivery::Ordered => {
                let connections = ordered(whole.graph, whole.links, asynchronous, sends).unwrap_or_default();
                let ends = |c: &usize| {
                    matches!(whole.graph.nodes[whole.graph.connections[*c].to.node].kind, NodeKind::Exit(_))
                };
                let last = connections.iter().position(ends).unwrap_or(connections.len());
                let goes_on = |at: usize| (at > last).then(|| quote!(&&self.state.exit.is_none()));
                connections.iter().enumerate().map(|(at, c)| self.serve_one(whole, *c, goes_on(at))).collect()
            }
        }
    }

    /// Serves the slot at the end of a connection, if a token waits there and `test` allows it.
    fn serve_one(&self, whole: Whole<'_>, connection: usize, test: Option<TokenStream>) -> TokenStream {
        let asynchronous = &whole.analysis.asynchronous;
        let slot = asynchronous.slot(connection);
        let waits = self.waits(whole.graph, whole.graph.connections[connection].from);
        let name = format_ident!("slot_{slot}");
        let step = asynchronous.endless.then(|| quote! { self.state.steps.take(#slot); });
        let budget = step.is_some().then(|| quote!(&&!self.state.steps.is_used_up()));
        quote! { if self.#waits #budget #test { #step self.#name(ctx, observer); } }
    }

    /// Where one token at most is under way, it may go round in a circle.
    fn deliver_single(&self, whole: Whole<'_>, sends: &[usize]) -> TokenStream {
        let (connections, circle) = whole.analysis.asynchronous.following(sends);
        let serves: TokenStream = connections.iter().map(|c| self.serve_one(whole, *c, None)).collect();
        if !circle {
            return serves;
        }
        let waits = connections.iter().map(|c| {
            let waits = self.waits(whole.graph, whole.graph.connections[*c].from);
            quote!(self.#waits)
        });
        let exit = self.has_exit(whole.graph).then(|| quote!(|| self.state.exit.is_some()));
        quote! {
            while (#(#waits)||*) {
                #serves
                if self.state.steps.is_used_up() #exit { break; }
            }
        }
    }

    /// `react_with`.
    pub fn react(&self, whole: Whole<'_>, bits: &Bits) -> TokenStream {
        let Whole { graph, analysis, .. } = whole;
        let queued = analysis.asynchronous.delivery == Delivery::Queued;
        let serves = !analysis.asynchronous.slots.is_empty() && queued;
        let endless = analysis.asynchronous.endless;
        let (raises, wishes) = self.raises(whole, bits);
        let once = analysis.guards.iter().enumerate().filter(|(_, g)| **g == Guard::React).filter_map(|(i, _)| {
            let bit = bits.guards.get(&i)?;
            Some(quote! { self.state.dispatcher.raise(#bit); })
        });
        let has_react =
            analysis.clusters.iter().flat_map(|c| &c.own_guards).any(|g| analysis.guards[*g] == Guard::React);
        let next = if has_react { quote!(::apex_rt::Next::Now) } else { quote!(::apex_rt::Next::Input) };
        let serve = |quiet: bool| match (serves, quiet) {
            (false, _) => quote!(),
            (true, true) => quote! { if !self.state.queue.is_empty() && self.serve(ctx, observer) { quiet = false; } },
            (true, false) => quote! { if !self.state.queue.is_empty() { self.serve(ctx, observer); } },
        };
        let loops = !bits.dispatched.is_empty() || !raises.is_empty();
        let any_stays = !bits.free.is_empty();
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
            let kind = analysis.asynchronous.slots.len() + row;
            let (budget, step) = match endless {
                true => (quote!(!self.state.steps.is_used_up() &&), quote! { self.state.steps.take(#kind); }),
                false => (quote!(), quote!()),
            };
            quote! {
                if #budget self.state.dispatcher.start(&Self::CLUSTERS[#row]) {
                    #step
                    #(self.state.#timers.advance();)*
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
        let (before, inside) = (before.iter().map(|c| &fires[c]), inside.iter().map(|c| &fires[c]));
        let start = self.has_start(whole).then(|| {
            let serve = if queued { serve(false) } else { self.deliver(whole, &at_start(graph, analysis)) };
            quote! { if !::core::mem::replace(&mut self.state.started, true) { self.begin(ctx, observer); #serve } }
        });
        let begin_steps = endless.then(|| {
            // What the reaction before left when its steps were used up.
            let serve = self.deliver(whole, &analysis.asynchronous.slots);
            quote! { self.state.steps.begin(); #serve }
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
        let body = loops.then(|| {
            quote! {
                let mut first = true;
                loop {
                    let mut quiet = true;
                    #raises
                    #serve_first
                    #(#inside)*
                    first = false;
                    #stop
                    #leave
                }
            }
        });
        quote! {
            fn react_with<O: ::apex_rt::Observer>(&mut self, now: ::apex_rt::Time, observer: &mut O) -> ::apex_rt::Next {
                let ctx = &::apex_rt::Ctx::new(now);
                #exit
                #begin_steps
                #start
                #(#once)*
                #(#before)*
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

    /// What clusters wait for, to tell a deadlock.
    pub fn waiting(&self, whole: Whole<'_>, bits: &Bits) -> TokenStream {
        if bits.missing(whole.analysis).is_empty() {
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
        let clusters = bits.dispatched.iter().map(|c| whole.analysis.clusters[*c].nodes.first().copied().unwrap_or(0));
        let nodes = slots.chain(clusters).map(|n| n + self.names.base);
        quote! {
            if self.state.steps.is_used_up() {
                let counts = self.state.steps.counts();
                observer.endless(&[#(#nodes),*], &counts);
                return ::apex_rt::Next::Now;
            }
        }
    }

    /// What is looked at again and again while a program reacts: timers, mailboxes, timeouts; and when it wants to be
    /// called because of them.
    fn raises(&self, whole: Whole<'_>, bits: &Bits) -> (TokenStream, TokenStream) {
        let Whole { graph, analysis, .. } = whole;
        let (mut raises, mut wishes) = (quote!(), quote!());
        for (node, bit) in &bits.room {
            let port = ident(&graph.nodes[*node].name);
            raises.extend(quote! { if !self.events.#port.is_full() { self.state.dispatcher.raise(#bit); } });
        }
        for (index, guard) in analysis.guards.iter().enumerate() {
            let Some(bit) = bits.guards.get(&index) else { continue };
            match guard {
                Guard::Input(node) => {
                    let port = ident(&graph.nodes[*node].name);
                    raises.extend(quote! { if self.inputs.#port.is_full() { self.state.dispatcher.raise(#bit); } });
                }
                Guard::Timer(node) => {
                    let timer = self.timer(*node);
                    raises.extend(quote! { if self.state.#timer.is_due(now) { self.state.dispatcher.raise(#bit); } });
                    wishes.extend(quote! { next = next.or(self.state.#timer.wish(now)); });
                }
                Guard::React | Guard::Token(_) | Guard::Events(_) => {}
            }
        }
        for (id, node) in graph.nodes.iter().enumerate() {
            if matches!(node.kind, NodeKind::Boundary(PortKind::Slot)) && !whole.links.sends[id].is_empty() {
                raises.extend(self.enter(whole, bits, id));
            }
            if node.modifiers.timeout.is_some() && analysis.active.contains(&id) {
                raises.extend(self.expire(whole, bits, id));
                let timeout = self.flag(Flag::Timeout, id);
                wishes.extend(quote! { next = next.or(self.state.#timeout.wish(now)); });
            }
        }
        (raises, wishes)
    }

    /// What a step tests besides its own cause: connections are free, and the steps of the reaction are not used up.
    pub fn allows(&self, whole: Whole<'_>, free: &[usize]) -> TokenStream {
        let free =
            (!free.is_empty()).then(|| quote!(&& self.state.dispatcher.holds(&::apex_rt::Bits::of(&[#(#free),*]))));
        let budget = whole.analysis.asynchronous.endless.then(|| quote!(&&!self.state.steps.is_used_up()));
        quote!(#free #budget)
    }

    /// A node was active for as long as its `timeout` says: it triggers the event, with its activity.
    fn expire(&self, whole: Whole<'_>, bits: &Bits, node: NodeId) -> TokenStream {
        let graph = whole.graph;
        let timeout = self.flag(Flag::Timeout, node);
        let free: Vec<usize> =
            whole.analysis.asynchronous.holding_back(graph, whole.links, node).filter_map(|c| bits.free(c)).collect();
        let test = self.allows(whole, &free);
        let clear = self.clear_events(whole, node);
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
                #clear #trigger #pass #emit #serve
                quiet = false;
            }
        }
    }
}
