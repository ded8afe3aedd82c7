//! Slots: one function for each connection to one, and what is emitted when a firing ends.

use super::{
    Generator,
    activity::ProgramView,
    clusters::inlined,
    dispatch::free_to_send,
    numbered::{Arm, Numbered},
    types::ident,
};
use crate::{
    analyse::Delivery,
    catalog::{ArgSig, Signature},
    graph::{ConnectionId, Flow, Graph, Library, NodeId, NodeKind, PortId, Standard},
    machine::Move,
    syntax::tree::PortKind,
    program::{Carries, is_buffer, Flag, Slot},
};
use proc_macro2::TokenStream;
use quote::{quote, quote_spanned};
use syn::Ident;

/// Returns `true` if a slot removes its token. Without a queue, the last slot that a token reaches does.
fn takes(view: ProgramView<'_>, connection: ConnectionId) -> bool {
    let from = view.graph.connections[connection].from;
    let same = |c: &&ConnectionId| view.graph.connections[**c].from == from;
    view.analysis.asynchronous.delivery != Delivery::Queued
        && view.links.sends[from.node].iter().rfind(same) == Some(&connection)
}

impl Generator<'_> {
    /// The tokens of a node's asynchronous connections are on their way, as far as there are any: those for slots
    /// are queued, those for inputs lie there. A slot sends on events only.
    pub fn emit(&self, view: ProgramView<'_>, node: NodeId, by_process: bool) -> TokenStream {
        self.emit_from(view, node, &|end| by_process || view.graph.port(end).kind == PortKind::Event)
    }

    /// The same for the events that activity came, or went.
    pub fn tell(&self, view: ProgramView<'_>, node: NodeId) -> TokenStream {
        self.emit_from(view, node, &|end| view.graph.port(end).tells_of_activity())
    }

    /// The tokens of some ports of a node are on their way.
    pub fn emit_from(&self, view: ProgramView<'_>, node: NodeId, wanted: &dyn Fn(PortId) -> bool) -> TokenStream {
        let rows = view.wiring.of(node).iter().filter(|port| wanted(port.end) && !port.sends.is_empty());
        rows.map(|port| self.send(view, port)).collect()
    }

    /// A step of a node ends: its activity goes with the first of its `events` that were triggered, and all of them are
    /// on their way.
    pub fn leave(&self, view: ProgramView<'_>, node: NodeId, events: &dyn Fn(PortId) -> bool) -> TokenStream {
        let pass = self.pass_activity(view, node, &|end| events(end).then(|| self.kept(end)));
        let send = self.emit_from(view, node, events);
        let mut rows = view.wiring.of(node).iter().filter(|port| events(port.end));
        let (Some(port), None) = (rows.next(), rows.next()) else { return quote!(#pass #send) };
        let follows = !self.turn_effects(view, node, false).is_empty() || self.lower(view).checks_claims();
        let is_observed = self.observed_event(view.graph, port.end).is_some();
        if pass.is_empty() || send.is_empty() || follows || is_observed || view.graph.nodes[node].is_delay() {
            return quote!(#pass #send);
        }
        let (name, token) = (ident(&view.labels.ports[&port.end]), self.kept(port.end));
        quote! { core.leave(&Self::#name, #token, ctx, observer); }
    }

    /// Expression that is `true` if the state of the program holds a token.
    pub fn waits(&self, graph: &Graph, end: PortId) -> TokenStream {
        let name = self.name(end);
        match is_buffer(graph, self.catalog, end) {
            true => quote!(state.#name.get().is_some()),
            false => quote!(state.#name.is_some()),
        }
    }

    /// Reference to a token in the state of the program, for the functions of the runtime.
    pub fn kept(&self, end: PortId) -> TokenStream {
        let name = self.name(end);
        quote!(&state.#name)
    }

    /// Events of a node that are connected are empty before it may trigger them.
    pub fn clear_events(&self, view: ProgramView<'_>, node: NodeId) -> TokenStream {
        self.clear(view, node, &|_| true)
    }

    /// The events `activated` and `deactivated` of a node are empty before its activity changes.
    pub fn clear_told(&self, view: ProgramView<'_>, node: NodeId) -> TokenStream {
        self.clear(view, node, &|end| view.graph.port(end).tells_of_activity())
    }

    /// Some events of a node are empty before it may trigger them.
    pub fn clear(&self, view: ProgramView<'_>, node: NodeId, wanted: &dyn Fn(PortId) -> bool) -> TokenStream {
        let ends = (0..view.graph.nodes[node].ports.len()).map(|port| PortId { node, port });
        let names = ends.filter(|end| wanted(*end) && self.is_sent_event(view, *end)).map(|end| self.name(end));
        quote! { #(state.#names = None;)* }
    }

    /// Returns `true` if an event is connected.
    pub fn is_sent_event(&self, view: ProgramView<'_>, end: PortId) -> bool {
        view.graph.port(end).kind == PortKind::Event
            && view.links.sends[end.node].iter().any(|c| view.graph.connections[*c].from == end)
    }

    /// Expression that is `true` if a connected event was triggered.
    pub fn sent_event(&self, view: ProgramView<'_>, end: PortId) -> Option<TokenStream> {
        self.is_sent_event(view, end).then(|| self.waits(view.graph, end))
    }

    /// An event as an argument.
    pub fn event(&self, view: ProgramView<'_>, end: PortId) -> TokenStream {
        if self.is_sent_event(view, end) {
            let name = self.name(end);
            quote!(::apex_rt::event(&mut state.#name))
        } else {
            quote!(::apex_rt::Event::unconnected())
        }
    }

    /// Functions for the connections to slots: by number where a queue has the numbers, else one for each.
    pub fn slot_functions(&self, view: ProgramView<'_>) -> TokenStream {
        if view.analysis.asynchronous.delivery == Delivery::Queued {
            return self.slots(view).functions();
        }
        let slots = &view.wiring.slots;
        let inline = inlined(slots.len());
        let functions = slots.iter().enumerate().map(|(number, slot)| {
            let (name, docs) = (ident(&view.labels.slots[number]), self.docs_of_connection(view.graph, slot.connection));
            let code = self.slot(view, number, slot);
            let code = match code.is_empty() {
                true => quote! { core.only_enter(&Self::SLOTS[#number], ctx, observer); },
                false => code,
            };
            quote! {
                #[doc = #docs]
                #inline
                fn #name<O: ::apex_rt::Observer>(&mut self, ctx: &::apex_rt::Ctx, observer: &mut O) {
                    let Self { nodes, state, core, inputs, outputs, events } = self;
                    #code
                }
            }
        });
        functions.collect()
    }

    /// The slots by number.
    pub fn slots(&self, view: ProgramView<'_>) -> Numbered {
        let slots = view.wiring.slots.iter().enumerate();
        let arms = slots.map(|(number, slot)| {
            let docs = self.docs_of_connection(view.graph, slot.connection);
            Arm { number, docs, code: self.slot(view, number, slot) }
        });
        let arms = arms.filter(|arm| !arm.code.is_empty()).collect();
        let rest = quote!(core.only_enter(&Self::SLOTS[slot as usize], ctx, observer));
        Numbered { name: "slot", count: view.wiring.slots.len(), arms, rest }
    }

    /// Documentation of what a connection leads to: ``` `stopped => waiting.enable`, mission.afg:27 ```.
    fn docs_of_connection(&self, graph: &Graph, connection: ConnectionId) -> String {
        format!(" `{}`, {}.", graph.connection_text(connection), self.line(graph.connections[connection].span))
    }

    /// Code of a slot; none if it calls nothing.
    fn slot(&self, view: ProgramView<'_>, number: usize, slot: &Slot) -> TokenStream {
        let Slot { connection, node, .. } = *slot;
        let brings = slot.carries_to(view.graph);
        let turns = brings != Carries::Nothing;
        let effects = if turns { self.turn_effects(view, node, brings != Carries::Away) } else { quote!() };
        let turned = if effects.is_empty() { quote!(_) } else { quote!(turned) };
        let effects = (!effects.is_empty()).then(|| quote! { if *turned { #effects } });
        let check = turns.then(|| self.check_claims(view));
        let settle = slot.settles.map(|row| quote! { core.dispatcher.settle(Self::CLUSTERS, #row); });
        let call = self.call_slot(view, connection);
        let from = view.graph.connections[connection].from;
        let call = if takes(view, connection) { self.taken(view.graph, from, call) } else { call };
        let triggers = |end: PortId| match view.graph.port(end).tells_of_activity() {
            true => turns,
            false => self.may_trigger(view, connection, end),
        };
        let clear = self.clear(view, node, &triggers);
        let leave = self.leave(view, node, &|end| self.is_sent_event(view, end) && triggers(end));
        let (before, after) = (quote!(#clear #effects #check #call), quote!(#leave #settle));
        if before.is_empty() && after.is_empty() {
            return quote!();
        }
        let index = self.index(node);
        quote! {
            let (ctx, #turned) = &core.enter(&Self::SLOTS[#number], ctx, observer);
            #before
            observer.finished(#index);
            #after
        }
    }

    /// Returns `true` if the call of a slot may trigger an event: one that is an argument, or tells how the call went.
    fn may_trigger(&self, view: ProgramView<'_>, connection: ConnectionId, event: PortId) -> bool {
        let to = view.graph.connections[connection].to;
        let NodeKind::Library(library) = &view.graph.nodes[to.node].kind else { return true };
        let signature = &self.catalog.signatures[library.signature];
        match signature.slots.iter().find(|slot| slot.port == to.port) {
            Some(slot) => {
                let is_argument = slot.args.iter().any(|arg| matches!(arg, ArgSig::Port(port) if *port == event.port));
                is_argument || view.graph.port(event).standard.is_some()
            }
            // `enable` and `disable` call nothing.
            None => false,
        }
    }

    /// A slot takes its token away.
    fn taken(&self, graph: &Graph, from: PortId, call: TokenStream) -> TokenStream {
        let name = self.name(from);
        if is_buffer(graph, self.catalog, from) {
            quote! { #call state.#name.clear(); }
        } else {
            quote! { let #name = state.#name.take(); #call }
        }
    }

    /// The call of a slot's method, or what the slot of a built-in node does.
    pub fn call_slot(&self, view: ProgramView<'_>, connection: ConnectionId) -> TokenStream {
        let graph = view.graph;
        let c = &graph.connections[connection];
        let node = c.to.node;
        match (&graph.nodes[node].kind, graph.port(c.to).standard) {
            (_, Some(Standard::Disable)) => self.set(Flag::Enabled(node), false),
            (_, Some(Standard::Enable)) if graph.nodes[node].can_be_disabled() => {
                let (is_enabled, watch) = (self.is_set(Flag::Enabled(node)), self.watch_silence(view, node));
                let enable = self.set(Flag::Enabled(node), true);
                // It was told to be silent: that is over now.
                if watch.is_empty() {
                    enable
                } else {
                    quote! { if !#is_enabled { #watch } #enable }
                }
            }
            (NodeKind::Library(library), _) => self.call_method(view, connection, library),
            (NodeKind::Probe, _) => {
                let from = view.graph.connections[connection].from;
                self.see(view.graph, node, from, &self.token(view, connection))
            }
            (NodeKind::Exit(code), _) => quote! { state.exit = Some(#code); },
            (NodeKind::Reset, _) => quote! { Self::reset(nodes, state, core, ctx, observer); },
            (NodeKind::Interrupt(_), _) => {
                let name = self.interrupt_function(view, c.to);
                let call = quote! { Self::#name(nodes, state, core, ctx, observer); };
                // Over `=>`, only activity is given back.
                match c.active && Standard::Resume.is_of_interrupt(c.to.port) {
                    true if !view.analysis.active.contains(&node) => quote!(),
                    true => {
                        let brought = self.is_set(Flag::Active(node));
                        quote! { if #brought { #call } }
                    }
                    false => call,
                }
            }
            (NodeKind::Boundary(_), _) => {
                let (port, token) = (ident(&graph.nodes[node].name), self.token(view, connection));
                let room = view.wiring.bits.room().get(&node).map(|bit| quote! { core.dispatcher.clear(#bit); });
                let copy = self.clone(graph, graph.connections[connection].from, &quote!(token));
                quote! {
                    if let Some(token) = #token { let _ = events.#port.put(#copy); }
                    #room
                }
            }
            _ => quote!(),
        }
    }

    /// The token of a connection, where it lies: `Option<&T>`.
    fn token(&self, view: ProgramView<'_>, connection: ConnectionId) -> TokenStream {
        let from = view.graph.connections[connection].from;
        let name = self.name(from);
        match is_buffer(view.graph, self.catalog, from) {
            true => quote!(state.#name.get()),
            false if takes(view, connection) => quote!(#name.as_ref()),
            false => quote!(state.#name.as_ref()),
        }
    }

    fn call_method(&self, view: ProgramView<'_>, connection: ConnectionId, library: &Library) -> TokenStream {
        let graph = view.graph;
        let c = &graph.connections[connection];
        let (node, signature) = (c.to.node, &self.catalog.signatures[library.signature]);
        let Some(slot) = signature.slots.iter().find(|s| s.port == c.to.port) else {
            // `enable` of a node that nothing disables is called only for the activity that it carries.
            return match graph.port(c.to).standard {
                Some(_) => quote!(),
                None => self.bug(c.span, "the slot has no method"),
            };
        };
        let mut takes = false;
        let args: Vec<TokenStream> = slot
            .args
            .iter()
            .map(|arg| match *arg {
                ArgSig::Port(port) if port == slot.port => {
                    takes = true;
                    self.judged_slot(graph, connection, library, signature)
                }
                ArgSig::Port(port) => self.event(view, PortId { node, port }),
                _ => self.context(view, node),
            })
            .collect();
        let (place, method) = (self.node_place(graph, node), ident(&slot.method));
        let call = quote!(#place.#method(#(#args),*));
        let call = self.contained(graph, node, library, call, slot.fallible);
        let late = self.check_late(graph, node);
        let call = if takes {
            let token = self.token(view, connection);
            quote! { if let Some(token) = #token { #call; } #late }
        } else {
            quote! { #call; #late }
        };
        let call = self.recorded_slot(graph, node, self.states_told(graph, node, call));
        if graph.nodes[node].can_be_disabled() {
            let is_enabled = self.is_set(Flag::Enabled(node));
            quote! { if #is_enabled { #call } }
        } else {
            call
        }
    }

    /// The context for a node, which knows whether it is active.
    pub fn context(&self, view: ProgramView<'_>, node: NodeId) -> TokenStream {
        if view.analysis.active.contains(&node) {
            let is_active = self.is_active_now(view, node);
            quote!(&ctx.of_node(#is_active))
        } else {
            quote!(ctx)
        }
    }

    /// A call whose failure is reported: its value as an `Option`, or the call itself where nothing can fail.
    pub fn contained(
        &self,
        graph: &Graph,
        node: NodeId,
        library: &Library,
        call: TokenStream,
        fallible: bool,
    ) -> TokenStream {
        let index = self.index(node);
        let n = &graph.nodes[node];
        if !n.is_contained() {
            return if fallible { quote!(::apex_rt::sent(#call, #index, observer)) } else { call };
        }
        let how = if fallible { quote!(contain_fallible) } else { quote!(contain) };
        let event = n.standard(Standard::Failed).map(|port| {
            let name = self.name(PortId { node, port });
            quote! { state.#name = Some(failure); }
        });
        let restart = n.modifiers.restart.then(|| self.remake(graph, node, library));
        quote! {
            match ::apex_rt::#how(|| #call) {
                Ok(value) => Some(value),
                Err(failure) => { observer.failed(#index, &failure); #event #restart None }
            }
        }
    }

    /// Lets rustc judge a connection to a slot whose types the scan could not compare.
    fn judged_slot(
        &self,
        graph: &Graph,
        connection: ConnectionId,
        library: &Library,
        signature: &Signature,
    ) -> TokenStream {
        let Some(link) = self.link(graph, connection) else { return quote!(token) };
        let c = &graph.connections[connection];
        let (node, index) = (self.node_type(graph, library), signature.ports[c.to.port].index);
        let span = (self.place)(c.span);
        quote_spanned!(span=> #link::<<#node as ::apex_rt::Slot<#index>>::Token>::pass(token))
    }

    /// Takes the token of a slot of the program, if there is one and it can go on.
    pub fn enter(&self, view: ProgramView<'_>, node: NodeId) -> TokenStream {
        let (port, test, goes_on) = self.entering(view, node);
        quote! { if self.inputs.#port.is_full() #test { #goes_on } }
    }

    /// Takes the tokens of several slots of the program, in the order in which they were put in.
    pub fn enter_in_order(&self, view: ProgramView<'_>, nodes: &[NodeId]) -> TokenStream {
        let (mut arrivals, mut arms) = (vec![], vec![]);
        for (place, node) in nodes.iter().enumerate() {
            let (port, test, goes_on) = self.entering(view, *node);
            arrivals.push(quote!(self.inputs.#port.arrival().filter(|_| true #test)));
            arms.push(quote! { #place => { #goes_on } });
        }
        quote! {
            while let Some(slot) = ::apex_rt::first_arrival(&[#(#arrivals),*]) {
                match slot { #(#arms)* _ => {} }
            }
        }
    }

    /// The port of a slot of the program, the conditions under which its token can go on, and the code that lets it.
    fn entering(&self, view: ProgramView<'_>, node: NodeId) -> (Ident, TokenStream, TokenStream) {
        let graph = view.graph;
        let (name, port) = (self.name(PortId { node, port: 0 }), ident(&graph.nodes[node].name));
        let test = self.allows(view, &free_to_send(view, node));
        let emit = self.emit(view, node, false);
        let serve = self.deliver(view, &view.links.sends[node]);
        let goes_on = quote! {
            let Self { state, core, inputs, .. } = self;
            state.#name = inputs.#port.take();
            #emit
            #serve
            quiet = false;
        };
        (port, test, goes_on)
    }

    /// `start`: the nodes that are active from the beginning, and the tokens of its events.
    pub fn begin(&self, view: ProgramView<'_>) -> TokenStream {
        let graph = view.graph;
        let mut code = quote!();
        for (node, n) in graph.nodes.iter_enumerated() {
            if n.starts_active && view.analysis.active.contains(&node) {
                let (activate, tell) = (self.activate(view, node), self.tell(view, node));
                code.extend(quote! { #activate #tell });
            }
            if matches!(n.kind, NodeKind::Start) {
                let end = PortId { node, port: 0 };
                if !self.is_sent_event(view, end) {
                    continue;
                }
                let (name, emit) = (self.name(end), self.emit(view, node, false));
                let sent = graph.connections.iter_enumerated().filter(|(_, c)| c.from == end);
                let gains = sent.filter_map(|(i, c)| {
                    match (graph.flow(c) == Flow::ToSlot, self.lower(view).carries(i)) {
                        (true, Carries::Sometimes) => {
                            Some(self.set(Flag::Carries(view.analysis.asynchronous.slot(i)), true))
                        }
                        (false, Carries::Always | Carries::Sometimes) => Some(self.set(Flag::Gains(c.to.node), true)),
                        _ => None,
                    }
                });
                code.extend(quote! { state.#name = Some(()); #(#gains)* #emit });
            }
        }
        code.extend(self.check_claims(view));
        code
    }

    /// Code that runs once, before the first reaction.
    pub fn first(&self, view: ProgramView<'_>) -> TokenStream {
        let watches = view.graph.nodes.ids().map(|node| self.watch_silence(view, node));
        let (initial, begin) = (self.initial_states(), self.begin(view));
        quote! { #(#watches)* #initial #begin }
    }

    /// `reset`: nothing is active, no token under way carries activity, and `start` is triggered again.
    pub fn reset(&self, view: ProgramView<'_>) -> TokenStream {
        // Those that `start` makes active again say both at once.
        let deactivates = view.analysis.active.iter().map(|&node| {
            if view.graph.nodes[node].is_delay() {
                let held = self.held_activity(node);
                return quote! { state.#held.clear(); };
            }
            let (clear, deactivate) = (self.clear_told(view, node), self.deactivate(view, node));
            let tell = (!view.graph.nodes[node].starts_active).then(|| self.tell(view, node));
            quote! { #clear #deactivate #tell }
        });
        let sets = self.activity_state(view).into_iter().map(|kept| kept.name);
        let clears = sets.filter(|name| ["gains", "loses", "carries"].iter().any(|set| name == set));
        let clears = clears.map(|name| quote! { core.#name = ::apex_rt::Bits::NONE; });
        let remembered = view.analysis.active.iter().filter(|node| self.remembers(view, **node));
        let forgets =
            remembered.map(|node| self.held(*node)).map(|name| quote! { state.#name = ::apex_rt::Bits::NONE; });
        let restart = view.graph.nodes.ids().map(|node| self.move_machine(view, node, Move::Restart));
        let begin = self.begin(view);
        quote! { #(#deactivates)* #(#clears)* #(#forgets)* #(#restart)* #begin }
    }
}
