//! `#[derive(Outputs)]` and `#[derive(Units)]`.

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
    named.iter().try_for_each(|field| apex_signature::unit(&field.attrs).map(drop))?;
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

/// Checks the form of the units. Only the compiler of Apex reads them.
pub fn units(item: TokenStream) -> syn::Result<TokenStream> {
    let input: DeriveInput = syn::parse2(item)?;
    let Data::Struct(data) = &input.data else {
        return Err(syn::Error::new(input.ident.span(), "only the fields of structs have units"));
    };
    data.fields.iter().try_for_each(|field| apex_signature::unit(&field.attrs).map(drop))?;
    Ok(TokenStream::new())
}
