//! Structs of Rust that a source file writes as values: `Pose2 { x: 1m, y: 0m, heading: 90deg }`.

use super::{
    scope::{Evaluated, RustNames},
    suggest::suggest,
};
use crate::{
    catalog::{Field, Struct, Structure},
    report::Diagnostic,
    source::Span,
    syntax::tree::{Expr, Ident, PathExpr},
};

/// The declaration of a struct that is written with these fields, and its path in generated code; `None` if an import
/// has failed, which has been reported.
pub fn declared(
    path: &PathExpr,
    fields: &[(Ident, Expr)],
    rust: RustNames<'_>,
) -> Evaluated<Option<(Vec<String>, Struct)>> {
    if rust.texts.is_unclear(path) {
        return Ok(None);
    }
    let declared = match rust.catalog.structure(&rust.texts.full_path(path)) {
        Structure::Known(declared) => declared,
        Structure::Missing(elsewhere) => return Err(Box::new(unknown(path, &elsewhere, rust))),
        Structure::Other(ty) => {
            let message = format!("a `{ty}` cannot be written with fields");
            let error = Diagnostic::error("wrong-value", path.span, message)
                .note("only a struct whose fields have names can, neither `#[cfg]` nor `#[non_exhaustive]`");
            return Err(Box::new(error.note("use a Rust constant of this type")));
        }
    };
    let Some(spelled) = declared.path.clone() else {
        let message = format!("the type `{}` is not accessible from the program", path.text());
        let error = Diagnostic::error("unknown-type", path.span, message);
        return Err(Box::new(error.note(format!("declared at {}; it needs `pub` and a `pub use`", declared.place))));
    };
    check_names(&declared, fields, path.span)?;
    Ok(Some((spelled, declared)))
}

fn unknown(path: &PathExpr, elsewhere: &[String], rust: RustNames<'_>) -> Diagnostic {
    let message = format!("there is no type `{}`", path.text());
    let error = Diagnostic::error("unknown-type", path.span, message);
    let error = match path.segments.as_slice() {
        [name] if elsewhere.is_empty() => suggest(error, name, rust.texts.imported(name.span)),
        _ => error,
    };
    elsewhere.iter().take(4).fold(error, |error, path| error.note(format!("import it: `use {path};`")))
}

/// The field with this name, if the program can use it.
pub fn field<'a>(declared: &'a Struct, name: &Ident) -> Evaluated<&'a Field> {
    let ty = declared.ty.name();
    let Some(field) = declared.fields.iter().find(|field| field.name == name.text) else {
        let names: Vec<&str> = declared.fields.iter().map(|field| field.name.as_str()).collect();
        let error = Diagnostic::error("wrong-field", name.span, format!("`{ty}` has no field `{}`", name.text));
        let error = suggest(error, name, names.iter().copied()).note(match names.as_slice() {
            [] => format!("`{ty}` has no fields"),
            names => format!("its fields are `{}`", names.join("`, `")),
        });
        return Err(Box::new(error));
    };
    if !field.is_visible {
        let message = format!("the field `{}` of `{ty}` is private", name.text);
        let error = Diagnostic::error("wrong-field", name.span, message);
        return Err(Box::new(error.note(format!("`{ty}` is declared at {}", declared.place))));
    }
    Ok(field)
}

/// Reports fields that the struct does not have, that are given twice or not at all, or that are private.
fn check_names(declared: &Struct, given: &[(Ident, Expr)], at: Span) -> Evaluated<()> {
    let error = |span: Span, message: String| Diagnostic::error("wrong-field", span, message);
    let (ty, place) = (declared.ty.name(), format!("`{}` is declared at {}", declared.ty.name(), declared.place));
    for (number, (name, _)) in given.iter().enumerate() {
        field(declared, name)?;
        if let Some((first, _)) = given[..number].iter().find(|(other, _)| other.text == name.text) {
            let error = error(name.span, format!("`{}` is given twice", name.text));
            return Err(Box::new(error.also(first.span, "first given here")));
        }
    }
    let is_given = |field: &&Field| given.iter().any(|(name, _)| name.text == field.name);
    let missing: Vec<String> = declared
        .fields
        .iter()
        .filter(|f| !is_given(f))
        .map(|field| format!("`{}: {}`", field.name, field.ty))
        .collect();
    if missing.is_empty() {
        return Ok(());
    }
    Err(Box::new(error(at, format!("`{ty}` needs a value for {}", missing.join(", "))).note(place)))
}
