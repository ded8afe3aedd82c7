//! `#[node]`: keeps the item except for its attributes, and adds the implementations that generated code uses.

use apex_signature::{self as signature, Arg, Callable, Form, METHOD_MARKS, ParamDecl};
use proc_macro2::{Ident, Literal, Span, TokenStream};
use quote::{ToTokens, format_ident, quote};
use syn::{
    Expr, FnArg, Generics, ImplItem, Item, ItemFn, ItemImpl, ItemStruct, Type, TypeParamBound, Visibility,
    spanned::Spanned as _,
};

/// Expands `#[node]` on a function, a struct or an `impl`.
pub fn expand(args: TokenStream, item: TokenStream) -> syn::Result<TokenStream> {
    if !args.is_empty() {
        return Err(syn::Error::new_spanned(args, "`#[node]` takes no arguments: the signature is the interface"));
    }
    match syn::parse2(item)? {
        Item::Fn(item) => function(item),
        Item::Struct(item) => structure(item),
        Item::Impl(item) => implementation(item),
        other => Err(syn::Error::new_spanned(
            other,
            "`#[node]` can only mark a function, a struct, or the `impl` of a struct",
        )),
    }
}

/// Expands a function. It keeps its name; a type of the same name has the types of its ports.
fn function(mut item: ItemFn) -> syn::Result<TokenStream> {
    let callable = signature::function(&item)?;
    ask_for_text(&item.sig, &mut item.block);
    remove_marks(&mut item.sig, &["param", signature::FAILURE, signature::UNIT]);
    item.attrs.retain(|a| {
        ![signature::UNIT, signature::COMPUTED, signature::KEEPS_FRAME].iter().any(|mark| a.path().is_ident(mark))
    });
    let (vis, name, generics) = (&item.vis, &item.sig.ident, &signature::generics(&item, &callable));
    let (impl_generics, type_args, bounds) = generics.split_for_impl();
    let phantom: Vec<&Ident> = generics.type_params().map(|p| &p.ident).collect();
    let unbound = unbound(generics);
    let ports = ports(&callable, &quote!(#impl_generics), &quote!(#name #type_args), &quote!(#bounds));
    let events: Vec<&Type> =
        callable.args.iter().filter_map(|a| if let Form::Event(ty, _) = &a.form { Some(ty) } else { None }).collect();
    let events = triggers(&events, &quote!(#impl_generics), &quote!(#name #type_args), &quote!(#bounds));
    let decls: Vec<&ParamDecl> =
        callable.args.iter().filter_map(|a| if let Form::Param(p) = &a.form { Some(&**p) } else { None }).collect();
    let names: Vec<Ident> = callable.args.iter().filter(|a| matches!(a.form, Form::Param(_))).map(ident).collect();
    let params = params(&decls, &names, generics, &quote!(#name #type_args));
    // An input of type `Vec<T>` is taken as `&Vec<T>`, the type that is sent, and a node may have many ports.
    Ok(quote! {
        #[inline]
        #[allow(clippy::ptr_arg, clippy::too_many_arguments)]
        #item

        #[doc(hidden)]
        #[allow(non_camel_case_types)]
        #vis struct #name #unbound { _ports: ::core::marker::PhantomData<fn() -> (#(#phantom,)*)> }
        #ports
        #events
        #params
    })
}

/// Lets rustc say at the type of a node's error that it has no text.
fn ask_for_text(function: &syn::Signature, body: &mut syn::Block) {
    if let Some(error) = signature::error_type(&function.output) {
        body.stmts.insert(0, syn::parse_quote_spanned!(error.span()=> const { ::apex_rt::explains::<#error>() };));
    }
}

/// Removes attributes of arguments that only `#[node]` knows.
fn remove_marks(function: &mut syn::Signature, marks: &[&str]) {
    for arg in &mut function.inputs {
        if let FnArg::Typed(arg) = arg {
            arg.attrs.retain(|a| !marks.iter().any(|mark| a.path().is_ident(mark)));
        }
    }
}

/// Returns the type parameters without bounds: a type that does not satisfy them can still be named, so that rustc can
/// check the bounds.
fn unbound(generics: &Generics) -> Generics {
    let mut unbound = Generics { where_clause: None, ..generics.clone() };
    let is_relaxed = |bound: &TypeParamBound| matches!(bound, TypeParamBound::Trait(bound) if bound.maybe.is_some());
    for param in unbound.type_params_mut() {
        param.bounds = std::mem::take(&mut param.bounds).into_iter().filter(is_relaxed).collect();
    }
    unbound
}

/// Expands a struct. It gets a constructor from its parameters, in which all other fields have their defaults.
fn structure(mut item: ItemStruct) -> syn::Result<TokenStream> {
    let declared = signature::params(&item)?;
    let fields: Vec<Ident> = declared.iter().map(|(name, ..)| (*name).clone()).collect();
    let decls: Vec<&ParamDecl> = declared.iter().map(|(.., decl)| decl).collect();
    let types: Vec<&Type> = decls.iter().map(|d| &d.ty).collect();
    let name = &item.ident;
    let (impl_generics, type_args, bounds) = item.generics.split_for_impl();
    let params = params(&decls, &fields, &item.generics, &quote!(#name #type_args));
    let accessors = fields.iter().enumerate().map(|(i, field)| {
        quote! {
            #[allow(deprecated)]
            impl #impl_generics ::apex_rt::ParamField<#i> for #name #type_args #bounds {
                #[inline(always)]
                fn field(&mut self) -> &mut Self::Value { &mut self.#field }
            }
        }
    });
    let state: Vec<&Ident> =
        item.fields.iter().filter_map(|f| f.ident.as_ref()).filter(|name| !fields.contains(name)).collect();
    // Numbers instead of names, which may collide with user code: a tuple struct of the same name would be a pattern.
    let numbers: Vec<syn::Index> = (0..fields.len()).map(syn::Index::from).collect();
    let constructor = match &item.fields {
        syn::Fields::Named(_) => {
            quote!(Self { #(#fields: apex_params.#numbers,)* #(#state: ::apex_rt::Fresh::fresh(),)* })
        }
        syn::Fields::Unit => quote!(Self),
        syn::Fields::Unnamed(_) => {
            return Err(syn::Error::new_spanned(&item.fields, "the fields of a node must have names"));
        }
    };
    // Without `Default` for all of its state a node cannot be constructed by a graph, only passed to it. The lifetime
    // defers the check until a graph constructs the node.
    let state_types =
        item.fields.iter().filter(|f| f.ident.as_ref().is_some_and(|n| !fields.contains(n))).map(|f| &f.ty);
    let mut where_fresh = item.generics.clone();
    let clause = where_fresh.make_where_clause();
    for ty in state_types {
        clause.predicates.push(syn::parse_quote!(for<'fresh> #ty: ::apex_rt::Fresh<'fresh>));
    }
    let bounds = &where_fresh.where_clause;
    let make = quote! {
        #[allow(deprecated)]
        impl #impl_generics ::apex_rt::Construct<(#(#types,)*)> for #name #type_args #bounds {
            #[inline]
            fn construct(#[allow(unused)] apex_params: (#(#types,)*)) -> Self { #constructor }
        }
    };
    let units = decls.iter().map(|decl| option(decl.si_unit()));
    let ranges = decls.iter().map(|decl| range(decl));
    let own_bounds = &item.generics.where_clause;
    let table = quote! {
        #[allow(deprecated)]
        impl #impl_generics ::apex_rt::Params for #name #type_args #own_bounds {
            const DECLARED: &'static [::apex_rt::params::Declared] = &[#(::apex_rt::params::Declared::new(#units, #ranges)),*];
        }
    };
    for field in &mut item.fields {
        field.attrs.retain(|a| !a.path().is_ident("param"));
    }
    let marks = [signature::DEACTIVATES, signature::COMPUTED, signature::KEEPS_FRAME];
    item.attrs.retain(|a| !marks.iter().any(|mark| a.path().is_ident(mark)));
    Ok(quote! {
        #item
        #params
        #table
        #(#accessors)*
        #make
    })
}

/// Expands an `impl`. The methods that a graph calls become public; the rest stays as it is.
fn implementation(mut item: ItemImpl) -> syn::Result<TokenStream> {
    if let Some((path, _)) = &item.trait_ {
        return Err(syn::Error::new_spanned(
            path,
            "`#[node]` can only mark the inherent `impl` of a node, not that of a trait",
        ));
    }
    let methods = signature::methods(&item)?;
    for member in &mut item.items {
        let ImplItem::Fn(method) = member else { continue };
        let marks = METHOD_MARKS.iter().any(|mark| signature::marked(&method.attrs, mark));
        if method.sig.ident != "process" && !marks {
            continue;
        }
        ask_for_text(&method.sig, &mut method.block);
        method.attrs.retain(|a| !METHOD_MARKS.iter().chain(&[signature::UNIT]).any(|mark| a.path().is_ident(mark)));
        remove_marks(&mut method.sig, &[signature::FAILURE, signature::UNIT]);
        method.attrs.push(syn::parse_quote!(#[allow(clippy::ptr_arg, clippy::too_many_arguments)]));
        if !signature::marked(&method.attrs, "inline") {
            method.attrs.push(syn::parse_quote!(#[inline]));
        }
        if matches!(method.vis, Visibility::Inherited) {
            method.vis = syn::parse_quote!(pub);
            if signature::docs(&method.attrs).is_empty() {
                method.attrs.push(syn::parse_quote!(#[doc(hidden)]));
            }
        }
    }
    let (impl_generics, _, bounds) = item.generics.split_for_impl();
    let self_type = &item.self_ty;
    let mut events: Vec<(&str, &Type)> = vec![];
    for (name, ty) in methods.events() {
        if events.iter().all(|(known, _)| *known != name) {
            events.push((name, ty));
        }
    }
    let events: Vec<&Type> = events.into_iter().map(|(_, ty)| ty).collect();
    let events = triggers(&events, &quote!(#impl_generics), &quote!(#self_type), &quote!(#bounds));
    let unit: Type = syn::parse_quote!(());
    let slots = methods.slots.iter().enumerate().map(|(i, slot)| {
        let ty = slot.token.as_ref().unwrap_or(&unit);
        quote! {
            #[allow(deprecated)]
            impl #impl_generics ::apex_rt::Slot<#i> for #self_type #bounds { type Token = #ty; }
        }
    });
    let slots = quote! { #(#slots)* };
    let ports = methods
        .process
        .as_ref()
        .map(|process| ports(process, &quote!(#impl_generics), &quote!(#self_type), &quote!(#bounds)));
    Ok(quote! {
        #item
        #ports
        #events
        #slots
    })
}

/// Implements the traits for the types of a node's ports (`apex_rt::Input`, `apex_rt::Output`).
fn ports(callable: &Callable, generics: &TokenStream, node: &TokenStream, bounds: &TokenStream) -> TokenStream {
    let inputs =
        callable.args.iter().filter_map(|a| if let Form::Input(i) = &a.form { Some(&i.token.ty) } else { None });
    let outs = callable.args.iter().filter_map(|a| if let Form::Out(t) = &a.form { Some(&t.ty) } else { None });
    let outputs = outs.chain(callable.returns.token.as_ref().map(|t| &t.ty));
    let inputs = inputs.enumerate().map(|(i, ty)| {
        quote! {
            #[allow(deprecated)]
            impl #generics ::apex_rt::Input<#i> for #node #bounds { type Token = #ty; }
        }
    });
    let outputs = outputs.enumerate().map(|(i, ty)| {
        quote! {
            #[allow(deprecated)]
            impl #generics ::apex_rt::Output<#i> for #node #bounds { type Token = #ty; }
        }
    });
    quote! { #(#inputs)* #(#outputs)* }
}

/// Implements the trait for the types of a node's events (`apex_rt::Trigger`).
fn triggers(events: &[&Type], generics: &TokenStream, node: &TokenStream, bounds: &TokenStream) -> TokenStream {
    let events = events.iter().enumerate().map(|(i, ty)| {
        quote! {
            #[allow(deprecated)]
            impl #generics ::apex_rt::Trigger<#i> for #node #bounds { type Token = #ty; }
        }
    });
    quote! { #(#events)* }
}

/// Implements the trait for the types of a node's parameters (`apex_rt::Param`), and functions for their defaults.
fn params(decls: &[&ParamDecl], names: &[Ident], generics: &Generics, node: &TokenStream) -> TokenStream {
    let (impl_generics, _, bounds) = generics.split_for_impl();
    let impls = decls.iter().enumerate().map(|(i, decl)| {
        let ty = &decl.ty;
        let accepts = match &decl.range {
            Some(range) => quote! { (#range).contains(apex_value) },
            None => quote! { { let _ = apex_value; true } },
        };
        quote! {
            #[allow(deprecated)]
            impl #impl_generics ::apex_rt::Param<#i> for #node #bounds {
                type Value = #ty;
                #[inline]
                fn accepts(apex_value: &Self::Value) -> bool { #accepts }
            }
        }
    });
    let defaults = decls.iter().zip(names).filter_map(|(decl, name)| {
        let (ty, default) = (&decl.ty, default_value(decl)?);
        let function = format_ident!("apex_default_{name}");
        Some(quote! {
            #[doc(hidden)]
            pub fn #function() -> #ty { #default }
        })
    });
    quote! {
        #(#impls)*
        #[allow(deprecated)]
        impl #impl_generics #node #bounds { #(#defaults)* }
    }
}

/// The range of a parameter, as far as it is written in plain numbers.
fn range(decl: &ParamDecl) -> TokenStream {
    let (min, max, inclusive) = decl.limits().unwrap_or_default();
    let [min, max] = [min, max].map(|bound| option(bound.and_then(float)));
    quote!(::apex_rt::params::ParamRange::new(#min, #max, #inclusive))
}

/// Number as an expression, if a literal can hold it.
fn float(value: f64) -> Option<TokenStream> {
    let literal = value.is_finite().then(|| Literal::f64_unsuffixed(value.abs()))?;
    Some(if value < 0.0 { quote!(-#literal) } else { quote!(#literal) })
}

fn option(value: Option<impl ToTokens>) -> TokenStream {
    value.map_or(quote!(::core::option::Option::None), |value| quote!(::core::option::Option::Some(#value)))
}

fn default_value(decl: &ParamDecl) -> Option<TokenStream> {
    let default: &Expr = decl.default.as_ref()?;
    Some(if decl.is_duration() && matches!(default, Expr::Lit(_)) {
        quote! { ::core::time::Duration::from_secs_f64(f64::from(#default)) }
    } else {
        quote! { #default }
    })
}

fn ident(arg: &Arg) -> Ident {
    Ident::new(&arg.name, Span::call_site())
}
