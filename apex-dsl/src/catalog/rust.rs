//! Small questions to the syntax of Rust.

use quote::{ToTokens, quote};
use syn::{Attribute, GenericParam, Generics, Ident};

/// Name without `r#`, which generated code adds again where Rust needs it.
pub fn plain(name: &Ident) -> String {
    unraw(name.to_string())
}

/// Name without `r#`.
pub fn unraw(name: String) -> String {
    name.strip_prefix("r#").map(str::to_owned).unwrap_or(name)
}

/// Returns `true` for `#[cfg(…)]`.
pub fn is_cfg(attr: &Attribute) -> bool {
    attr.path().is_ident("cfg")
}

/// Smallest and largest number of arguments of a generic type.
pub fn arguments_of(generics: &Generics) -> (usize, usize) {
    let types = generics.params.iter().filter(|p| !matches!(p, GenericParam::Lifetime(_)));
    let has_default = |p: &&GenericParam| match p {
        GenericParam::Type(ty) => ty.default.is_some(),
        GenericParam::Const(value) => value.default.is_some(),
        GenericParam::Lifetime(_) => true,
    };
    let all = types.clone().count();
    (all - types.filter(has_default).count(), all)
}

/// Positions of the arguments of a generic type that are numbers.
pub fn numbers_of(generics: &Generics) -> Vec<usize> {
    let params = generics.params.iter().filter(|p| !matches!(p, GenericParam::Lifetime(_)));
    let numbers = params.enumerate().filter(|(_, p)| matches!(p, GenericParam::Const(_)));
    numbers.map(|(position, _)| position).collect()
}

/// Bounds of type parameters, with the usual spaces.
pub fn bounds(generics: &Generics) -> Vec<String> {
    let declared = generics.type_params().filter(|p| !p.bounds.is_empty()).map(|p| {
        let (name, bounds) = (&p.ident, &p.bounds);
        quote!(#name: #bounds)
    });
    let clauses = generics.where_clause.iter().flat_map(|clause| &clause.predicates).map(ToTokens::to_token_stream);
    let spaced = declared.chain(clauses).map(|bound| bound.to_string());
    let tight = [(" :: ", "::"), (":: ", "::"), (" : ", ": "), (" < ", "<"), (" >", ">"), (" ,", ","), ("& ", "&")];
    spaced.map(|text| tight.iter().fold(text, |text, (wide, narrow)| text.replace(wide, narrow))).collect()
}

/// Names of type parameters and constants.
pub fn generics(generics: &Generics) -> Vec<String> {
    generics
        .params
        .iter()
        .filter_map(|p| match p {
            GenericParam::Type(t) => Some(plain(&t.ident)),
            GenericParam::Const(c) => Some(plain(&c.ident)),
            GenericParam::Lifetime(_) => None,
        })
        .collect()
}

/// The path of `#[path = "…"]`.
pub fn path_value(attr: &Attribute) -> Option<String> {
    match &attr.meta.require_name_value().ok()?.value {
        syn::Expr::Lit(syn::ExprLit { lit: syn::Lit::Str(path), .. }) => Some(path.value()),
        _ => None,
    }
}
