//! Cells between thread groups: what a part does at its ends of them.

use super::{generator::Generator, view::ProgramView};
use crate::{
    graph::{CellEnd, Graph, NodeId, NodeKind, PortId},
    program::{Flag, Receiver, Sender, is_buffer},
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
    pub fn send_far(&self, view: ProgramView<'_>, sender: &Sender) -> TokenStream {
        let Sender { node, end, from, free, token, carries, stamp, settles } = sender;
        let (cell, name) = (cell_name(end.cell), self.name(*from));
        let graph = view.graph;
        let value = match is_buffer(graph, self.catalog, *from) {
            true => quote!(state.#name.get()),
            false => quote!(state.#name.as_ref()),
        };
        let (gains, active) = (self.take(Flag::Gains(*node)), |value| self.set(Flag::Active(*node), value));
        let carried = carries.then(|| {
            let set = active(true);
            quote! { parcel.active = #gains; if parcel.active { #set } }
        });
        let left = carries.then(|| active(false));
        let stamp = stamp.map(|stamp| quote! { parcel.stamp = core.stamps[#stamp]; });
        let settle = settles.map(|row| quote! { self.core.dispatcher.settle(Self::CLUSTERS, #row); });
        let receiver = self.cell(*end).1;
        let store = self.store(graph, *from, &quote!(parcel.token), &value);
        let is_free = self.look(quote!(ends.#cell.is_free()));
        quote! {
            if !self.core.dispatcher.has(#free) && #is_free {
                if self.core.dispatcher.has(#token) {
                    let Self { state, core, .. } = &mut *self;
                    core.dispatcher.clear(#token);
                    ends.#cell.put(|parcel| {
                        #store
                        #carried
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
    pub fn receive_far(&self, view: ProgramView<'_>, receiver: &Receiver) -> TokenStream {
        let Receiver { node, end, free, is_silent, carries, is_stamped, then } = receiver;
        let (cell, holding, sender) = (cell_name(end.cell), Self::holding(end.cell), self.cell(*end).0);
        let name = self.name(PortId { node: *node, port: 0 });
        let told = sender.map(|sender| quote! { wake.wake(#sender); });
        let all_free = quote!(true #(&& self.core.dispatcher.has(#free))*);
        let test = self.allows(view, &[]);
        // Otherwise nothing but a token from the cell occupies the connections.
        let is_all_free = is_silent.then(|| quote!(&& #all_free));
        let carries = carries.then(|| {
            let set = self.set(Flag::Active(*node), true);
            quote! { if ::core::mem::take(&mut parcel.active) { #set } }
        });
        let since = is_stamped.then(|| quote! { let ctx = &ctx.since_oldest([stamp]); });
        let [pass, emit, serve] = then.each_ref().map(|ops| self.ops(view, ops));
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
