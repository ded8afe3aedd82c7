//! Traits that a type has, by `derive` or by an `impl` beside it.

use super::rust::{bounds, is_cfg, plain};
use serde::{Deserialize, Serialize};
use syn::{Attribute, GenericArgument, GenericParam, Generics, Item as Syn, PathArguments, Type};

/// A trait that a type has.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct TraitOf {
    /// Last segment of its path.
    pub name: String,
    /// `true` if the type has it only with type arguments that have it, too.
    pub of_arguments: bool,
}

/// The traits that a type derives.
pub fn derived(attrs: &[Attribute]) -> Vec<TraitOf> {
    let lists = attrs.iter().filter(|a| a.path().is_ident("derive")).filter_map(|a| {
        a.parse_args_with(syn::punctuated::Punctuated::<syn::Path, syn::Token![,]>::parse_terminated).ok()
    });
    let names = lists.flatten().filter_map(|path| path.segments.last().map(|segment| plain(&segment.ident)));
    names.map(|name| TraitOf { name, of_arguments: true }).collect()
}

/// The traits that are implemented beside the types of the same file or module, with the names of the types.
pub fn implemented(syntax: &[Syn]) -> Vec<(String, TraitOf)> {
    syntax.iter().filter_map(|item| of_impl(item, syntax)).collect()
}

/// Name of the type and the trait of an `impl`, if the type has it with all its arguments, or with those that have it.
fn of_impl(item: &Syn, beside: &[Syn]) -> Option<(String, TraitOf)> {
    let Syn::Impl(item) = item else { return None };
    let (path, _) = item.trait_.as_ref()?;
    let path = path.segments.last()?;
    let (name, Type::Path(ty)) = (plain(&path.ident), &*item.self_ty) else { return None };
    let ty = ty.path.segments.last()?;
    // `PartialEq<f32>` is another trait than `PartialEq`.
    if !path.arguments.is_none() || item.attrs.iter().any(is_cfg) || !is_whole(&ty.arguments, &item.generics) {
        return None;
    }
    let own = bounds(beside.iter().find_map(|item| generics_of(item, &ty.ident))?);
    let mut asked = bounds(&item.generics).into_iter().filter(|bound| !own.contains(bound)).peekable();
    let of_arguments = asked.peek().is_some();
    let is_alike = asked.all(|bound| bound.split_once(": ").is_some_and(|(_, asked)| asked == name));
    is_alike.then(|| (plain(&ty.ident), TraitOf { name, of_arguments }))
}

/// Returns `true` if the arguments of a type are all that an `impl` has parameters for.
fn is_whole(arguments: &PathArguments, generics: &Generics) -> bool {
    let given = match arguments {
        PathArguments::AngleBracketed(given) => given.args.iter().collect(),
        _ => vec![],
    };
    let is_same = |(given, param): (&&GenericArgument, &GenericParam)| match (given, param) {
        (GenericArgument::Lifetime(given), GenericParam::Lifetime(param)) => given == &param.lifetime,
        (GenericArgument::Type(Type::Path(given)), GenericParam::Type(param)) => given.path.is_ident(&param.ident),
        (GenericArgument::Type(Type::Path(given)), GenericParam::Const(param)) => given.path.is_ident(&param.ident),
        _ => false,
    };
    given.len() == generics.params.len() && given.iter().zip(&generics.params).all(is_same)
}

fn generics_of<'a>(item: &'a Syn, name: &syn::Ident) -> Option<&'a Generics> {
    let (ident, generics) = match item {
        Syn::Struct(item) => (&item.ident, &item.generics),
        Syn::Enum(item) => (&item.ident, &item.generics),
        Syn::Union(item) => (&item.ident, &item.generics),
        _ => return None,
    };
    (ident == name).then_some(generics)
}
