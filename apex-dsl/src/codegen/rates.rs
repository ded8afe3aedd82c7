//! Clusters of regions with several rates: in one iteration every node fires as often as the balance equations say. The
//! tokens of an iteration are in arrays, and the code of a node runs in a loop over its firings, by number `i`.

use super::emitter::Emitter;
use crate::{
    analyse::Run,
    graph::{NodeId, NodeKind, PortId},
    program::{BlockId, Storage, is_buffer},
    syntax::tree::PortKind,
};
use proc_macro2::TokenStream;
use quote::quote;
use std::collections::BTreeMap;

impl Emitter<'_> {
    /// Declares the array of an output.
    pub fn array(&self, end: PortId) -> TokenStream {
        let (name, size) = (self.generator.name(end), self.count(end.node) * self.graph.port(end).rate);
        quote! { let mut #name = ::core::array::from_fn::<_, #size, _>(|_| None); }
    }

    /// Number of firings in one iteration.
    fn count(&self, node: NodeId) -> usize {
        self.analysis.repetitions[node] as usize
    }

    /// Index of the first token that firing `i` sends.
    pub fn place_in_array(&self, end: PortId) -> TokenStream {
        match self.graph.port(end).rate {
            1 => quote!(i),
            rate => quote!(i * #rate),
        }
    }

    /// The token that arrives at an input in firing `i`, or the array of tokens, as `Option<&T>`.
    pub fn arriving_in_iteration(&self, to: PortId, from: PortId) -> TokenStream {
        let name = self.generator.name(from);
        if self.view.program.lower.is_batched(to) {
            let (rate, copy) = (self.graph.port(to).rate, self.generator.copier(self.graph, from));
            return quote!(::apex_rt::gather::<_, #rate>(&#name, i, #copy).as_ref());
        }
        quote!(#name[i].as_ref())
    }

    /// Puts the value that firing `i` sends into the array of the output. It may be ⊥ if it is `optional`.
    pub fn put_in_array(&self, end: PortId, value: TokenStream, optional: bool) -> TokenStream {
        let name = self.generator.name(end);
        match (self.view.program.lower.is_batched(end), optional) {
            (true, true) => quote! { if let Some(batch) = #value { ::apex_rt::spread(&mut #name, i, batch); } },
            (true, false) => quote! { ::apex_rt::spread(&mut #name, i, #value); },
            (false, true) => quote! { #name[i] = #value; },
            (false, false) => quote! { #name[i] = Some(#value); },
        }
    }

    /// Copies what a node has written in place in firing `i`.
    pub fn copies(&self, node: NodeId) -> TokenStream {
        let ends = (0..self.graph.nodes[node].ports.len()).map(|port| PortId { node, port });
        let written = ends.filter(|end| {
            self.graph.port(*end).kind == PortKind::Output
                && self.plan.is_used(*end)
                && self.plan.storage(*end) == Storage::Array
                && is_buffer(self.graph, self.generator.catalog, *end)
        });
        let copies = written.map(|end| {
            let name = self.generator.name(end);
            let token = self.generator.cloned(self.graph, end, &quote!(state.#name.get()));
            self.put_in_array(end, token, true)
        });
        copies.collect()
    }

    /// All firings of an iteration. If nodes take turns, these are rows of a table.
    pub fn iteration(&self, runs: &[Run], firings: &BTreeMap<NodeId, TokenStream>) -> TokenStream {
        let mut arms: BTreeMap<NodeId, usize> = BTreeMap::new();
        for run in runs {
            let count = arms.len();
            arms.entry(run.node).or_insert(count);
        }
        if arms.len() == runs.len() {
            let loops = runs.iter().map(|Run { node, from, to }| {
                let (from, to, firing) = (*from as usize, *to as usize, &firings[node]);
                quote! { for i in #from..#to { #firing } }
            });
            return loops.collect();
        }
        let turns = runs.iter().map(|Run { node, from, to }| {
            let (arm, from, to) = (arms[node], *from as usize, *to as usize);
            quote!((#arm, #from, #to))
        });
        let count = runs.len();
        let firings = arms.iter().map(|(node, arm)| {
            let firing = &firings[node];
            quote! { #arm => { #firing } }
        });
        quote! {
            const TURNS: [(usize, usize, usize); #count] = [#(#turns),*];
            for (turn, begin, end) in TURNS {
                for i in begin..end {
                    match turn { #(#firings)* _ => {} }
                }
            }
        }
    }

    /// Token `i` of a delay: first those that it holds, then the first ones of this iteration.
    pub fn take_delayed(&self, node: NodeId) -> TokenStream {
        let out = PortId { node, port: 1 };
        let NodeKind::Delay(initial) = &self.graph.nodes[node].kind else { return quote!() };
        let holds = initial.len();
        let (name, held) = (self.generator.name(out), self.generator.held(node));
        let from = self.incoming(PortId { node, port: 0 });
        let newer = from.filter(|_| holds < self.count(node)).map(|from| {
            let source = self.generator.name(from);
            self.generator.cloned(self.graph, from, &quote!(#source[i - #holds].as_ref()))
        });
        match newer {
            None => quote! { #name[i] = state.#held.take_at(i); },
            Some(newer) => quote! { #name[i] = if i < #holds { state.#held.take_at(i) } else { #newer }; },
        }
    }

    /// Puts the tokens of the iteration into a delay when all nodes have fired. Those that it sent already go through
    /// it.
    pub fn hold_iteration(&self, node: NodeId) -> TokenStream {
        let to = PortId { node, port: 0 };
        let (held, count) = (self.generator.held(node), self.count(node));
        let token = self.copied(to, BlockId::OUTERMOST).unwrap_or_else(|| quote!(None));
        quote! { for i in 0..#count { state.#held.put(#token); } }
    }
}
