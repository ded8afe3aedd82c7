//! Activity (execution semantics, section 5): flags of nodes and of tokens, for the nodes that activity can reach.
//! All others are never active, and nothing is generated for them.

use super::{
    field::{Kind, StateField},
    generator::Generator,
    tokens::ident,
    view::ProgramView,
};
use crate::{
    graph::{Graph, NodeId, NodeKind},
    program::{Carries, Flag},
};
use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};
use syn::Ident;

impl Generator<'_> {
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
        let gains = |node: NodeId| view.program.lower.inputs_carry(node, &[Carries::Always, Carries::Sometimes]);
        let loses = |node: NodeId| view.program.lower.inputs_carry(node, &[Carries::Away]);
        let can_be_disabled = |node: NodeId| graph.nodes[node].can_be_disabled();
        set("active", "active nodes", count, numbers(&is_plain, &mut active()), false);
        set("gains", "nodes that become active", count, numbers(&gains, &mut active()), false);
        set("loses", "nodes that become inactive", count, numbers(&loses, &mut active()), false);
        set("enabled", "enabled nodes", count, numbers(&can_be_disabled, &mut graph.nodes.ids()), true);
        let slots = &view.wiring.slots;
        let carry = (0..slots.len()).filter(|slot| slots[*slot].carries == Carries::Sometimes).collect();
        set("carries", "slot tokens with activity", slots.len(), carry, false);
        for interrupt in active().filter(|node| view.program.lower.remembers(*node)) {
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
        let (set, bit) = self.place_of(flag);
        quote!(core.#set.has(#bit))
    }

    /// Sets a flag, or clears it.
    pub fn set(&self, flag: Flag, value: bool) -> TokenStream {
        let (set, bit) = self.place_of(flag);
        quote! { core.#set.set(#bit, #value); }
    }

    /// Clears a flag. The expression is `true` if it was set.
    pub fn take(&self, flag: Flag) -> TokenStream {
        let (set, bit) = self.place_of(flag);
        quote!(core.#set.take(#bit))
    }

    fn place_of(&self, flag: Flag) -> (Ident, Literal) {
        let (set, bit) = self.flag(flag);
        (ident(set), Literal::usize_unsuffixed(bit))
    }

    /// The set of a flag, and its number there.
    pub fn flag(&self, flag: Flag) -> (&'static str, usize) {
        match flag {
            Flag::Active(node) => ("active", self.index(node)),
            Flag::Gains(node) => ("gains", self.index(node)),
            Flag::Loses(node) => ("loses", self.index(node)),
            Flag::Enabled(node) => ("enabled", self.index(node)),
            Flag::Carries(slot) => ("carries", slot),
        }
    }

    /// The method of a node that is called when it becomes active, or inactive.
    pub fn hook(&self, graph: &Graph, node: NodeId, active: bool) -> TokenStream {
        let signature = match &graph.nodes[node].kind {
            NodeKind::Library(library) => Some(&self.catalog.signatures[library.signature]),
            _ => None,
        };
        let method = signature.and_then(|s| if active { s.on_activate.as_ref() } else { s.on_deactivate.as_ref() });
        let Some(method) = method else {
            return self.bug(graph.nodes[node].span, "a node has no method for a change of its activity");
        };
        let (place, method) = (self.node_place(graph, node), ident(method));
        quote! { #place.#method(); }
    }
}

/// A call with what follows if it returns `true`.
pub fn followed(call: &TokenStream, effects: &TokenStream) -> TokenStream {
    match effects.is_empty() {
        true => quote! { #call; },
        false => quote! { if #call { #effects } },
    }
}
