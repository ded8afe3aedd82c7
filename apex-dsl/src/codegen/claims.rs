//! Claims about activity that a program looks at while it runs. Where all are decided, nothing is generated for them.

use super::{
    field::{Kind, StateField},
    generator::Generator,
    tokens::ident,
    view::ProgramView,
};
use crate::{
    claims::Decided,
    graph::ScopeId,
    program::{ActiveScope, Broken, ClaimCheck, Spot},
};
use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};
use std::collections::BTreeMap;
use syn::Ident;

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
            .map(|claim| StateField::new(Kind::Claim, text(claim), broken_field(claim), quote!(bool), quote!(false)))
            .collect()
    }

    /// The function that looks at them.
    pub fn claim_function(&self, view: ProgramView<'_>) -> TokenStream {
        let checks = &view.program.claims;
        if checks.is_empty() {
            return quote!();
        }
        let looks = checks.iter().map(|ClaimCheck { claim, broken }| {
            let is_broken = match broken {
                Broken::Several(groups) => {
                    let all = groups.iter().map(|group| self.any(group));
                    quote!([#(#all),*].into_iter().filter(|active| *active).count() > 1)
                }
                Broken::Lost(from, nearer) => {
                    let (from, nearer) = (self.any(from), self.any(nearer));
                    quote!((#from) && !(#nearer))
                }
                Broken::NotConserved(all, given) => {
                    let all = all.iter().map(|spot| self.has_activity(*spot));
                    quote!([#(#all),*].into_iter().filter(|active| *active).count() != #given)
                }
                Broken::Never => quote!(false),
            };
            let name = broken_field(*claim);
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
        let scopes = &view.program.scopes;
        if scopes.is_empty() {
            return quote!();
        }
        let number = |scope: &ScopeId| Literal::usize_unsuffixed(scope.index() - 1);
        let arms = scopes.iter().map(|ActiveScope { scope, own, inner }| {
            let inner = inner.iter().map(number).map(|inner| quote!(self.is_graph_active(#inner)));
            let own = (!own.is_empty()).then(|| self.any(own));
            let (number, active) = (number(scope), own.into_iter().chain(inner));
            quote! { #number => #(#active)||*, }
        });
        quote! {
            fn is_graph_active(&self, graph: usize) -> bool {
                let (state, core) = (&self.state, &self.core);
                match graph { #(#arms)* _ => false }
            }
        }
    }

    /// Expression that is `true` if one of some places has activity.
    fn any(&self, spots: &[Spot]) -> TokenStream {
        let mut of_sets: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
        let mut tests = vec![];
        for spot in spots {
            match *spot {
                Spot::Flag(flag) => {
                    let (set, bit) = self.flag(flag);
                    of_sets.entry(set).or_default().push(bit);
                }
                Spot::Held(_) => tests.push(self.has_activity(*spot)),
            }
        }
        for (set, bits) in of_sets {
            let (set, bits) = (ident(set), bits.into_iter().map(Literal::usize_unsuffixed));
            tests.push(quote!(core.#set.has_any(&[#(#bits),*])));
        }
        if tests.is_empty() { quote!(false) } else { quote!(#(#tests)||*) }
    }

    /// Expression that is `true` if a place has activity.
    pub fn has_activity(&self, spot: Spot) -> TokenStream {
        match spot {
            Spot::Flag(flag) => self.is_set(flag),
            Spot::Held(delay) => {
                let held = self.held_activity(delay);
                quote!(state.#held.holds_any())
            }
        }
    }
}

/// The field that says that a claim is broken.
fn broken_field(claim: usize) -> Ident {
    format_ident!("claim_{claim}")
}
