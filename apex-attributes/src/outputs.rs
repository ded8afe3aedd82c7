//! `#[derive(Outputs)]`.

use proc_macro2::TokenStream;
use quote::quote;
use syn::{Data, DeriveInput, Fields};

/// Implements `Field<I>` for each field.
pub fn expand(item: TokenStream) -> syn::Result<TokenStream> {
    let input: DeriveInput = syn::parse2(item)?;
    let named = match &input.data {
        Data::Struct(data) => match &data.fields {
            Fields::Named(named) => &named.named,
            _ => {
                return Err(syn::Error::new(
                    input.ident.span(),
                    "`Outputs` needs named fields: their names are the ports",
                ));
            }
        },
        _ => return Err(syn::Error::new(input.ident.span(), "`Outputs` can only be derived for structs")),
    };
    let name = &input.ident;
    let (generics, args, bounds) = input.generics.split_for_impl();
    let fields = named.iter().enumerate().map(|(i, field)| {
        let ty = apex_signature::option_of(&field.ty).unwrap_or(&field.ty);
        quote! {
            impl #generics ::apex_rt::Field<#i> for #name #args #bounds { type Token = #ty; }
        }
    });
    Ok(quote! { #(#fields)* })
}
