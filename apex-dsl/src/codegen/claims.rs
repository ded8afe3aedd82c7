//! Positions of activity, including tokens on their way. The program checks undecided claims whenever activity
//! has moved; where all are decided, nothing is generated for them.

use super::{
    Generator,
    activity::ProgramView,
    state::{Kind, StateField},
};
use crate::{
    claims::{Checks, Decided, FROM, Model, NEARER, Place, PlaceId, scopes_of},
    graph::{ClaimKind, Flow},
    program::{Carries, Flag},
};
use proc_macro2::TokenStream;
use quote::{format_ident, quote};
use std::collections::{BTreeMap, BTreeSet};
use syn::Ident;

/// Expression that tells whether there is activity, and the places of the model that it stands for.
struct Flagged {
    test: TokenStream,
    of: BTreeSet<PlaceId>,
}

impl Generator<'_> {
    /// The claim `live`, if the program looks at it.
    pub fn undecided_live(&self) -> Option<usize> {
        self.claims.and_then(Decided::undecided_live)
    }

    /// For each claim that the program looks at, whether it is broken now.
    pub fn claim_state(&self, view: ProgramView<'_>) -> Vec<StateField> {
        let undecided = view.program.lower.undecided().into_iter();
        let text = |claim: usize| view.graph.claim_text(&view.graph.claims[claim]);
        undecided
            .map(|claim| StateField::new(Kind::Claim, text(claim), broken(claim), quote!(bool), quote!(false)))
            .collect()
    }

    /// The function that looks at them.
    pub fn claim_function(&self, view: ProgramView<'_>) -> TokenStream {
        if !view.program.lower.checks_claims() {
            return quote!();
        }
        let model = Model::new(view.graph, self.catalog);
        let checks = Checks::new(view.graph, &model);
        let flags = self.place_flags(view, &model);
        let looks = view.program.lower.undecided().into_iter().map(|claim| {
            let names = |group| any(&flags, &checks.places(claim, group));
            let is_broken = match view.graph.claims[claim].kind {
                ClaimKind::Exclusive => {
                    let all = (0..view.graph.claims[claim].of.len() as u32).map(names);
                    quote!([#(#all),*].into_iter().filter(|active| *active).count() > 1)
                }
                ClaimKind::Reaches => {
                    let (from, nearer) = (names(FROM), names(NEARER));
                    quote!((#from) && !(#nearer))
                }
                // It is not about activity.
                ClaimKind::Live => quote!(false),
                ClaimKind::Conserved => {
                    let (all, given) = (flags.values().map(|flag| &flag.test), model.given);
                    quote!([#(#all),*].into_iter().filter(|active| *active).count() != #given)
                }
            };
            let name = broken(claim);
            quote! {
                let broken = #is_broken;
                if broken && !state.#name {
                    observer.claim_failed(#claim);
                }
                state.#name = broken;
            }
        });
        let [state, core] = self.state_types(view);
        quote! {
            fn check_claims<O: ::apex_rt::Observer>(state: &mut #state, core: &mut #core, observer: &mut O) { #(#looks)* }
        }
    }

    /// Function that tells if a nested graph is active, by its index.
    pub fn is_graph_active(&self, view: ProgramView<'_>) -> TokenStream {
        let graph = view.graph;
        if view.analysis.active.is_empty() || graph.scopes.len() == 1 {
            return quote!();
        }
        let model = Model::new(graph, self.catalog);
        let flags = self.place_flags(view, &model);
        let arms = graph.nested().map(|scope| {
            let inside = (0..).zip(&model.places).filter(|(_, place)| scopes_of(graph, **place).contains(&scope));
            let inside: Vec<PlaceId> = inside.map(|(id, _)| id).collect();
            let (index, active) = (scope.index() - 1, any(&flags, &inside));
            quote! { #index => #active, }
        });
        quote! {
            fn is_graph_active(&self, graph: usize) -> bool {
                let (state, core) = (&self.state, &self.core);
                match graph { #(#arms)* _ => false }
            }
        }
    }

    /// The expressions that say where activity is, by their text.
    fn place_flags(&self, view: ProgramView<'_>, model: &Model) -> BTreeMap<String, Flagged> {
        let mut flags: BTreeMap<String, Flagged> = BTreeMap::new();
        for (place, what) in (0..).zip(&model.places) {
            let flag = match *what {
                Place::Node(node) | Place::Delayed(node, _) => self.is_active_now(view, node),
                Place::Remembered(..) => continue,
                // Nothing is kept for connections that never carry a token.
                Place::Connection(c) if !view.analysis.asynchronous.live[c] => continue,
                Place::Connection(c) if view.program.lower.carries(c) != Carries::Sometimes => continue,
                Place::Connection(c) => {
                    let connection = &view.graph.connections[c];
                    let flag = match view.graph.flow(connection) {
                        Flow::ToSlot => Flag::Carries(view.analysis.asynchronous.slot(c)),
                        Flow::Synchronous | Flow::ToInput => Flag::Gains(connection.to.node),
                    };
                    self.is_set(flag)
                }
            };
            let flagged = Flagged { test: flag.clone(), of: BTreeSet::new() };
            flags.entry(flag.to_string()).or_insert(flagged).of.insert(place);
        }
        flags
    }
}

/// The flag that says that a claim is broken.
fn broken(claim: usize) -> Ident {
    format_ident!("claim_{claim}")
}

/// Expression that is `true` if one of `places` has activity. Flags that also stand for other places are left out.
fn any(flags: &BTreeMap<String, Flagged>, places: &[PlaceId]) -> TokenStream {
    let meant = flags.values().filter(|flag| flag.of.iter().all(|place| places.contains(place)));
    let meant = meant.map(|flag| &flag.test);
    quote!(false #(|| #meant)*)
}
