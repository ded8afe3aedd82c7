//! Activity (execution semantics, section 5): flags of nodes and of tokens, for the nodes that activity can reach.
//! All others are never active, and nothing is generated for them.

use super::{
    Generator,
    state::{Kind, StateField},
    types::ident,
    labels::Labels,
};
use crate::{
    analyse::{Analysis, Links},
    graph::{Graph, NodeId, NodeKind, PortId, Standard},
    program::{Carries, Flag, Lower, Wiring},
};
use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};
use syn::Ident;

/// Input of the code generator for a program, or for a part of one.
#[derive(Clone, Copy)]
pub struct ProgramView<'a> {
    pub graph: &'a Graph,
    pub analysis: &'a Analysis,
    pub links: &'a Links,
    /// The asynchronous half; empty in the body of an `each`.
    pub wiring: &'a Wiring,
    /// Names of what it consists of.
    pub labels: &'a Labels,
}

/// A program as it was lowered, with the names in its code.
pub struct Lowered {
    wiring: Wiring,
    labels: Labels,
}

impl Lowered {
    /// The program of a graph.
    pub fn new(generator: &Generator<'_>, graph: &Graph, analysis: &Analysis) -> Self {
        let wiring = Wiring::new(Lower::new(graph, analysis, generator.catalog, generator.claims));
        let labels = Labels::new(generator, graph, analysis, &wiring);
        Self { wiring, labels }
    }
}

impl<'a> ProgramView<'a> {
    /// The view of a graph, its analysis, and its program.
    pub fn new(graph: &'a Graph, analysis: &'a Analysis, lowered: &'a Lowered) -> Self {
        Self { graph, analysis, links: &analysis.links, wiring: &lowered.wiring, labels: &lowered.labels }
    }
}

