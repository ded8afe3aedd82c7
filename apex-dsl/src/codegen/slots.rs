//! Slots: one function for each connection to one, and what is emitted when a firing ends.

use super::{
    clusters::inlined,
    generator::Generator,
    numbered::{Arm, Numbered},
    tokens::{constant, ident},
    view::ProgramView,
};
use crate::{
    analyse::{Delivery, MANY},
    catalog::Signature,
    graph::{ConnectionId, Graph, Library, NodeId, NodeKind, PortId},
    program::{Arg, Entering, Failing, Slot, SlotCall, is_buffer},
};
use proc_macro2::TokenStream;
use quote::{quote, quote_spanned};
use syn::Ident;

impl Generator<'_> {
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

    /// An event as an argument; `sent` if it is connected.
    pub fn event(&self, end: PortId, sent: bool) -> TokenStream {
        if sent {
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
        let (slots, rows) = (&view.wiring.slots, self.slot_rows(view));
        let inline = inlined(slots.len(), MANY);
        let functions = slots.iter().enumerate().map(|(number, slot)| {
            let (name, docs) =
                (ident(&view.labels.slots[number]), self.docs_of_connection(view.graph, slot.connection));
            let code = self.slot(view, number, slot);
            let code = match code.is_empty() {
                true => quote! { core.only_enter(&#rows[#number], ctx, observer); },
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
        let rows = self.slot_rows(view);
        let rest = quote!(core.only_enter(&#rows[slot as usize], ctx, observer));
        Numbered { name: "slot", count: view.wiring.slots.len(), arms, rest }
    }

    /// Documentation of what a connection leads to: ``` `stopped => waiting.enable`, mission.afg:27 ```.
    fn docs_of_connection(&self, graph: &Graph, connection: ConnectionId) -> String {
        format!(" `{}`, {}.", graph.connection_text(connection), self.line(graph.connections[connection].span))
    }

    /// Code of a slot; none if it calls nothing.
    fn slot(&self, view: ProgramView<'_>, number: usize, slot: &Slot) -> TokenStream {
        let served = &view.program.slots[number];
        let [clear, turned, call, after] =
            [&served.clear, &served.turned, &served.call, &served.after].map(|ops| self.ops(view, ops));
        if clear.is_empty() && turned.is_empty() && call.is_empty() && after.is_empty() {
            return quote!();
        }
        let (name, effects) = match turned.is_empty() {
            true => (quote!(_), quote!()),
            false => (quote!(turned), quote! { if *turned { #turned } }),
        };
        let (index, rows) = (self.index(slot.node), self.slot_rows(view));
        quote! {
            let (ctx, #name) = &core.enter(&#rows[#number], ctx, observer);
            #clear #effects #call
            observer.finished(#index);
            #after
        }
    }

    /// A slot takes its token away.
    pub fn taken(&self, graph: &Graph, from: PortId, call: &TokenStream) -> TokenStream {
        let name = self.name(from);
        if is_buffer(graph, self.catalog, from) {
            quote! { #call state.#name.clear(); }
        } else {
            quote! { let #name = state.#name.take(); #call }
        }
    }

    /// Puts the token of a slot into the mailbox of an event of the program.
    pub fn put_out(&self, view: ProgramView<'_>, slot: usize, taken: bool, room: Option<usize>) -> TokenStream {
        let Slot { connection, node, .. } = view.wiring.slots[slot];
        let port = ident(&view.graph.nodes[node].name);
        let room = room.map(|bit| quote! { core.dispatcher.clear(#bit); });
        let copy = self.copy_of_slot(view.graph, connection);
        let put = self.with_slot_token(view, connection, taken, &quote! { let _ = events.#port.put(#copy); });
        quote! { #put #room }
    }

    /// Keeps a copy of the token of a slot for the test.
    pub fn see_slot(&self, view: ProgramView<'_>, slot: usize, taken: bool) -> TokenStream {
        let Slot { connection, node, .. } = view.wiring.slots[slot];
        let (probe, copy) = (self.probe(node), self.copy_of_slot(view.graph, connection));
        self.with_slot_token(view, connection, taken, &quote! { outputs.#probe.saw(#copy); })
    }

    /// The token of a slot as a value of its own, from `token`.
    fn copy_of_slot(&self, graph: &Graph, connection: ConnectionId) -> TokenStream {
        let c = &graph.connections[connection];
        match &c.given {
            Some(given) => constant(&given.value, &graph.port(c.to).ty),
            None => self.clone(graph, c.from, &quote!(token)),
        }
    }

    /// Code that uses the token of a slot, which is `token` there.
    fn with_slot_token(
        &self,
        view: ProgramView<'_>,
        connection: ConnectionId,
        taken: bool,
        code: &TokenStream,
    ) -> TokenStream {
        let c = &view.graph.connections[connection];
        let token = self.slot_token(view, c.from, taken);
        match &c.given {
            Some(_) => quote! { if #token.is_some() { #code } },
            None => quote! { if let Some(token) = #token { #code } },
        }
    }

    /// The token of a slot, where it lies: `Option<&T>`.
    pub fn slot_token(&self, view: ProgramView<'_>, from: PortId, taken: bool) -> TokenStream {
        let name = self.name(from);
        match is_buffer(view.graph, self.catalog, from) {
            true => quote!(state.#name.get()),
            false if taken => quote!(#name.as_ref()),
            false => quote!(state.#name.as_ref()),
        }
    }

    /// The call of a slot's method.
    pub fn call_method(
        &self,
        view: ProgramView<'_>,
        slot: usize,
        taken: bool,
        slot_call: Option<&SlotCall>,
    ) -> TokenStream {
        let (graph, connection) = (view.graph, view.wiring.slots[slot].connection);
        let c = &graph.connections[connection];
        let node = c.to.node;
        let NodeKind::Library(library) = &graph.nodes[node].kind else { return quote!() };
        let signature = &self.catalog.signatures[library.signature];
        let method = signature.slots.iter().find(|s| s.port == c.to.port);
        let Some((slot_call, slot)) = slot_call.zip(method) else {
            return self.bug(c.span, "the slot has no method");
        };
        let of_slot = || self.judged_slot(graph, connection, library, signature);
        let [call, late] = self.called(view, node, &slot.method, slot_call, &of_slot);
        let call = if slot_call.args.iter().any(|arg| matches!(arg, Arg::OfSlot)) {
            let call = self.with_slot_token(view, connection, taken, &quote!(#call;));
            quote! { #call #late }
        } else {
            quote! { #call; #late }
        };
        self.recorded_slot(graph, node, self.states_told(graph, node, call))
    }

    /// The call of the method of a machine that has been in a state for some time.
    pub fn leave_state(&self, view: ProgramView<'_>, node: NodeId, wait: usize, call: &SlotCall) -> TokenStream {
        let (graph, method) = (view.graph, &view.program.lower.waits(node)[wait].method);
        let of_slot = || self.bug(graph.nodes[node].span, "no token has come after a time");
        let [call, late] = self.called(view, node, method, call, &of_slot);
        self.recorded_slot(graph, node, self.states_told(graph, node, quote! { #call; #late }))
    }

    /// The call of a method with the token of a slot, and what follows if it is late.
    fn called(
        &self,
        view: ProgramView<'_>,
        node: NodeId,
        method: &str,
        SlotCall { args, failing, deadline }: &SlotCall,
        of_slot: &dyn Fn() -> TokenStream,
    ) -> [TokenStream; 2] {
        let args = args.iter().map(|arg| match *arg {
            Arg::OfSlot => of_slot(),
            Arg::Event { event, sent } => self.event(event, sent),
            _ => self.context(view, node),
        });
        let (place, method) = (self.node_place(view.graph, node), ident(method));
        let call = quote!(#place.#method(#(#args),*));
        [self.contained(view, node, *failing, call), self.late(view, node, *deadline)]
    }

    /// The context for a node, which knows whether it is active.
    pub fn context(&self, view: ProgramView<'_>, node: NodeId) -> TokenStream {
        if view.analysis.active.contains(&node) {
            let is_active = self.has_activity(view.program.lower.spot(node));
            quote!(&ctx.of_node(#is_active))
        } else {
            quote!(ctx)
        }
    }

    /// A call whose failure is reported: its value as an `Option`, or the call itself where nothing can fail.
    pub fn contained(&self, view: ProgramView<'_>, node: NodeId, failing: Failing, call: TokenStream) -> TokenStream {
        let index = self.index(node);
        let (fallible, event, restart) = match failing {
            Failing::Never => return call,
            Failing::Reported => return quote!(::apex_rt::sent(#call, #index, observer)),
            Failing::Contained { fallible, event, restart } => (fallible, event, restart),
        };
        let how = if fallible { quote!(contain_fallible) } else { quote!(contain) };
        let event = event.map(|end| {
            let name = self.name(end);
            quote! { state.#name = Some(failure); }
        });
        let restart = restart.then(|| self.remake(view.graph, node));
        quote! {
            match ::apex_rt::#how(|| #call) {
                Ok(value) => Some(value),
                Err(failure) => { observer.failed(#index, &failure); #event #restart None }
            }
        }
    }

    /// The token of a slot as an argument. Rustc judges a connection whose types the scan could not compare.
    fn judged_slot(
        &self,
        graph: &Graph,
        connection: ConnectionId,
        library: &Library,
        signature: &Signature,
    ) -> TokenStream {
        let c = &graph.connections[connection];
        if let Some(given) = &c.given {
            let (value, span) = (constant(&given.value, &graph.port(c.to).ty), (self.place)(given.written.span));
            return quote_spanned!(span=> &#value);
        }
        let Some(link) = self.link(graph, connection) else { return quote!(token) };
        let (node, index) = (self.node_type(graph, library), signature.ports[c.to.port].index);
        let span = (self.place)(c.span);
        quote_spanned!(span=> #link::<<#node as ::apex_rt::Slot<#index>>::Token>::pass(token))
    }

    /// Takes the token of a slot of the program, if there is one and it can go on.
    pub fn enter(&self, view: ProgramView<'_>, slot: &Entering) -> TokenStream {
        let (port, test, goes_on) = self.entering(view, slot);
        quote! { if self.inputs.#port.is_full() #test { #goes_on } }
    }

    /// Takes the tokens of several slots of the program, in the order in which they were put in.
    pub fn enter_in_order(&self, view: ProgramView<'_>, slots: &[Entering]) -> TokenStream {
        let (mut arrivals, mut arms) = (vec![], vec![]);
        for (place, slot) in slots.iter().enumerate() {
            let (port, test, goes_on) = self.entering(view, slot);
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
    fn entering(
        &self,
        view: ProgramView<'_>,
        Entering { node, free, then }: &Entering,
    ) -> (Ident, TokenStream, TokenStream) {
        let (name, port) = (self.name(PortId { node: *node, port: 0 }), ident(&view.graph.nodes[*node].name));
        let (test, then) = (self.allows(view, free), self.ops(view, then));
        let goes_on = quote! {
            let Self { state, core, inputs, .. } = self;
            state.#name = inputs.#port.take();
            #then
            quiet = false;
        };
        (port, test, goes_on)
    }
}
