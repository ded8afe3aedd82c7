//! Stamps: the times at which the sources of tokens fired, stored where a node needs them; and nodes that are late.

use super::{
    field::{Kind, StateField},
    generator::Generator,
    tokens::duration,
    view::ProgramView,
};
use crate::{
    analyse::ClusterId,
    graph::{ConnectionId, NodeId},
    program::{Deadline, Op},
};
use proc_macro2::TokenStream;
use quote::{format_ident, quote};
use syn::Ident;

impl Generator<'_> {
    /// The stamps that a program keeps, with what they start as.
    pub fn stamps(&self, view: ProgramView<'_>) -> Vec<StateField> {
        let sent: Vec<String> =
            view.analysis.stamps.connections.iter().map(|c| view.graph.connection_text(*c)).collect();
        let fired = view.analysis.stamps.clusters.iter().filter(|c| view.program.lower.leaves_stamp(**c));
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

    /// Check of a node with a `deadline` when it has finished.
    pub fn late(&self, view: ProgramView<'_>, node: NodeId, deadline: Option<Deadline>) -> TokenStream {
        let Some(Deadline { time, event }) = deadline else { return quote!() };
        let (index, time) = (self.index(node), duration(time));
        let trigger = event.map(|event| self.ops(view, &[Op::Trigger(event)]));
        quote! { if ctx.is_late(#index, #time, observer) { #trigger } }
    }
}

/// A firing is as old as the oldest token that it takes: those of clusters, and those with these stamps.
pub fn of_firing(upstream: &[ClusterId], stamps: &[usize], leaves: Option<ClusterId>) -> TokenStream {
    let upstream = upstream.iter().map(|up| {
        let name = of_cluster(*up);
        quote!(state.#name)
    });
    let ages: Vec<TokenStream> = upstream.chain(stamps.iter().map(|index| quote!(core.stamps[#index]))).collect();
    let since = (!ages.is_empty()).then(|| quote! { let ctx = &ctx.since_oldest([#(#ages),*]); });
    let left = leaves.map(|cluster| {
        let name = of_cluster(cluster);
        quote! { state.#name = ctx.stamp(); }
    });
    quote! { #since #left }
}

/// The place of a connection's stamp in the state, if it is kept.
pub fn of_connection(view: ProgramView<'_>, connection: ConnectionId) -> Option<TokenStream> {
    let index = view.program.lower.stamp(connection)?;
    Some(quote!(core.stamps[#index]))
}

fn of_cluster(cluster: ClusterId) -> Ident {
    format_ident!("stamp_of_{}", cluster.index())
}
