//! Sets of conditions as constants, and the tables over them.

use super::{generator::Generator, view::ProgramView};
use crate::program::{Bits, ClusterRow, MissingRow};
use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};

/// The type of a constant set of conditions.
pub fn set_type(bits: &Bits) -> TokenStream {
    let words = bits.words();
    if is_sparse(bits) { quote!(&[u32]) } else { quote!(::apex_rt::Bits<#words>) }
}

/// A constant set of conditions.
pub fn set(bits: &Bits, of: &[usize]) -> TokenStream {
    let of = list(of);
    if is_sparse(bits) { of } else { quote!(::apex_rt::Bits::of(#of)) }
}

/// Returns `true` if constant sets are lists of numbers, which are smaller than sets of many conditions.
fn is_sparse(bits: &Bits) -> bool {
    const MOST_DENSE: usize = 4;
    bits.words() > MOST_DENSE
}

/// Numbers of conditions in a constant.
fn list(bits: &[usize]) -> TokenStream {
    let bits = bits.iter().copied().map(Literal::usize_unsuffixed);
    quote!(&[#(#bits),*])
}

/// The rows of the table of clusters.
pub fn cluster_rows(view: ProgramView<'_>) -> Vec<TokenStream> {
    let bits = &view.wiring.bits;
    let new = format_ident!("{}", if is_sparse(bits) { "sparse" } else { "dense" });
    let rows = view.program.rows.iter();
    let rows = rows.map(|ClusterRow { enabled, sets, above }| {
        let (sets, enabled) = (sets.iter().map(|bits| list(bits)), Literal::usize_unsuffixed(*enabled));
        let above = above.iter().copied().map(Literal::usize_unsuffixed);
        quote!(Cluster::#new(#enabled, [#(#sets),*], &[#(#above),*]))
    });
    rows.collect()
}

impl Generator<'_> {
    /// The rows of the table of tokens that clusters may miss.
    pub fn missing_rows(&self, view: ProgramView<'_>) -> Vec<TokenStream> {
        let bits = &view.wiring.bits;
        let rows = bits.missing(view.analysis).into_iter().filter_map(|MissingRow { others, token, connection }| {
            let (connection, others) = (self.connection(connection)?, set(bits, &others));
            Some(quote! {
                ::apex_rt::Missing {
                    others: #others,
                    token: #token,
                    connection: #connection,
                }
            })
        });
        rows.collect()
    }
}
