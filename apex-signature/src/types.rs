//! Types as they are written.

use syn::{GenericArgument, PathArguments, ReturnType, Type};

/// The error type `E` of a function that returns `Result<T, E>`.
pub fn error_type(output: &ReturnType) -> Option<&Type> {
    let ReturnType::Type(_, ty) = output else { return None };
    argument(ty, "Result", 1)
}

/// `T` of `Name<T, …>`.
pub fn wrapped<'a>(ty: &'a Type, name: &str) -> Option<&'a Type> {
    argument(ty, name, 0)
}

/// An argument of `Name<T, E, …>`, by its place.
pub fn argument<'a>(ty: &'a Type, name: &str, place: usize) -> Option<&'a Type> {
    let Type::Path(path) = ty else { return None };
    let last = path.path.segments.last().filter(|last| last.ident == name)?;
    let PathArguments::AngleBracketed(args) = &last.arguments else { return None };
    match args.args.iter().nth(place)? {
        GenericArgument::Type(inner) => Some(inner),
        _ => None,
    }
}

pub fn is_named(ty: &Type, name: &str) -> bool {
    matches!(ty, Type::Path(path) if path.path.segments.last().is_some_and(|s| s.ident == name))
}

/// `T` of `Option<T>`.
pub fn option_of(ty: &Type) -> Option<&Type> {
    wrapped(ty, "Option")
}
