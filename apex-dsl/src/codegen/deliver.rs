//! Delivery of slot tokens: from a queue, or in an order that is known at compile time.

use super::{
    clusters::inlined,
    generator::Generator,
    sets::{set, set_type},
    tokens::ident,
    view::ProgramView,
};
use proc_macro2::TokenStream;
use quote::quote;

/// Maximum number of copies of slots in the code of a reaction. rustc takes a time that grows with the square of the
/// size of a function.
const MOST_COPIES: usize = 128;

impl Generator<'_> {
    /// Serves slots until none is ready; says whether there was one.
    pub fn serve(&self, view: ProgramView<'_>) -> TokenStream {
        let ProgramView { graph: _, analysis, wiring, .. } = view;
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
        let exit = view.program.lower.has_exit().then(|| quote! { if self.state.exit.is_some() { break; } });
        // Each cluster serves what it has sent.
        let inline = inlined(count * (analysis.clusters.len() + 1), MOST_COPIES);
        quote! {
            #needs_table
            #inline
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

    /// Serves a slot if a token waits there, unless the program ends if `unless_exit`.
    pub fn serve_one(&self, view: ProgramView<'_>, slot: usize, unless_exit: bool) -> TokenStream {
        let waits = self.waits(view.graph, view.graph.connections[view.wiring.slots[slot].connection].from);
        let name = ident(&view.labels.slots[slot]);
        let step = view.analysis.asynchronous.endless.then(|| quote! { self.state.steps.take(#slot); });
        let budget = step.is_some().then(|| quote!(&&!self.state.steps.is_used_up()));
        let test = unless_exit.then(|| quote!(&&self.state.exit.is_none()));
        quote! { if self.#waits #budget #test { #step self.#name(ctx, observer); } }
    }

    /// Serves slots for as long as a token waits for one of them: it may follow a circle.
    pub fn serve_circle(&self, view: ProgramView<'_>, slots: &[usize]) -> TokenStream {
        let serves = slots.iter().map(|slot| self.serve_one(view, *slot, false));
        let waits = slots.iter().map(|slot| {
            let waits = self.waits(view.graph, view.graph.connections[view.wiring.slots[*slot].connection].from);
            quote!(self.#waits)
        });
        let exit = view.program.lower.has_exit().then(|| quote!(|| self.state.exit.is_some()));
        quote! {
            while (#(#waits)||*) {
                #(#serves)*
                if self.state.steps.is_used_up() #exit { break; }
            }
        }
    }
}
