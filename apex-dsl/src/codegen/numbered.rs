//! Functions that do one of many things, by number: what the token of a slot does, and what a timeout does.

use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};
use syn::Ident;

/// Things that share a function. rustc takes a time that grows with the square of the size of a function, and each
/// function costs a few instructions more.
const CHUNK: usize = 128;

/// One of the things.
pub struct Arm {
    pub number: usize,
    pub docs: String,
    pub code: TokenStream,
}

/// All of them.
pub struct Numbered {
    /// Name of the number, and beginning of the names of the functions: `slot`.
    pub name: &'static str,
    /// Number of all things, with those that have no arm.
    pub count: usize,
    pub arms: Vec<Arm>,
    /// Code for those that have no arm.
    pub rest: TokenStream,
}

impl Numbered {
    /// The functions.
    pub fn functions(&self) -> TokenStream {
        let number = format_ident!("{}", self.name);
        let inline = if self.count <= CHUNK { quote!(#[inline(always)]) } else { quote!(#[inline(never)]) };
        let functions = (0..self.count.div_ceil(CHUNK)).map(|chunk| {
            let of_chunk = self.arms.iter().filter(|arm| arm.number / CHUNK == chunk);
            let size = CHUNK.min(self.count - chunk * CHUNK);
            let rest = if of_chunk.clone().count() == size { quote!({}) } else { self.rest.clone() };
            let arms = of_chunk.map(|Arm { number, docs, code }| {
                let number = Literal::usize_unsuffixed(*number);
                quote! { #[doc = #docs] #number => { #code } }
            });
            let name = self.function(chunk);
            quote! {
                #inline
                fn #name<O: ::apex_rt::Observer>(&mut self, #number: u16, ctx: &::apex_rt::Ctx, observer: &mut O) {
                    let Self { nodes, state, core, inputs, outputs, events } = self;
                    match #number { #(#arms)* _ => #rest }
                }
            }
        });
        functions.collect()
    }

    /// Does the thing with the number that the variable of that name holds.
    pub fn call(&self) -> TokenStream {
        let number = format_ident!("{}", self.name);
        let call = |chunk| {
            let name = self.function(chunk);
            quote!(self.#name(#number, ctx, observer))
        };
        let chunks = self.count.div_ceil(CHUNK);
        if chunks == 1 {
            let call = call(0);
            return quote! { #call; };
        }
        let arms = (0..chunks).map(|chunk| {
            let (number, call) = (Literal::usize_unsuffixed(chunk), call(chunk));
            quote! { #number => #call, }
        });
        let size = Literal::usize_unsuffixed(CHUNK);
        quote! { match #number / #size { #(#arms)* _ => {} } }
    }

    fn function(&self, chunk: usize) -> Ident {
        match self.count <= CHUNK {
            true => format_ident!("{}", self.name),
            false => format_ident!("{}s_{chunk}", self.name),
        }
    }
}
