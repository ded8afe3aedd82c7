//! When the source fired that a token descends from, kept where somebody asks; and nodes that are late.

use super::{
    Generator,
    activity::Whole,
    state::{Kept, Kind},
    types::duration,
};
use crate::{
    analyse::Guard,
    graph::{Graph, NodeId, Standard},
};
use proc_macro2::TokenStream;
use quote::{format_ident, quote};
use syn::Ident;

impl Generator<'_> {
    /// The stamps that a program keeps, with what they start as.
    pub fn stamps(&self, whole: Whole<'_>) -> Vec<Kept> {
        let sent = whole.analysis.stamps.connections.iter();
        let sent = sent.map(|c| (of_connection(*c), whole.graph.connection_text(*c)));
        let fired = whole.analysis.stamps.clusters.iter().filter(|c| is_left(whole, **c));
        let fired = fired.map(|c| (of_cluster(*c), format!("cluster {c}")));
        let (ty, make) = (quote!(::apex_rt::Time), quote!(::apex_rt::Time::ZERO));
        sent.chain(fired).map(|(name, of)| Kept::new(Kind::Stamp, of, name, ty.clone(), make.clone())).collect()
    }

    /// A firing of a cluster is as old as the oldest token that it takes.
    pub fn stamp_of_firing(&self, whole: Whole<'_>, cluster: usize) -> TokenStream {
        if !whole.analysis.stamps.clusters.contains(&cluster) {
            return quote!();
        }
        let c = &whole.analysis.clusters[cluster];
        let upstream = c.upstream.iter().map(|up| of_cluster(*up));
        let events = c.own_guards.iter().filter_map(|g| match whole.analysis.guards[*g] {
            Guard::Token(connection) => Some(of_connection(connection)),
            _ => None,
        });
        let ages: Vec<Ident> = upstream.chain(events).collect();
        let since = (!ages.is_empty()).then(|| quote! { let ctx = &ctx.since(ctx.now() #(.min(state.#ages))*); });
        let left = is_left(whole, cluster).then(|| {
            let name = of_cluster(cluster);
            quote! { state.#name = ctx.stamp(); }
        });
        quote! { #since #left }
    }

    /// A slot's token is as old as what sent it.
    pub fn stamp_of_slot(&self, whole: Whole<'_>, connection: usize) -> TokenStream {
        if !whole.analysis.stamps.connections.contains(&connection) {
            return quote!();
        }
        let name = of_connection(connection);
        quote! { let ctx = &ctx.since(state.#name); }
    }

    /// A token is sent.
    pub fn stamp_sent(&self, whole: Whole<'_>, connection: usize) -> TokenStream {
        if !whole.analysis.stamps.connections.contains(&connection) {
            return quote!();
        }
        let name = of_connection(connection);
        quote! { state.#name = ctx.stamp(); }
    }

    /// What a node with a `deadline` does when it has finished: it looks whether that was in time.
    pub fn check_late(&self, graph: &Graph, node: NodeId) -> TokenStream {
        let Some(deadline) = graph.nodes[node].modifiers.deadline else { return quote!() };
        let (index, deadline) = (self.index(node), duration(deadline));
        let trigger = self.trigger(graph, node, Standard::Late);
        quote! { if ctx.is_late(#index, #deadline, observer) { #trigger } }
    }
}

/// Whether clusters downstream want to know when a cluster's source fired.
fn is_left(whole: Whole<'_>, cluster: usize) -> bool {
    let down = &whole.analysis.clusters[cluster].downstream;
    down.iter().any(|c| whole.analysis.stamps.clusters.contains(c))
}

pub fn of_connection(connection: usize) -> Ident {
    format_ident!("stamp_{connection}")
}

fn of_cluster(cluster: usize) -> Ident {
    format_ident!("stamp_of_{cluster}")
}