impl Generator<'_> {
    /// Input of the lowering of a program.
    pub fn lower<'a>(&'a self, view: ProgramView<'a>) -> Lower<'a> {
        Lower::new(view.graph, view.analysis, self.catalog, self.claims)
    }

    /// Activity in the state of a program: sets of flags, and what delays keep.
    pub fn activity_state(&self, view: ProgramView<'_>) -> Vec<StateField> {
        let ProgramView { graph, analysis, .. } = view;
        let active = || analysis.active.iter().copied();
        let mut kept = vec![];
        let mut set = |name, of: &str, count: usize, flags: Vec<usize>, initial: bool| {
            if flags.is_empty() {
                return;
            }
            let words = count.div_ceil(64);
            let flags = flags.into_iter().filter(|_| initial).map(Literal::usize_unsuffixed);
            let (ty, make) = (quote!(::apex_rt::Bits<#words>), quote!(::apex_rt::Bits::of(&[#(#flags),*])));
            kept.push(StateField::new(Kind::Activity, of.to_owned(), format_ident!("{name}"), ty, make));
        };
        let count = self.names.numbers.iter().map(|number| number + 1).max().unwrap_or(0);
        let numbers = |meant: &dyn Fn(NodeId) -> bool, nodes: &mut dyn Iterator<Item = NodeId>| -> Vec<usize> {
            nodes.filter(|node| meant(*node)).map(|node| self.index(node)).collect()
        };
        let is_plain = |node: NodeId| !graph.nodes[node].is_delay();
        let gains = |node: NodeId| self.lower(view).inputs_carry(node, &[Carries::Always, Carries::Sometimes]);
        let loses = |node: NodeId| self.lower(view).inputs_carry(node, &[Carries::Away]);
        let can_be_disabled = |node: NodeId| graph.nodes[node].can_be_disabled();
        set("active", "active nodes", count, numbers(&is_plain, &mut active()), false);
        set("gains", "nodes that become active", count, numbers(&gains, &mut active()), false);
        set("loses", "nodes that become inactive", count, numbers(&loses, &mut active()), false);
        set("enabled", "enabled nodes", count, numbers(&can_be_disabled, &mut graph.nodes.ids()), true);
        let slots = &view.wiring.slots;
        let carry = (0..slots.len()).filter(|slot| slots[*slot].carries == Carries::Sometimes).collect();
        set("carries", "slot tokens with activity", slots.len(), carry, false);
        for interrupt in active().filter(|node| self.remembers(view, *node)) {
            let (name, words) = (self.held(interrupt), count.div_ceil(64));
            let (ty, make) = (quote!(::apex_rt::Bits<#words>), quote!(::apex_rt::Bits::NONE));
            kept.push(StateField::new(Kind::Activity, graph.path(interrupt), name, ty, make));
        }
        for node in active() {
            if let NodeKind::Delay(initial) = &graph.nodes[node].kind {
                let (name, count) = (self.held_activity(node), initial.len());
                let make = quote!(::apex_rt::Delay::new([None; #count]));
                let of = graph.path(node);
                kept.push(StateField::new(Kind::Activity, of, name, quote!(::apex_rt::Delay<(), #count>), make));
            }
        }
        kept
    }

    /// Expression that is `true` if a flag is set.
    pub fn is_set(&self, flag: Flag) -> TokenStream {
        let (set, bit) = self.flag(flag);
        quote!(core.#set.has(#bit))
    }

    /// Sets a flag, or clears it.
    pub fn set(&self, flag: Flag, value: bool) -> TokenStream {
        let (set, bit) = self.flag(flag);
        quote! { core.#set.set(#bit, #value); }
    }

    /// Clears a flag. The expression is `true` if it was set.
    pub fn take(&self, flag: Flag) -> TokenStream {
        let (set, bit) = self.flag(flag);
        quote!(core.#set.take(#bit))
    }

    /// The set of a flag, and its number there.
    fn flag(&self, flag: Flag) -> (Ident, Literal) {
        let (set, bit) = match flag {
            Flag::Active(node) => ("active", self.index(node)),
            Flag::Gains(node) => ("gains", self.index(node)),
            Flag::Loses(node) => ("loses", self.index(node)),
            Flag::Enabled(node) => ("enabled", self.index(node)),
            Flag::Carries(slot) => ("carries", slot),
        };
        (format_ident!("{set}"), Literal::usize_unsuffixed(bit))
    }

    /// Expression that is `true` if a node has activity.
    pub fn is_active_now(&self, view: ProgramView<'_>, node: NodeId) -> TokenStream {
        match view.graph.nodes[node].is_delay() {
            true => {
                let held = self.held_activity(node);
                quote!(state.#held.holds_any())
            }
            false => self.is_set(Flag::Active(node)),
        }
    }

    /// Moves the activity of a token into a delay, and out of it with the token.
    pub fn hold_activity(&self, view: ProgramView<'_>, node: NodeId) -> TokenStream {
        if !view.analysis.active.contains(&node) {
            return quote!();
        }
        let (held, gains) = (self.held_activity(node), self.take(Flag::Gains(node)));
        quote! { state.#held.put(#gains.then_some(())); }
    }

    /// A node becomes active, unless it is already.
    pub fn activate(&self, view: ProgramView<'_>, node: NodeId) -> TokenStream {
        let (row, effects) = (self.node_constant(view, node), self.turn_effects(view, node, true));
        followed(&quote!(core.activate(&#row, ctx, observer)), &effects)
    }

    /// A node is no longer active.
    pub fn deactivate(&self, view: ProgramView<'_>, node: NodeId) -> TokenStream {
        let (row, effects) = (self.node_constant(view, node), self.turn_effects(view, node, false));
        followed(&quote!(core.deactivate(&#row, observer)), &effects)
    }

    /// The event and the hook of a node that became active, or is no longer.
    pub fn turn_effects(&self, view: ProgramView<'_>, node: NodeId, active: bool) -> TokenStream {
        let graph = view.graph;
        let (event, hook) = match active {
            true => (Standard::Activated, self.hook(graph, node, |s| s.on_activate.as_deref())),
            false => (Standard::Deactivated, self.hook(graph, node, |s| s.on_deactivate.as_deref())),
        };
        let event = self.trigger(graph, node, event);
        quote! { #event #hook }
    }

    /// Triggers an event that every node has, if it is connected.
    pub fn trigger(&self, graph: &Graph, node: NodeId, standard: Standard) -> TokenStream {
        match graph.nodes[node].standard(standard) {
            Some(port) => {
                let name = self.name(PortId { node, port });
                quote! { state.#name = Some(()); }
            }
            None => quote!(),
        }
    }

    fn hook(
        &self,
        graph: &Graph,
        node: NodeId,
        method: impl Fn(&crate::catalog::Signature) -> Option<&str>,
    ) -> TokenStream {
        let NodeKind::Library(library) = &graph.nodes[node].kind else { return quote!() };
        match method(&self.catalog.signatures[library.signature]) {
            Some(method) => {
                let (place, method) = (self.node_place(graph, node), ident(method));
                quote! { #place.#method(); }
            }
            None => quote!(),
        }
    }

    /// A1 for the inputs of a node: what its tokens carried counts now.
    pub fn take_activity(&self, view: ProgramView<'_>, node: NodeId) -> TokenStream {
        if !view.analysis.active.contains(&node) || view.graph.nodes[node].is_delay() {
            return quote!();
        }
        let gains = self.lower(view).inputs_carry(node, &[Carries::Always, Carries::Sometimes]);
        let loses = self.lower(view).inputs_carry(node, &[Carries::Away]);
        let (take_gains, take_loses) = (self.take(Flag::Gains(node)), self.take(Flag::Loses(node)));
        let check = self.check_claims(view);
        let (activate, deactivate) = (self.activate(view, node), self.deactivate(view, node));
        let (activate, deactivate) = (quote!(#activate #check), quote!(#deactivate #check));
        match (gains, loses) {
            (false, false) => quote!(),
            (true, false) => quote! { if #take_gains { #activate } },
            (false, true) => quote! { if #take_loses { #deactivate } },
            (true, true) => quote! {
                match (#take_gains, #take_loses) {
                    (true, _) => { #activate }
                    (false, true) => { #deactivate }
                    _ => {}
                }
            },
        }
    }

    /// A2 and A5 for the ports of a node that `present` knows: its activity goes with the first token over an
    /// active connection.
    pub fn pass_activity(
        &self,
        view: ProgramView<'_>,
        node: NodeId,
        present: &dyn Fn(PortId) -> Option<TokenStream>,
    ) -> TokenStream {
        let mut code = quote!();
        for port in view.wiring.of(node).iter().filter(|port| port.is_active) {
            let Some(present) = present(port.end) else { continue };
            let name = ident(&view.labels.ports[&port.end]);
            let pass = quote!(core.pass(&Self::#name, #present, observer));
            code.extend(match port.passes {
                None if port.takes_away.is_empty() => quote!(),
                None => quote! { #pass; },
                Some(_) if view.graph.nodes[node].is_delay() => {
                    let held = self.held_activity(node);
                    let pass = (!port.takes_away.is_empty()).then(|| quote! { #pass; });
                    quote! { #pass if state.#held.take().is_some() { core.carry(&Self::#name); } }
                }
                Some(_) => {
                    let (effects, check) = (self.turn_effects(view, node, false), self.check_claims(view));
                    followed(&pass, &quote!(#effects #check))
                }
            });
        }
        code
    }
}

/// A call with what follows if it returns `true`.
pub fn followed(call: &TokenStream, effects: &TokenStream) -> TokenStream {
    match effects.is_empty() {
        true => quote! { #call; },
        false => quote! { if #call { #effects } },
    }
}

/// Returns `true` if observers are notified of a node's activity. They are not if the node only passes tokens on.
pub fn is_observed(graph: &Graph, node: NodeId) -> bool {
    use NodeKind::{Interrupt, Receiver, Relay, Sender};
    !matches!(graph.nodes[node].kind, Relay | Interrupt(_) | Sender(_) | Receiver(_))
}
