//! `cancel` and `resume`: activity is taken out of a node or nested graph, and given back.

use super::{generator::Generator, tokens::ident, view::ProgramView};
use crate::graph::PortId;
use proc_macro2::TokenStream;
use quote::quote;
use syn::Ident;

impl Generator<'_> {
    /// Name of the function of `cancel` or `resume`: `cancel_7`. No other function has such a name.
    pub fn interrupt_function(&self, view: ProgramView<'_>, slot: PortId) -> Ident {
        ident(&format!("{}_{}", view.graph.port(slot).name, slot.node.index()))
    }

    /// The functions of `cancel` and `resume`.
    pub fn interrupts(&self, view: ProgramView<'_>) -> TokenStream {
        let interrupts = &view.program.interrupts;
        if interrupts.is_empty() {
            return quote!();
        }
        let (place, [state, core]) = (self.nodes_type(view), self.state_types(view));
        let functions = interrupts.iter().map(|(end, ops)| {
            let (name, docs) = (self.interrupt_function(view, *end), format!(" `{}`", view.graph.end_name(*end)));
            let body = self.ops(view, ops);
            quote! {
                #[doc = #docs]
                #[allow(unused_variables)]
                fn #name<O: ::apex_rt::Observer>(nodes: &mut #place, state: &mut #state, core: &mut #core, ctx: &::apex_rt::Ctx, observer: &mut O) {
                    #body
                }
            }
        });
        functions.collect()
    }
}
