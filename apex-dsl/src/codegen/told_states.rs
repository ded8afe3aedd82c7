//! Observation of state machines: each state is like a node that is active while the machine is in it.

use super::{generator::Generator, view::ProgramView};
use crate::{
    graph::{Graph, NodeId},
    machine::machines,
};
use proc_macro2::{Literal, TokenStream};
use quote::quote;

impl Generator<'_> {
    /// A call of a state machine, after which observers are told if it is in another state. Other calls stay as they
    /// are.
    pub fn states_told(&self, graph: &Graph, node: NodeId, call: TokenStream) -> TokenStream {
        let Some(first) = self.names.states.get(&node) else { return call };
        let (first, place) = (Literal::usize_unsuffixed(*first), self.node_place(graph, node));
        let state = quote!(#first + #place.state() as usize);
        quote! {
            let left = #state;
            #call
            ::apex_rt::turned(observer, left, #state);
        }
    }

    /// Before the first reaction, each state machine is in its initial state.
    pub fn initial_states(&self) -> TokenStream {
        let states = self.names.states.values().map(|first| Literal::usize_unsuffixed(*first));
        quote! { #(observer.activity(#states, true);)* }
    }

    /// Arms of a `match` that tell for the number of a state if a machine is in it.
    pub fn is_in_state(&self, view: ProgramView<'_>) -> TokenStream {
        let mut arms = quote!();
        for (node, machine) in machines(view.graph, self.catalog) {
            let Some(first) = self.names.states.get(&node) else { continue };
            let (place, last) = (self.node_place(view.graph, node), first + machine.states.len() - 1);
            let [first, last] = [*first, last].map(Literal::usize_unsuffixed);
            arms.extend(quote! { #first..=#last => node == #first + self.#place.state() as usize, });
        }
        arms
    }
}
