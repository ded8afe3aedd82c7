//! Stamps: the times at which the sources of tokens fired, stored where a node needs them; and nodes that are late.

use super::{
    Generator,
    activity::ProgramView,
    state::{Kind, StateField},
    types::duration,
};
use crate::{
    analyse::{ClusterId, Guard},
    graph::{ConnectionId, Graph, NodeId, Standard},
};
use proc_macro2::TokenStream;
use quote::{format_ident, quote};
use syn::Ident;

impl Generator<'_> {
    /// The stamps that a program keeps, with what they start as.
    pub fn stamps(&self, view: ProgramView<'_>) -> Vec<StateField> {
        let sent: Vec<String> =
            view.analysis.stamps.connections.iter().map(|c| view.graph.connection_text(*c)).collect();
        let fired = view.analysis.stamps.clusters.iter().filter(|c| is_left(view, **c));
        let (ty, make) = (quote!(::apex_rt::Time), quote!(::apex_rt::Time::ZERO));
        let fired = fired.map(|c| {
            StateField::new(Kind::Stamp, format!("cluster {}", c.index()), of_cluster(*c), ty.clone(), make.clone())
        });
        let count = sent.len();
        let sent = (count > 0).then(|| {
            let (ty, make) = (quote!([#ty; #count]), quote!([#make; #count]));
            StateField::list(Kind::Stamp, sent, format_ident!("stamps"), ty, make)
        });
        sent.into_iter().chain(fired).collect()
    }

    /// A firing of a cluster is as old as the oldest token that it takes.
    pub fn stamp_of_firing(&self, view: ProgramView<'_>, cluster: ClusterId) -> TokenStream {
        if !view.analysis.stamps.clusters.contains(&cluster) {
            return quote!();
        }
        let c = &view.analysis.clusters[cluster];
        let upstream = c.upstream.iter().map(|up| {
            let name = of_cluster(*up);
            quote!(state.#name)
        });
        let events = c.own_guards.iter().filter_map(|g| match view.analysis.guards[*g] {
            Guard::Token(connection) => of_connection(view, connection),
            _ => None,
        });
        let ages: Vec<TokenStream> = upstream.chain(events).collect();
        let since = (!ages.is_empty()).then(|| quote! { let ctx = &ctx.since(ctx.now() #(.min(#ages))*); });
        let left = is_left(view, cluster).then(|| {
            let name = of_cluster(cluster);
            quote! { state.#name = ctx.stamp(); }
        });
        quote! { #since #left }
    }

    /// Check of a node with a `deadline` when it has finished.
    pub fn check_late(&self, graph: &Graph, node: NodeId) -> TokenStream {
        let Some(deadline) = graph.nodes[node].modifiers.deadline else { return quote!() };
        let (index, deadline) = (self.index(node), duration(deadline));
        let trigger = self.trigger(graph, node, Standard::Late);
        quote! { if ctx.is_late(#index, #deadline, observer) { #trigger } }
    }
}

/// Returns `true` if clusters downstream need the time at which a cluster's source fired.
fn is_left(view: ProgramView<'_>, cluster: ClusterId) -> bool {
    let down = &view.analysis.clusters[cluster].downstream;
    down.iter().any(|c| view.analysis.stamps.clusters.contains(c))
}

/// The place of a connection's stamp in the state, if it is kept.
pub fn of_connection(view: ProgramView<'_>, connection: ConnectionId) -> Option<TokenStream> {
    let index = number(view, connection)?;
    Some(quote!(core.stamps[#index]))
}

/// The number of a connection's stamp, if it is kept.
pub fn number(view: ProgramView<'_>, connection: ConnectionId) -> Option<usize> {
    view.analysis.stamps.connections.iter().position(|c| *c == connection)
}

fn of_cluster(cluster: ClusterId) -> Ident {
    format_ident!("stamp_of_{}", cluster.index())
}
