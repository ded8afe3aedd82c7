//! Thread groups in the description of a program.

use super::tokens::{duration, option};
use crate::graph::{Graph, NodeKind};
use proc_macro2::TokenStream;
use quote::quote;

/// Settings of a group's thread.
pub fn group_info(graph: &Graph, group: &str) -> TokenStream {
    let settings = graph.threads.iter().find(|t| t.group == group).cloned().unwrap_or_default();
    let (cores, priority) = (&settings.cores, option(settings.priority.map(|p| quote!(#p))));
    let (round_robin, strict) = (settings.round_robin, settings.strict);
    let hang = option(settings.hang.map(duration));
    quote! {
        ::apex_rt::GroupInfo {
            name: #group,
            cores: &[#(#cores),*],
            priority: #priority,
            round_robin: #round_robin,
            strict: #strict,
            hang: #hang,
        }
    }
}

/// With which code a program ends when a node hangs, if it does.
pub fn end_if_hung(graph: &Graph) -> TokenStream {
    let code =
        graph.connections.iter().find_map(|c| match (&graph.nodes[c.from.node].kind, &graph.nodes[c.to.node].kind) {
            (NodeKind::Watchdog, NodeKind::Exit(code)) => Some(quote!(#code)),
            _ => None,
        });
    option(code)
}
