//! Words for connections whose ends have different types, or different units.

use crate::{
    catalog::{Catalog, Match, Type},
    fraction::Fraction,
    report::Diagnostic,
    source::Span,
    units::Unit,
};

/// The node of the library that converts a number.
const SCALE: &str = "apex_nodes::math::scale";

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
    let Some((from, to)) = units(sent, taken) else {
        return error.note("types are not converted implicitly: insert a node that converts the token");
    };
    if from.dimension != to.dimension {
        let (sent, taken) = (from.dimension.noun(), to.dimension.noun());
        return error.note(format!("{sent} is not {taken}: connect another port, or correct the unit of one of them"));
    }
    let factor = from.factor.checked_div(to.factor).map_or_else(|| from.size() / to.size(), Fraction::value);
    let error = error.note(format!("units are not converted implicitly: multiply by {factor}"));
    let path: Vec<String> = SCALE.split("::").map(str::to_owned).collect();
    let is_float = matches!(sent.name(), "f32" | "f64");
    if catalog.nodes(&path).is_empty() || !is_float {
        return error;
    }
    let sign = if active { "=>" } else { "->" };
    // With a decimal point, because whole numbers are integers.
    let node = format!(" {SCALE}(factor = {factor:?}) {sign}");
    error.guess("insert the conversion", arrow.after(), node)
}

/// The units of both ends, if the types differ in nothing else.
fn units(sent: &Type, taken: &Type) -> Option<(Unit, Unit)> {
    let is_same = sent.without_unit().compare(taken.without_unit()) != Match::Different;
    sent.measured_in().zip(taken.measured_in()).filter(|_| is_same)
}
