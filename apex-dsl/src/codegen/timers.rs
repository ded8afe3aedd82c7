//! Time: the timers of sources, the timeouts of nodes, and when a program wants to be called because of them.

use super::{
    Generator,
    activity::ProgramView,
    clusters::inlined,
    state::{Kind, StateField},
    types::{ident, nanos},
    wiring::Flag,
};
use crate::{
    analyse::{Analysis, is_source},
    graph::{Graph, NodeId, Standard},
};
use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};
use std::time::Duration;

impl Generator<'_> {
    /// The `timeout` of a node, if it can come.
    pub fn timeout(&self, graph: &Graph, analysis: &Analysis, node: NodeId) -> Option<Duration> {
        let timeout = graph.nodes[node].modifiers.timeout?;
        let comes = analysis.active.contains(&node) || self.watches_silence(graph, analysis, node).is_some();
        comes.then_some(timeout)
    }

    /// The `timeout` of a source that activity never comes to: so long it may send nothing.
    pub fn watches_silence(&self, graph: &Graph, analysis: &Analysis, node: NodeId) -> Option<Duration> {
        let watches = is_source(graph, self.catalog, &analysis.links, node) && !analysis.active.contains(&node);
        graph.nodes[node].modifiers.timeout.filter(|_| watches)
    }

    /// The time of a source's silence begins.
    pub fn watch_silence(&self, view: ProgramView<'_>, node: NodeId) -> TokenStream {
        match self.watches_silence(view.graph, view.analysis, node) {
            Some(_) => self.start_timeout(view, node),
            None => quote!(),
        }
    }

    /// Timers and timeouts in the state of a program.
    pub fn timer_state(&self, view: ProgramView<'_>) -> Vec<StateField> {
        let ProgramView { graph, wiring, .. } = view;
        let mut kept = vec![];
        let of = |nodes: &mut dyn Iterator<Item = NodeId>| nodes.map(|node| graph.path(node)).collect();
        if !wiring.timers.is_empty() {
            let timers = wiring.timers.iter().map(|(node, _)| {
                let modifiers = &graph.nodes[*node].modifiers;
                let first = nanos(modifiers.after.unwrap_or_default());
                let period = nanos(modifiers.every.unwrap_or(Duration::MAX));
                quote!(::apex_rt::Timer::new(#first, #period))
            });
            let (count, make) = (wiring.timers.len(), quote!([#(#timers),*]));
            let of = of(&mut wiring.timers.iter().map(|(node, _)| *node));
            kept.push(StateField::list(
                Kind::Timer,
                of,
                format_ident!("timers"),
                quote!([::apex_rt::Timer; #count]),
                make,
            ));
        }
        if !wiring.timeouts.is_empty() {
            let count = wiring.timeouts.len();
            let (ty, make) =
                (quote!([::apex_rt::Timeout; #count]), quote!([const { ::apex_rt::Timeout::new() }; #count]));
            let of = of(&mut wiring.timeouts.iter().map(|timeout| timeout.node));
            kept.push(StateField::list(Kind::Timer, of, format_ident!("timeouts"), ty, make));
        }
        kept
    }

    /// A timer changes.
    pub fn open_agenda(&self, view: ProgramView<'_>) -> Option<TokenStream> {
        view.wiring.has_agenda().then(|| quote! { state.agenda.open(); })
    }

    /// The time of a node's `timeout` begins, if it has one.
    pub fn start_timeout(&self, view: ProgramView<'_>, node: NodeId) -> TokenStream {
        let Some(index) = view.wiring.timeout(node) else { return quote!() };
        let after = nanos(view.wiring.timeouts[index].after);
        let open = self.open_agenda(view);
        quote! { state.timeouts[#index].start(ctx.now(), ::core::time::Duration::from_nanos(#after)); #open }
    }

    /// The time of a node's `timeout` ends.
    pub fn stop_timeout(&self, view: ProgramView<'_>, node: NodeId) -> TokenStream {
        let Some(index) = view.wiring.timeout(node) else { return quote!() };
        let open = self.open_agenda(view);
        quote! { state.timeouts[#index].stop(); #open }
    }

    /// The guards of timers that are due hold.
    pub fn timers_due(&self, view: ProgramView<'_>) -> TokenStream {
        let timers = &view.wiring.timers;
        if timers.is_empty() {
            return quote!();
        }
        if view.wiring.has_agenda() {
            let bits = timers.iter().map(|(_, bit)| Literal::usize_unsuffixed(*bit));
            return quote! {
                for (timer, bit) in self.state.timers.iter().zip([#(#bits),*]) {
                    if timer.is_due(now) { self.state.dispatcher.raise(bit); }
                }
            };
        }
        let looks = timers.iter().enumerate().map(|(index, (_, bit))| {
            quote! { if self.state.timers[#index].is_due(now) { self.state.dispatcher.raise(#bit); } }
        });
        looks.collect()
    }

    /// When a program wants to be called because of its timers.
    pub fn wishes(&self, view: ProgramView<'_>) -> TokenStream {
        let wiring = view.wiring;
        if !wiring.has_agenda() {
            let wish = |list: &str, count: usize| -> TokenStream {
                let list = format_ident!("{list}");
                (0..count).map(|index| quote! { next = next.or(self.state.#list[#index].wish(now)); }).collect()
            };
            return [wish("timers", wiring.timers.len()), wish("timeouts", wiring.timeouts.len())]
                .into_iter()
                .collect();
        }
        let of_timers = (!wiring.timers.is_empty()).then(|| {
            quote! { for timer in &self.state.timers { wish = wish.or(timer.wish(now)); } }
        });
        let of_timeouts = (!wiring.timeouts.is_empty()).then(|| {
            quote! {
                for timeout in &self.state.timeouts {
                    wish = wish.or(timeout.wish(now));
                    held_back |= timeout.is_due(now);
                }
            }
        });
        quote! {
            if self.state.agenda.is_due(now) {
                let (mut wish, mut held_back) = (::apex_rt::Next::Input, false);
                #of_timers
                #of_timeouts
                self.state.agenda.close(wish, held_back);
            }
            next = next.or(self.state.agenda.wish());
        }
    }

    /// Tests whether a node was active for as long as its `timeout` says. A node that is disabled sends nothing; it
    /// does so when it is enabled, if it is still active.
    pub fn expires(&self, view: ProgramView<'_>, index: usize) -> TokenStream {
        let timeout = &view.wiring.timeouts[index];
        let expire = ident(&timeout.name);
        let mut test = self.allows(view, &timeout.needs);
        if view.graph.nodes[timeout.node].can_be_disabled() {
            let is_enabled = self.is_set(Flag::Enabled(timeout.node));
            test.extend(quote!(&& self.#is_enabled));
        }
        quote! { if self.state.timeouts[#index].is_due(now) #test { self.#expire(ctx, observer); quiet = false; } }
    }

    /// For each timeout the function that triggers its event, with the activity of the node.
    pub fn expire_functions(&self, view: ProgramView<'_>) -> TokenStream {
        let inline = inlined(view.wiring.timeouts.len());
        (0..view.wiring.timeouts.len()).map(|index| self.expire(view, index, &inline)).collect()
    }

    fn expire(&self, view: ProgramView<'_>, index: usize, inline: &TokenStream) -> TokenStream {
        let (graph, timeout) = (view.graph, &view.wiring.timeouts[index]);
        let (node, expire) = (timeout.node, ident(&timeout.name));
        let docs = format!(" `timeout` of `{}`, {}.", graph.path(node), self.line(graph.nodes[node].span));
        let (clear, open) = (self.clear_events(view, node), self.open_agenda(view));
        let trigger = self.trigger(graph, node, Standard::Timeout);
        let pass = self.pass_activity(view, node, &|end| {
            let standard = graph.port(end).standard;
            let sent = matches!(standard, Some(Standard::Timeout | Standard::Deactivated));
            self.sent_event(view, end).filter(|_| sent)
        });
        let emit = self.emit(view, node, false);
        let serve = self.deliver(view, &view.links.sends[node]);
        quote! {
            #[doc = #docs]
            #inline
            fn #expire<O: ::apex_rt::Observer>(&mut self, ctx: &::apex_rt::Ctx, observer: &mut O) {
                let Self { nodes, state, .. } = self;
                state.timeouts[#index].stop();
                #open #clear #trigger #pass #emit #serve
            }
        }
    }
}
