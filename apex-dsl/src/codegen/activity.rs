//! Activity (execution semantics, section 5): flags of nodes and of tokens, for the nodes that activity can reach.
//! All others are never active, and nothing is generated for them.

use super::{
    Flag, Generator,
    state::{Kept, Kind},
    types::{duration, ident},
};
use crate::{
    analyse::{Analysis, Guard, Links, is_source, takes_activity},
    graph::{End, Flow, Graph, NodeId, NodeKind, Standard},
};
use proc_macro2::TokenStream;
use quote::quote;
use std::time::Duration;

/// What the code of a program is generated from.
#[derive(Clone, Copy)]
pub struct Whole<'a> {
    pub graph: &'a Graph,
    pub analysis: &'a Analysis,
    pub links: &'a Links,
}

/// How a token changes the activity of the node that takes it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Carries {
    /// Not at all.
    Nothing,
    /// It activates: it is from `start`.
    Always,
    /// It activates if its sender was active: there is a flag for it.
    Sometimes,
    /// It takes activity away.
    Away,
}

impl Generator<'_> {
    /// What the tokens on `connection` may carry.
    pub fn carries(&self, whole: Whole<'_>, connection: usize) -> Carries {
        let c = &whole.graph.connections[connection];
        let checked = self.checks_claims();
        // Claims have to know of activity on its way to the end of the program.
        let ends = checked && matches!(whole.graph.nodes[c.to.node].kind, NodeKind::Exit(_));
        if !c.active || !(ends || whole.analysis.active.contains(&c.to.node)) {
            return Carries::Nothing;
        }
        match &whole.graph.nodes[c.from.node].kind {
            NodeKind::Start if checked => Carries::Sometimes,
            NodeKind::Start => Carries::Always,
            _ if takes_activity(whole.graph, self.catalog, c.from.node) => Carries::Away,
            _ if whole.analysis.active.contains(&c.from.node) => Carries::Sometimes,
            _ => Carries::Nothing,
        }
    }

    /// The connections into the inputs of a node whose tokens may carry one of `what`.
    fn inputs_carry(&self, whole: Whole<'_>, node: NodeId, what: &[Carries]) -> bool {
        whole.links.inputs[node].iter().any(|c| what.contains(&self.carries(whole, *c)))
    }

    /// The flags of a program, with what they start as.
    pub fn flags(&self, whole: Whole<'_>) -> Vec<Kept> {
        let mut flags = vec![];
        let of = |node| whole.graph.path(node);
        let mut bit =
            |of, name, value: bool| flags.push(Kept::new(Kind::Activity, of, name, quote!(bool), quote!(#value)));
        for &node in &whole.analysis.active {
            if !whole.graph.nodes[node].is_delay() {
                bit(of(node), self.flag(Flag::Active, node), false);
            }
            if self.inputs_carry(whole, node, &[Carries::Always, Carries::Sometimes]) {
                bit(of(node), self.flag(Flag::Gains, node), false);
            }
            if self.inputs_carry(whole, node, &[Carries::Away]) {
                bit(of(node), self.flag(Flag::Loses, node), false);
            }
        }
        for (slot, &connection) in whole.analysis.asynchronous.slots.iter().enumerate() {
            if self.carries(whole, connection) == Carries::Sometimes {
                bit(whole.graph.connection_text(connection), carries(slot), false);
            }
        }
        for (node, n) in whole.graph.nodes.iter().enumerate() {
            if n.can_be_disabled() {
                bit(of(node), self.flag(Flag::Enabled, node), true);
            }
        }
        for &node in &whole.analysis.active {
            if let NodeKind::Delay(initial) = &whole.graph.nodes[node].kind {
                let (name, count) = (self.flag(Flag::Active, node), initial.len());
                let make = quote!(::apex_rt::Delay::new([None; #count]));
                flags.push(Kept::new(Kind::Activity, of(node), name, quote!(::apex_rt::Delay<(), #count>), make));
            }
        }
        for node in (0..whole.graph.nodes.len()).filter(|n| self.has_timeout(whole, *n)) {
            let (name, ty) = (self.flag(Flag::Timeout, node), quote!(::apex_rt::Timeout));
            flags.push(Kept::new(Kind::Timer, of(node), name, ty, quote!(::apex_rt::Timeout::new())));
        }
        flags
    }

    /// Whether there is activity in a node.
    pub fn is_active_now(&self, whole: Whole<'_>, node: NodeId) -> TokenStream {
        let flag = self.flag(Flag::Active, node);
        match whole.graph.nodes[node].is_delay() {
            true => quote!(state.#flag.holds_any()),
            false => quote!(state.#flag),
        }
    }

    /// What a delay holds keeps what it carries: it goes on with the token.
    pub fn hold_activity(&self, whole: Whole<'_>, node: NodeId) -> TokenStream {
        if !whole.analysis.active.contains(&node) {
            return quote!();
        }
        let (held, gains) = (self.flag(Flag::Active, node), self.flag(Flag::Gains, node));
        quote! { state.#held.put(::core::mem::take(&mut state.#gains).then_some(())); }
    }

    /// Whether the `timeout` of a node can come.
    pub fn has_timeout(&self, whole: Whole<'_>, node: NodeId) -> bool {
        let timeout = whole.graph.nodes[node].modifiers.timeout;
        timeout.is_some() && (whole.analysis.active.contains(&node) || self.watches_silence(whole, node).is_some())
    }

    /// The `timeout` of a source that activity never comes to: so long it may send nothing.
    pub fn watches_silence(&self, whole: Whole<'_>, node: NodeId) -> Option<Duration> {
        let is_source = is_source(whole.graph, self.catalog, whole.links, node);
        let watches = is_source && !whole.analysis.active.contains(&node);
        whole.graph.nodes[node].modifiers.timeout.filter(|_| watches)
    }

    /// The time of a source's silence begins.
    pub fn watch_silence(&self, whole: Whole<'_>, node: NodeId) -> TokenStream {
        match self.watches_silence(whole, node) {
            Some(timeout) => {
                let (name, timeout) = (self.flag(Flag::Timeout, node), duration(timeout));
                let open = self.open_agenda(whole);
                quote! { state.#name.start(ctx.now(), #timeout); #open }
            }
            None => quote!(),
        }
    }

    /// Whether the timers of a program have an agenda: few of them are as fast looked at themselves.
    pub fn has_agenda(&self, whole: Whole<'_>) -> bool {
        const FEWEST: usize = 3;
        let timers = whole.analysis.guards.iter().filter(|guard| matches!(guard, Guard::Timer(_))).map(|_| ());
        let timeouts = (0..whole.graph.nodes.len()).filter(|n| self.has_timeout(whole, *n)).map(|_| ());
        timers.chain(timeouts).take(FEWEST).count() == FEWEST
    }

    /// A timer changes.
    pub fn open_agenda(&self, whole: Whole<'_>) -> Option<TokenStream> {
        self.has_agenda(whole).then(|| quote! { state.agenda.open(); })
    }

    /// A node becomes active, unless it is already.
    pub fn activate(&self, whole: Whole<'_>, node: NodeId) -> TokenStream {
        let (flag, observed) = (self.flag(Flag::Active, node), self.observed(whole, node, true));
        let timeout = whole.graph.nodes[node].modifiers.timeout.map(|timeout| {
            let (name, timeout) = (self.flag(Flag::Timeout, node), duration(timeout));
            let open = self.open_agenda(whole);
            quote! { state.#name.start(ctx.now(), #timeout); #open }
        });
        let event = self.trigger(whole.graph, node, Standard::Activated);
        let hook = self.hook(whole.graph, node, |s| s.on_activate.as_deref());
        quote! {
            if !state.#flag {
                state.#flag = true;
                #observed
                #timeout #event #hook
            }
        }
    }

    /// A node is no longer active.
    pub fn deactivate(&self, whole: Whole<'_>, node: NodeId) -> TokenStream {
        let (flag, observed) = (self.flag(Flag::Active, node), self.observed(whole, node, false));
        let timeout = whole.graph.nodes[node].modifiers.timeout.map(|_| {
            let (name, open) = (self.flag(Flag::Timeout, node), self.open_agenda(whole));
            quote! { state.#name.stop(); #open }
        });
        let event = self.trigger(whole.graph, node, Standard::Deactivated);
        let hook = self.hook(whole.graph, node, |s| s.on_deactivate.as_deref());
        quote! {
            if state.#flag {
                state.#flag = false;
                #observed
                #timeout #event #hook
            }
        }
    }

    /// Tells the observer; not of a node that only passes tokens on.
    fn observed(&self, whole: Whole<'_>, node: NodeId, active: bool) -> TokenStream {
        let index = self.index(node);
        match whole.graph.nodes[node].kind {
            NodeKind::Relay | NodeKind::Sender(_) | NodeKind::Receiver(_) => quote!(),
            _ => quote! { observer.activity(#index, #active); },
        }
    }

    /// Triggers an event that every node has, if it is connected.
    pub fn trigger(&self, graph: &Graph, node: NodeId, standard: Standard) -> TokenStream {
        match graph.nodes[node].standard(standard) {
            Some(port) => {
                let name = self.name(End { node, port });
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
    pub fn take_activity(&self, whole: Whole<'_>, node: NodeId) -> TokenStream {
        if !whole.analysis.active.contains(&node) || whole.graph.nodes[node].is_delay() {
            return quote!();
        }
        let gains = self.inputs_carry(whole, node, &[Carries::Always, Carries::Sometimes]);
        let loses = self.inputs_carry(whole, node, &[Carries::Away]);
        let (gains_flag, loses_flag) = (self.flag(Flag::Gains, node), self.flag(Flag::Loses, node));
        let check = self.check_claims();
        let (activate, deactivate) = (self.activate(whole, node), self.deactivate(whole, node));
        let (activate, deactivate) = (quote!(#activate #check), quote!(#deactivate #check));
        match (gains, loses) {
            (false, false) => quote!(),
            (true, false) => quote! { if ::core::mem::take(&mut state.#gains_flag) { #activate } },
            (false, true) => quote! { if ::core::mem::take(&mut state.#loses_flag) { #deactivate } },
            (true, true) => quote! {
                match (::core::mem::take(&mut state.#gains_flag), ::core::mem::take(&mut state.#loses_flag)) {
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
        whole: Whole<'_>,
        node: NodeId,
        present: &dyn Fn(End) -> Option<TokenStream>,
    ) -> TokenStream {
        let mut code = quote!();
        let mut active: Vec<usize> = whole.links.from(node).filter(|c| whole.graph.connections[*c].active).collect();
        active.sort_unstable();
        for port in 0..whole.graph.nodes[node].ports.len() {
            let end = End { node, port };
            let (mut carry, mut away, mut any) = (quote!(), quote!(), false);
            for index in active.iter().copied().filter(|c| whole.graph.connections[*c].from == end) {
                let c = &whole.graph.connections[index];
                let to_slot = whole.graph.flow(c) == Flow::ToSlot;
                any = true;
                match self.carries(whole, index) {
                    Carries::Sometimes if to_slot => {
                        let flag = carries(whole.analysis.asynchronous.slot(index));
                        carry.extend(quote! { state.#flag = true; });
                    }
                    Carries::Sometimes => {
                        let flag = self.flag(Flag::Gains, c.to.node);
                        carry.extend(quote! { state.#flag = true; });
                    }
                    Carries::Away if !to_slot => {
                        let flag = self.flag(Flag::Loses, c.to.node);
                        away.extend(quote! { state.#flag = true; });
                    }
                    _ => {}
                }
            }
            let Some(present) = present(end).filter(|_| any) else { continue };
            if !away.is_empty() {
                code.extend(quote! { if #present { #away } });
            }
            let deactivates = takes_activity(whole.graph, self.catalog, node);
            if whole.graph.nodes[node].is_delay() {
                let held = self.flag(Flag::Active, node);
                code.extend(quote! { if state.#held.take().is_some() { #carry } });
            } else if whole.analysis.active.contains(&node) && !deactivates {
                let (active, deactivate) = (self.flag(Flag::Active, node), self.deactivate(whole, node));
                let check = self.check_claims();
                code.extend(quote! { if state.#active && #present { #deactivate #carry #check } });
            }
        }
        code
    }
}

/// The flag of the token for a slot: whether it carries activity.
pub fn carries(slot: usize) -> syn::Ident {
    quote::format_ident!("carries_{slot}")
}
