//! Cells between thread groups: what a part does at its ends of them.

use super::{Generator, activity::ProgramView, dispatch::free_to_send};
use crate::{
    graph::{CellEnd, Graph, NodeId, NodeKind, PortId},
    program::{Entry, Flag, is_buffer},
    syntax::tree::PortKind,
};
use proc_macro2::TokenStream;
use quote::{format_ident, quote};
use syn::Ident;

/// The cells that a part takes tokens from, with the nodes where they come in.
pub fn receivers(graph: &Graph) -> impl Iterator<Item = (usize, NodeId)> + '_ {
    graph.nodes.iter_enumerated().filter_map(|(id, node)| match node.kind {
        NodeKind::Receiver(far) => Some((far.cell, id)),
        _ => None,
    })
}

/// The field of a cell.
pub fn cell_name(cell: usize) -> Ident {
    format_ident!("cell_{cell}")
}

impl Generator<'_> {
    /// The flag that says that a token from a cell is not done with.
    pub fn holding(cell: usize) -> Ident {
        format_ident!("holding_{cell}")
    }

    /// A token goes into its cell, or the other side is done with it.
    pub fn send_far(&self, view: ProgramView<'_>, node: NodeId, far: CellEnd) -> TokenStream {
        let ProgramView { graph, analysis, links, wiring, .. } = view;
        let bits = &wiring.bits;
        let Some((index, c)) = links.inputs[node].first().map(|c| (*c, &graph.connections[*c])) else {
            return quote!();
        };
        let (Some(free), Some(token)) = (bits.free(index), bits.token(index)) else { return quote!() };
        let (cell, name) = (cell_name(far.cell), self.name(c.from));
        let value = match is_buffer(graph, self.catalog, c.from) {
            true => quote!(state.#name.get()),
            false => quote!(state.#name.as_ref()),
        };
        let active = analysis.active.contains(&node);
        let carries = active.then(|| {
            let (gains, set) = (self.take(Flag::Gains(node)), self.set(Flag::Active(node), true));
            quote! { parcel.active = #gains; if parcel.active { #set } }
        });
        let carries = carries.filter(|_| !far.takes_activity);
        let left = carries.is_some().then(|| self.set(Flag::Active(node), false));
        let stamp = super::stamps::of_connection(view, index).map(|stamp| quote! { parcel.stamp = #stamp; });
        let settle = (graph.port(c.from).kind == PortKind::Output)
            .then(|| bits.row(analysis.cluster_of[c.from.node]))
            .flatten()
            .map(|row| quote! { self.core.dispatcher.settle(Self::CLUSTERS, #row); });
        let receiver = self.cell(far).1;
        let store = self.store(graph, c.from, &quote!(parcel.token), &value);
        let is_free = self.look(quote!(ends.#cell.is_free()));
        quote! {
            if !self.core.dispatcher.has(#free) && #is_free {
                if self.core.dispatcher.has(#token) {
                    let Self { state, core, .. } = &mut *self;
                    core.dispatcher.clear(#token);
                    ends.#cell.put(|parcel| {
                        #store
                        #carries
                        #stamp
                    });
                    wake.wake(#receiver);
                } else {
                    self.core.dispatcher.raise(#free);
                    #settle
                    let Self { state, core, .. } = &mut *self;
                    #left
                    quiet = false;
                }
            }
        }
    }

    /// A token comes out of its cell, or all that it caused has finished.
    pub fn receive_far(&self, view: ProgramView<'_>, node: NodeId, far: CellEnd) -> TokenStream {
        let ProgramView { graph, analysis, links, wiring, .. } = view;
        let end = PortId { node, port: 0 };
        let (cell, holding, name, sender) =
            (cell_name(far.cell), Self::holding(far.cell), self.name(end), self.cell(far).0);
        let told = sender.map(|sender| quote! { wake.wake(#sender); });
        let free = free_to_send(view, node);
        let all_free = quote!(true #(&& self.core.dispatcher.has(#free))*);
        let test = self.allows(view, &[]);
        // Otherwise nothing but a token from the cell occupies the connections.
        let is_silent = wiring.silences.iter().any(|silence| {
            matches!(&silence.entry, Entry::Connection { connection, .. } if graph.connections[*connection].from == end)
        });
        let is_all_free = is_silent.then(|| quote!(&& #all_free));
        let carries = (analysis.active.contains(&node) && !far.takes_activity).then(|| {
            let set = self.set(Flag::Active(node), true);
            quote! { if ::core::mem::take(&mut parcel.active) { #set } }
        });
        let stamped = links.sends[node].iter().any(|c| analysis.stamps.connections.contains(c));
        let since = stamped.then(|| quote! { let ctx = &ctx.since(stamp.min(ctx.now())); });
        let pass = self.ops(view, &view.program.pass_activity(node, &|_| true));
        let emit = self.emitted(view, node);
        let serve = self.deliver(view, &links.sends[node]);
        let is_full = self.look(quote!(ends.#cell.is_full()));
        quote! {
            if self.state.#holding && #all_free {
                self.state.#holding = false;
                ends.#cell.release();
                #told
            }
            if !self.state.#holding #is_all_free && #is_full #test {
                let Self { nodes, state, core, .. } = self;
                let mut stamp = now;
                ends.#cell.take(|parcel| {
                    ::core::mem::swap(&mut state.#name, &mut parcel.token);
                    stamp = parcel.stamp;
                    #carries
                });
                state.#holding = true;
                #since
                #pass
                #emit
                #serve
                quiet = false;
            }
        }
    }

    /// The groups at both ends of a cell.
    fn cell(&self, far: CellEnd) -> (Option<usize>, usize) {
        self.cells.get(far.cell).map_or((None, 0), |cell| (cell.sender, cell.receiver))
    }
}
