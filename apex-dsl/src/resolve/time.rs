//! Times and periods as values, and the messages about missing units.

use super::{
    scope::{Evaluated, Scope},
    value::{error, evaluate, kind},
};
use crate::{
    fraction::Fraction,
    graph::{Number, Value},
    report::Diagnostic,
    source::Span,
    syntax::tree::{Expr, ExprKind},
    units::Dimension,
};
use std::time::Duration;

/// An error about a value without a unit, where one of `units` (name and symbol) is expected. The unit can be suggested
/// only behind a number; a parameter must be declared as `declared`.
pub fn missing_unit(message: impl Into<String>, expr: &Expr, declared: &str, units: &[(&str, &str)]) -> Diagnostic {
    let error = Diagnostic::error("missing-unit", expr.span, message);
    let is_number = |expr: &Expr| matches!(expr.kind, ExprKind::Number(..));
    match &expr.kind {
        ExprKind::Path(path) => {
            let name = path.text();
            error.note(format!("the parameter `{name}` of the graph has no unit: declare it as `{name}: {declared}`"))
        }
        ExprKind::Unary("-", inner) if !is_number(inner) => error.note(NO_PART_HAS_A_UNIT),
        ExprKind::Binary(..) => error.note(NO_PART_HAS_A_UNIT),
        _ => units
            .iter()
            .fold(error, |error, (words, unit)| error.guess(format!("write it in {words}"), expr.span.after(), *unit)),
    }
}

const NO_PART_HAS_A_UNIT: &str =
    "no part of this expression has a unit: write one after a number, or declare a parameter in it with one";

/// Adds a note to an error about metres in place of a time: `5m` may mean minutes.
pub fn minutes(error: Diagnostic, expr: &Expr) -> Diagnostic {
    match &expr.kind {
        ExprKind::Number(_, Some(unit)) if unit == "m" => {
            let unit = Span { start: expr.span.end - 1, ..expr.span };
            error.note("`m` is the unit metre; for minutes, write `min`").guess("write it in minutes", unit, "min")
        }
        _ => error,
    }
}

/// The value of an expression that gives a time.
pub fn time(expr: &Expr, scope: &Scope<'_>) -> Evaluated<Duration> {
    match evaluate(expr, scope)? {
        Value::Duration(time) => Ok(time),
        Value::Number(n) => duration(n, expr),
        _ => error("wrong-value", expr.span, "expected a time, for example `50ms`".to_owned()),
    }
}

/// A time as a duration. Reports values with another dimension.
pub fn duration(n: Number, expr: &Expr) -> Evaluated<Duration> {
    if n.dimension.is_none() {
        let message = "expected a time: the unit is missing";
        let units = [("milliseconds", "ms"), ("seconds", "s")];
        return Err(Box::new(missing_unit(message, expr, "Duration", &units)));
    }
    if n.dimension != Dimension::TIME {
        let message = format!("expected a time, but this is {}", kind(n));
        return Err(Box::new(minutes(Diagnostic::error("wrong-unit", expr.span, message), expr)));
    }
    seconds(n, expr.span)
}

/// The period of a source, which may be given as a frequency.
pub fn period(n: Number, expr: &Expr) -> Evaluated<Duration> {
    match n.inverse() {
        Some(period) if period.dimension == Dimension::TIME => seconds(period, expr.span),
        None if n.dimension == Dimension::FREQUENCY => {
            error("out-of-range", expr.span, "the frequency must be greater than zero")
        }
        _ => duration(n, expr),
    }
}

/// A number of seconds as a duration, of which a program counts the nanoseconds.
pub fn seconds(n: Number, span: Span) -> Evaluated<Duration> {
    let nanos = n.value * 1e9;
    if !(0.0..=i64::MAX as f64).contains(&nanos.round()) {
        return error("out-of-range", span, "this time is negative or longer than 292 years");
    }
    let whole = n.exact.and_then(|exact| exact.checked_mul(Fraction::whole(1_000_000_000))).and_then(Fraction::integer);
    match whole.and_then(|nanos| u64::try_from(nanos).ok()) {
        Some(nanos) => Ok(Duration::from_nanos(nanos)),
        None => {
            let message = format!("this time is {nanos}ns, but a program counts whole nanoseconds");
            let nearest = format!("{}ns", nanos.round().max(1.0));
            let error = Diagnostic::error("wrong-value", span, message);
            Err(Box::new(error.guess(format!("round it to `{nearest}`"), span, nearest)))
        }
    }
}
