//! Clusters: what one does as a function, and how a reaction fires them. Many of them are called by number.

use super::{emitter::Emitter, generator::Generator, tokens::ident, view::ProgramView};
use crate::analyse::{ClusterId, MANY};
use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};

/// Clusters that share a function where there are many: rustc takes a time that grows with the square of the size of a
/// function, and each function costs, too.
const CHUNK: usize = 32;

/// Attribute that decides if code is inlined of which there would be `count` pieces: up to `most` of them.
pub fn inlined(count: usize, most: usize) -> TokenStream {
    if count > most { quote!(#[inline(never)]) } else { quote!(#[inline]) }
}

/// Returns `true` if the clusters of a program share functions.
fn share_functions(view: ProgramView<'_>) -> bool {
    view.analysis.clusters.len() > MANY
}

/// The number of the function that a cluster shares with others.
fn chunk(cluster: ClusterId) -> usize {
    cluster.index() / CHUNK
}

/// The call that fires a cluster.
pub fn fire(view: ProgramView<'_>, cluster: ClusterId) -> TokenStream {
    match share_functions(view) {
        true => {
            let (name, cluster) =
                (format_ident!("clusters_{}", chunk(cluster)), Literal::usize_unsuffixed(cluster.index()));
            quote! { self.#name(#cluster, ctx, observer); }
        }
        false => {
            let name = ident(&view.labels.clusters[cluster]);
            quote! { self.#name(ctx, observer); }
        }
    }
}

/// Documentation of a cluster: its nodes, in the order in which they fire.
fn docs(view: ProgramView<'_>, cluster: ClusterId) -> String {
    const MOST: usize = 12;
    let nodes = view.analysis.clusters[cluster].schedule();
    let names = nodes.iter().map(|node| format!("`{}`", view.graph.path(*node)));
    let names: Vec<String> = names.take(MOST).collect();
    let more = if nodes.len() > MOST { format!(", … ({} nodes)", nodes.len()) } else { String::new() };
    format!(" Fires {}{more}.", names.join(", "))
}

impl Generator<'_> {
    /// The functions that fire clusters.
    pub fn clusters(&self, view: ProgramView<'_>) -> TokenStream {
        let firing = view.analysis.clusters.ids().filter(|c| view.analysis.clusters[*c].fires);
        let firing: Vec<ClusterId> = firing.collect();
        if share_functions(view) {
            return firing.chunk_by(|a, b| chunk(*a) == chunk(*b)).map(|chunk| self.chunk(view, chunk)).collect();
        }
        let functions = firing.into_iter().map(|cluster| {
            let (name, code) = (ident(&view.labels.clusters[cluster]), self.cluster(view, cluster));
            let docs = docs(view, cluster);
            quote! {
                #[doc = #docs]
                #[inline]
                fn #name<O: ::apex_rt::Observer>(&mut self, ctx: &::apex_rt::Ctx, observer: &mut O) {
                    let Self { nodes, state, core, inputs, outputs, .. } = self;
                    #code
                }
            }
        });
        functions.collect()
    }

    /// The function that fires the clusters of a chunk.
    fn chunk(&self, view: ProgramView<'_>, clusters: &[ClusterId]) -> TokenStream {
        let name = format_ident!("clusters_{}", chunk(clusters[0]));
        let arms = clusters.iter().map(|cluster| {
            let (number, code) = (Literal::usize_unsuffixed(cluster.index()), self.cluster(view, *cluster));
            quote! { #number => { #code } }
        });
        quote! {
            #[inline(never)]
            fn #name<O: ::apex_rt::Observer>(&mut self, cluster: usize, ctx: &::apex_rt::Ctx, observer: &mut O) {
                let Self { nodes, state, core, inputs, outputs, .. } = self;
                match cluster { #(#arms)* _ => {} }
            }
        }
    }

    fn cluster(&self, view: ProgramView<'_>, cluster: ClusterId) -> TokenStream {
        Emitter::new(self, view, cluster).code()
    }
}

/// A cluster in the code of a reaction.
pub struct FiringCode {
    pub cluster: ClusterId,
    /// Its row in the table of the dispatcher; without one it fires once in a reaction.
    pub row: Option<usize>,
    pub fire: TokenStream,
    /// Slots that are served when it has fired.
    pub served: TokenStream,
}

impl FiringCode {
    /// Code of its own. `slots` is how many there are where steps are counted.
    pub fn straight(&self, slots: Option<usize>, in_loop: bool, exit: Option<&TokenStream>) -> TokenStream {
        let Self { row, fire, served, .. } = self;
        let budget = slots.map(|_| quote!(!self.state.steps.is_used_up()));
        let Some(row) = row else {
            let fire = quote! { #fire #served #exit };
            return match (in_loop, budget) {
                (true, Some(budget)) => quote! { if first && #budget { #fire } },
                (true, None) => quote! { if first { #fire } },
                (false, Some(budget)) => quote! { if #budget { #fire } },
                (false, None) => fire,
            };
        };
        let budget = budget.map(|budget| quote!(#budget &&));
        let step = slots.map(|slots| slots + row).map(|kind| quote! { self.state.steps.take(#kind); });
        quote! {
            if #budget self.core.dispatcher.start(&Self::CLUSTERS[#row]) {
                #step
                #fire
                self.core.dispatcher.finish(Self::CLUSTERS, #row);
                #served #exit
                quiet = false;
            }
        }
    }
}

/// Code for many clusters: all of them by number, in their order, which is that of their rows. There are `all`
/// clusters.
pub fn table(firing: &[FiringCode], all: usize, slots: Option<usize>, exit: Option<&TokenStream>) -> TokenStream {
    let count = firing.len();
    let budget = slots.map(|_| quote! { if self.state.steps.is_used_up() { break; } });
    let step = slots.map(|slots| quote! { self.state.steps.take(#slots + row); });
    let numbers = firing.iter().map(|firing| Literal::usize_unsuffixed(firing.cluster.index()));
    let chunks = 0..all.div_ceil(CHUNK);
    let chunks = chunks.filter(|number| firing.iter().any(|firing| chunk(firing.cluster) == *number)).map(|chunk| {
        let (name, chunk) = (format_ident!("clusters_{chunk}"), Literal::usize_unsuffixed(chunk));
        quote! { #chunk => self.#name(cluster, ctx, observer), }
    });
    let served = served(firing);
    let once = (0..).map(Literal::usize_unsuffixed).zip(firing).filter(|(_, firing)| firing.row.is_none());
    let once: Vec<Literal> = once.map(|(place, _)| place).collect();
    let fire = quote! { match cluster / #CHUNK { #(#chunks)* _ => {} } };
    let body = if once.is_empty() {
        quote! {
            let row = place;
            if !self.core.dispatcher.start(&clusters[row]) { continue; }
            #step
            #fire
            self.core.dispatcher.finish(clusters, row);
            quiet = false;
        }
    } else {
        quote! {
            // Some fire once in a reaction and have no row.
            if matches!(place, #(#once)|*) {
                if !first { continue; }
                #fire
            } else {
                let row = place - [#(#once),*].iter().filter(|once| **once < place).count();
                if !self.core.dispatcher.start(&clusters[row]) { continue; }
                #step
                #fire
                self.core.dispatcher.finish(clusters, row);
                quiet = false;
            }
        }
    };
    quote! {
        const ORDER: [usize; #count] = [#(#numbers),*];
        let clusters: &'static [_] = Self::CLUSTERS;
        for (place, cluster) in ORDER.into_iter().enumerate() {
            #budget
            #body
            #served
            #exit
        }
    }
}

/// The slots that are served when a cluster of a table has fired: from the queue after each, or each its own.
fn served(firing: &[FiringCode]) -> TokenStream {
    let mut all = firing.iter().map(|firing| firing.served.to_string()).filter(|served| !served.is_empty());
    let Some(first) = all.next() else { return quote!() };
    let own = || firing.iter().enumerate().filter(|(_, firing)| !firing.served.is_empty());
    if all.all(|served| served == first) {
        return own().next().map(|(_, firing)| firing.served.clone()).unwrap_or_default();
    }
    let arms = own().map(|(place, FiringCode { served, .. })| {
        let place = Literal::usize_unsuffixed(place);
        quote! { #place => { #served } }
    });
    quote! { match place { #(#arms)* _ => {} } }
}
