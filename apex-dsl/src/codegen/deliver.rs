//! Delivery of slot tokens: from a queue, or in an order that is known at compile time.

use super::{
    Generator,
    activity::ProgramView,
    sets::{set, set_type},
    types::ident,
};
use crate::{
    analyse::{Delivery, ordered},
    graph::{ConnectionId, NodeKind},
};
use proc_macro2::TokenStream;
use quote::quote;

impl Generator<'_> {
    /// Serves slots until none is ready; says whether there was one.
    pub fn serve(&self, view: ProgramView<'_>) -> TokenStream {
        let ProgramView { graph, analysis, wiring, .. } = view;
        let needs: Vec<&[usize]> = wiring.slots.iter().map(|slot| slot.needs.as_slice()).collect();
        let count = needs.len();
        let call = self.slots(view).call();
        let has_needs = needs.iter().any(|needs| !needs.is_empty());
        let ready = match has_needs {
            false => quote!(|_| true),
            true => quote!(|slot| self.core.dispatcher.holds(&Self::NEEDS[slot as usize])),
        };
        let needs_table = has_needs.then(|| {
            let ty = set_type(&wiring.bits);
            let needs = needs.iter().map(|needs| set(&wiring.bits, needs));
            quote! { const NEEDS: &'static [#ty; #count] = &[#(#needs),*]; }
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
                    let Some(slot) = self.core.queue.next(#ready) else { break; };
                    #step
                    #call
                    any = true;
                    #exit
                }
                any
            }
        }
    }

    /// Serves the slots that tokens on `sends` can come to, one after the other, where that needs no queue.
    pub fn deliver(&self, view: ProgramView<'_>, sends: &[ConnectionId]) -> TokenStream {
        let asynchronous = &view.analysis.asynchronous;
        match asynchronous.delivery {
            Delivery::Queued => quote!(),
            Delivery::Single => self.deliver_single(view, sends),
            Delivery::Ordered => {
                let connections = ordered(view.graph, view.links, asynchronous, sends).unwrap_or_default();
                let ends = |c: &ConnectionId| {
                    matches!(view.graph.nodes[view.graph.connections[*c].to.node].kind, NodeKind::Exit(_))
                };
                let last = connections.iter().position(ends).unwrap_or(connections.len());
                let goes_on = |at: usize| (at > last).then(|| quote!(&&self.state.exit.is_none()));
                connections.iter().enumerate().map(|(at, c)| self.serve_one(view, *c, goes_on(at))).collect()
            }
        }
    }

    /// Serves the slot at the end of a connection, if a token waits there and `test` allows it.
    fn serve_one(&self, view: ProgramView<'_>, connection: ConnectionId, test: Option<TokenStream>) -> TokenStream {
        let asynchronous = &view.analysis.asynchronous;
        let slot = asynchronous.slot(connection);
        let waits = self.waits(view.graph, view.graph.connections[connection].from);
        let name = ident(&view.labels.slots[slot]);
        let step = asynchronous.endless.then(|| quote! { self.state.steps.take(#slot); });
        let budget = step.is_some().then(|| quote!(&&!self.state.steps.is_used_up()));
        quote! { if self.#waits #budget #test { #step self.#name(ctx, observer); } }
    }

    /// Delivery where at most one token is in flight. The token may follow a cycle.
    fn deliver_single(&self, view: ProgramView<'_>, sends: &[ConnectionId]) -> TokenStream {
        let (connections, circle) = view.analysis.asynchronous.following(sends);
        let serves: TokenStream = connections.iter().map(|c| self.serve_one(view, *c, None)).collect();
        if !circle {
            return serves;
        }
        let waits = connections.iter().map(|c| {
            let waits = self.waits(view.graph, view.graph.connections[*c].from);
            quote!(self.#waits)
        });
        let exit = self.has_exit(view.graph).then(|| quote!(|| self.state.exit.is_some()));
        quote! {
            while (#(#waits)||*) {
                #serves
                if self.state.steps.is_used_up() #exit { break; }
            }
        }
    }
}
