//! `cancel` and `resume`: activity is taken out of a node or nested graph, and given back.

use super::{
    Generator,
    activity::ProgramView,
    types::ident,
};
use crate::{
    graph::{ConnectionId, Interrupt, NodeId, NodeKind, PortId, Standard},
    machine::Move,
    program::{Carries, Flag},
};
use proc_macro2::{Literal, TokenStream};
use quote::quote;
use syn::Ident;

impl Generator<'_> {
    /// Returns `true` if a node interrupts, and has to remember for its `resume` what it took.
    pub fn remembers(&self, view: ProgramView<'_>, node: NodeId) -> bool {
        let interrupts = view.graph.nodes[node].interrupts().is_some() && view.analysis.active.contains(&node);
        interrupts && self.is_called(view, node, Standard::Resume)
    }

    fn is_called(&self, view: ProgramView<'_>, node: NodeId, standard: Standard) -> bool {
        let called = |c: &ConnectionId| {
            let to = view.graph.connections[*c].to;
            to.node == node && standard.is_of_interrupt(to.port)
        };
        view.analysis.asynchronous.slots.iter().any(called)
    }

    /// Name of the function of `cancel` or `resume`: `cancel_7`. No other function has such a name.
    pub fn interrupt_function(&self, view: ProgramView<'_>, slot: PortId) -> Ident {
        ident(&format!("{}_{}", view.graph.port(slot).name, slot.node.index()))
    }

    /// The functions of `cancel` and `resume`.
    pub fn interrupts(&self, view: ProgramView<'_>) -> TokenStream {
        let mut code = quote!();
        for Interrupt { node, takes, .. } in view.graph.interrupts() {
            let is_active = |node: &NodeId| view.analysis.active.contains(node);
            let nodes: Vec<NodeId> = takes.iter().copied().filter(is_active).collect();
            for standard in [Standard::Cancel, Standard::Resume] {
                let Some(port) = standard.of_interrupt().filter(|_| self.is_called(view, node, standard)) else {
                    continue;
                };
                let (body, how) = match standard {
                    Standard::Cancel => (self.cancel(view, node, &nodes), Move::Cancel),
                    _ => (self.resume(view, node, &nodes), Move::Resume),
                };
                let machines = takes.iter().map(|node| self.move_machine(view, *node, how));
                let end = PortId { node, port };
                let (name, docs) = (self.interrupt_function(view, end), format!(" `{}`", view.graph.end_name(end)));
                let (place, [state, core]) = (self.nodes_type(view), self.state_types(view));
                code.extend(quote! {
                    #[doc = #docs]
                    #[allow(unused_variables)]
                    fn #name<O: ::apex_rt::Observer>(nodes: &mut #place, state: &mut #state, core: &mut #core, ctx: &::apex_rt::Ctx, observer: &mut O) {
                        #(#machines)*
                        #body
                    }
                });
            }
        }
        code
    }

    /// Takes the activity of `nodes` and of the tokens on their way to them. If there was any, or if the token brought
    /// some, the event of `interrupt` is triggered, and takes it along.
    fn cancel(&self, view: ProgramView<'_>, interrupt: NodeId, nodes: &[NodeId]) -> TokenStream {
        let is_reached = view.analysis.active.contains(&interrupt);
        let brought = if is_reached { self.take(Flag::Active(interrupt)) } else { quote!(false) };
        let remembered = self.remembers(view, interrupt).then(|| self.held(interrupt));
        let forget = remembered.as_ref().map(|_| quote! { let mut remembered = ::apex_rt::Bits::NONE; });
        // Without activity there is nothing to remember instead.
        let keep = remembered.as_ref().map(|kept| quote! { if taken { state.#kept = remembered; } });
        let takes = nodes.iter().map(|&node| {
            let mut found = vec![];
            if self.lower(view).inputs_carry(node, &[Carries::Always, Carries::Sometimes]) {
                found.push(self.take(Flag::Gains(node)));
            }
            let slots = view.wiring.slots.iter().enumerate();
            let to_it = slots.filter(|(_, slot)| slot.node == node && slot.carries == Carries::Sometimes);
            found.extend(to_it.map(|(number, _)| self.take(Flag::Carries(number))));
            found.push(self.is_active_now(view, node));
            if view.graph.nodes[node].is_delay() {
                let held = self.held_activity(node);
                return quote! { if #(#found)|* { taken = true; state.#held.clear(); } };
            }
            let remember: TokenStream = remembered.iter().flat_map(|_| self.bits(view, node, nodes)).collect();
            let (clear, leave, tell) =
                (self.clear_told(view, node), self.deactivate(view, node), self.tell(view, node));
            quote! { if #(#found)|* { taken = true; #remember #clear #leave #tell } }
        });
        let event = Standard::Cancelled.of_interrupt().map(|port| PortId { node: interrupt, port });
        let sends = event.filter(|event| self.is_sent_event(view, *event)).map(|event| {
            let name = self.name(event);
            let passes = view.wiring.of(interrupt).iter().any(|port| port.is_active && port.passes.is_some());
            let activity = (passes && is_reached).then(|| self.set(Flag::Active(interrupt), true));
            quote! { if taken { state.#name = Some(()); #activity } }
        });
        let check = self.check_claims(view);
        quote! {
            #[allow(unused_mut)]
            let mut taken = false;
            #forget
            #(#takes)*
            #keep
            let taken = #brought | taken;
            #sends
            #check
        }
    }

    /// Moves a state machine to another state, and sends its events. Nothing for other nodes.
    pub fn move_machine(&self, view: ProgramView<'_>, node: NodeId, how: Move) -> TokenStream {
        let NodeKind::Library(library) = &view.graph.nodes[node].kind else { return quote!() };
        let Some(machine) = &self.catalog.signatures[library.signature].machine else { return quote!() };
        let events = machine.moved.iter().map(|port| self.event(view, PortId { node, port: *port }));
        let (place, method) = (self.node_place(view.graph, node), ident(how.method()));
        // Its other events may still be on their way.
        let comes = |end: PortId| view.graph.port(end).comes_with_moves;
        let (clear, emit) = (self.clear(view, node, &comes), self.emit_from(view, node, &comes));
        let call = self.states_told(view.graph, node, quote! { #place.#method(#(#events),*); });
        quote! { #clear #call #emit }
    }

    /// Remembers the nodes among `nodes` to which the activity of `node` is given back.
    fn bits(&self, view: ProgramView<'_>, node: NodeId, nodes: &[NodeId]) -> Vec<TokenStream> {
        let receivers = view.graph.receivers(node).into_iter().filter(|node| nodes.contains(node));
        let bits = receivers.map(|node| Literal::usize_unsuffixed(self.index(node)));
        bits.map(|bit| quote! { remembered.set(#bit, true); }).collect()
    }

    /// Gives activity back to the nodes from which `cancel` took it.
    fn resume(&self, view: ProgramView<'_>, interrupt: NodeId, nodes: &[NodeId]) -> TokenStream {
        if !self.remembers(view, interrupt) {
            return quote!();
        }
        let (remembered, brought) = (self.held(interrupt), self.set(Flag::Active(interrupt), false));
        let is_plain = |node: &&NodeId| !view.graph.nodes[**node].is_delay();
        let gives = nodes.iter().filter(is_plain).map(|&node| {
            let bit = Literal::usize_unsuffixed(self.index(node));
            let (clear, activate, tell) =
                (self.clear_told(view, node), self.activate(view, node), self.tell(view, node));
            quote! { if state.#remembered.take(#bit) { #clear #activate #tell } }
        });
        let check = self.check_claims(view);
        quote! { #brought #(#gives)* #check }
    }
}
