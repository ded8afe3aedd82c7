//! Tokens of Rust for names, types and values.

use crate::{
    catalog::{Catalog, Type},
    graph::{Number, Value},
};
use proc_macro2::{Literal, TokenStream};
use quote::{ToTokens as _, quote};
use syn::Ident;

/// A path from its segments; an empty first one stands for a leading `::`.
pub fn path(segments: &[String]) -> TokenStream {
    let segments = segments.iter().map(|segment| match segment.as_str() {
        "" => quote!(),
        "crate" => quote!(crate),
        "self" => quote!(self),
        "super" => quote!(super),
        name => ident(name).into_token_stream(),
    });
    quote!(#(#segments)::*)
}

/// An identifier, also where the word is a keyword of Rust. The few that cannot be raw are not names of the language
/// (`syntax::keywords`).
pub fn ident(name: &str) -> Ident {
    let span = proc_macro2::Span::call_site();
    // syn takes `gen` for a name: it is a word since the edition of 2024.
    let plain = syn::parse_str::<Ident>(name).ok().filter(|_| name != "gen");
    plain.unwrap_or_else(|| Ident::new_raw(name, span))
}

/// The type as Rust, if the scan has seen all of it, and generated code can name it.
pub fn to_rust(ty: &Type, catalog: &Catalog) -> Option<TokenStream> {
    let all = |types: &[Type]| types.iter().map(|t| to_rust(t, catalog)).collect::<Option<Vec<_>>>();
    let with = |head: TokenStream, args: &[Type]| {
        let args = all(args)?;
        Some(if args.is_empty() { head } else { quote!(#head<#(#args),*>) })
    };
    match ty {
        Type::Primitive(name) => format!("::core::primitive::{name}").parse().ok(),
        Type::Named(name, args) => match name.as_str() {
            "Vec" => with(quote!(::std::vec::Vec), args),
            "String" => Some(quote!(::std::string::String)),
            "Box" => with(quote!(::std::boxed::Box), args),
            "Option" => with(quote!(::core::option::Option), args),
            _ if catalog.can_name(ty) => with(format!("::{name}").parse().ok()?, args),
            _ => None,
        },
        Type::Measured(number, _) => to_rust(number, catalog),
        Type::Alias(def, ..) => Some(path(catalog.path(*def)?)),
        Type::Def(def, _, args) => with(path(catalog.path(*def)?), args),
        Type::Array(element, Some(len)) => {
            let (element, len): (_, TokenStream) = (to_rust(element, catalog)?, len.parse().ok()?);
            Some(quote!([#element; #len]))
        }
        Type::Tuple(parts) => all(parts).map(|parts| quote!((#(#parts,)*))),
        Type::Unknown(text) if text.parse::<u64>().is_ok() => text.parse().ok(),
        Type::Array(_, None) | Type::Ref(_) | Type::Param(_) | Type::Unknown(_) => None,
    }
}

/// A constant as an expression of type `ty`.
pub fn constant(value: &Value, ty: &Type) -> TokenStream {
    match value {
        Value::Number(n) => match ty.measured_in() {
            Some(unit) => number(&n.in_unit(unit), ty),
            None => number(n, ty),
        },
        Value::Bool(b) => quote!(#b),
        Value::Unit => quote!(()),
        Value::Text(text) if matches!(ty, Type::Named(name, _) if name == "String") => {
            quote!(::std::string::String::from(#text))
        }
        Value::Text(text) => quote!(#text),
        Value::Duration(time) if ty.is_time() => {
            let nanos = nanos(*time);
            quote!(::apex_rt::Time::from_nanos(#nanos))
        }
        Value::Duration(time) => duration(*time),
        Value::Path(segments, _) => path(segments),
        Value::Struct(given) => {
            let (name, by_reference) = (path(&given.path), matches!(ty, Type::Ref(_)));
            let fields = given.fields.iter().map(|field| {
                let (name, value) = (ident(&field.name), constant(&field.value, &field.ty));
                quote!(#name: #value)
            });
            if by_reference { quote!(&#name { #(#fields),* }) } else { quote!(#name { #(#fields),* }) }
        }
        Value::List(items) => {
            let (element, by_reference) = match ty {
                Type::Ref(inner) => (inner.as_ref(), true),
                other => (other, false),
            };
            let unknown = Type::Unknown(String::new());
            let item_type = if let Type::Array(item, _) = element { item } else { &unknown };
            let items = items.iter().map(|item| constant(item, item_type));
            if by_reference { quote!(&[#(#items),*]) } else { quote!([#(#items),*]) }
        }
        Value::RustDefault => quote!(::core::default::Default::default()),
    }
}

fn number(n: &Number, ty: &Type) -> TokenStream {
    let is_integer = ty.is_integer() || !matches!(ty.name(), "f32" | "f64") && !n.is_float;
    let tokens = match n.integer() {
        Some(integer) if is_integer => Literal::i128_unsuffixed(integer.abs()),
        _ => Literal::f64_unsuffixed(n.value.abs()),
    };
    // A negative literal is an operator and a literal.
    if n.value < 0.0 { quote!(-#tokens) } else { quote!(#tokens) }
}

/// A duration as an expression.
pub fn duration(time: std::time::Duration) -> TokenStream {
    let nanos = Literal::u64_unsuffixed(u64::try_from(time.as_nanos()).unwrap_or(u64::MAX));
    quote!(::core::time::Duration::from_nanos(#nanos))
}

/// A time in nanoseconds, of which the runtime's clock counts as many as an `i64` has; what is longer never comes.
pub fn nanos(time: std::time::Duration) -> Literal {
    Literal::i64_unsuffixed(i64::try_from(time.as_nanos()).unwrap_or(i64::MAX))
}

/// `Some` of a value, or `None`.
pub fn option(value: Option<TokenStream>) -> TokenStream {
    value.map_or(quote!(None), |value| quote!(Some(#value)))
}
