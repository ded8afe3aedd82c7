//! Words for connections whose ends have different types, or different units.

use crate::{
    catalog::{Catalog, Match, Type},
    fraction::Fraction,
    report::Diagnostic,
    source::Span,
    syntax::tree::Arrow,
    units::Unit,
};

/// The node of the library that converts a number.
const SCALE: &str = "apex_nodes::math::scale";
/// The node of the library that sends `()` for each token.
const SIGNAL: &str = "apex_nodes::flow::Signal";

/// Code of the error for a connection from `sent` to `taken`.
pub fn code(sent: &Type, taken: &Type) -> &'static str {
    if units(sent, taken).is_some() { "wrong-unit" } else { "type-mismatch" }
}

/// Adds what can be done about a connection from `sent` to `taken` whose arrow is at `arrow`.
pub fn remedy(
    error: Diagnostic,
    sent: &Type,
    taken: &Type,
    arrow: Span,
    active: bool,
    catalog: &Catalog,
) -> Diagnostic {
    let insert = |error, help, node| inserting(error, help, node, Arrow { active, span: arrow }, catalog);
    let Some((from, to)) = units(sent, taken) else {
        let error = error.note("types are not converted implicitly: insert a node that converts the token");
        return if taken.is_unit() { insert(error, "send the moment without the value", (SIGNAL, "")) } else { error };
    };
    if from.dimension != to.dimension {
        let (sent, taken) = (from.dimension.noun(), to.dimension.noun());
        return error.note(format!("{sent} is not {taken}: connect another port, or correct the unit of one of them"));
    }
    let factor = from.factor.checked_div(to.factor).map_or_else(|| from.size() / to.size(), Fraction::value);
    let error = error.note(format!("units are not converted implicitly: multiply by {factor}"));
    if !matches!(sent.name(), "f32" | "f64") {
        return error;
    }
    // With a decimal point, because whole numbers are integers.
    let args = format!("factor = {factor:?}");
    insert(error, "insert the conversion", (SCALE, &args))
}

/// Adds the fix that inserts a node behind an arrow, if there is one with this path.
pub fn inserting(
    error: Diagnostic,
    help: &str,
    (path, args): (&str, &str),
    arrow: Arrow,
    catalog: &Catalog,
) -> Diagnostic {
    let segments: Vec<String> = path.split("::").map(str::to_owned).collect();
    if catalog.nodes(&segments).is_empty() {
        return error;
    }
    let sign = if arrow.active { "=>" } else { "->" };
    error.guess(help, arrow.span.after(), format!(" {path}({args}) {sign}"))
}

/// The units of both ends, if the types differ in nothing else.
fn units(sent: &Type, taken: &Type) -> Option<(Unit, Unit)> {
    let is_same = sent.without_unit().compare(taken.without_unit()) != Match::Different;
    sent.measured_in().zip(taken.measured_in()).filter(|_| is_same)
}
