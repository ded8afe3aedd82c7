//! Declarations of the parameters of graphs.

use super::{
    scope::{Evaluated, Scope},
    value::{declared_unit, evaluate},
    wanted::Wanted,
};
use crate::{
    catalog::{Limits, Type},
    graph::Value,
    report::Diagnostic,
    source::Span,
    syntax::tree::{Expr, ExprKind, Ident, ParamItem},
    units,
};

/// Requirements of a parameter of a graph on its value.
pub fn wanted<'a>(param: &'a ParamItem, ty: &'a Type, before: &Scope<'_>) -> Evaluated<Wanted<'a>> {
    let range = range(param, before)?;
    param.unit.as_ref().map(declared_unit).transpose()?;
    let unit = param.unit.as_ref().map(|u| u.text.as_str());
    Ok(Wanted {
        name: &param.name.text,
        ty,
        unit,
        range,
        declared: format!("`{}` is a parameter of the graph", param.name.text),
    })
}

/// Range of a parameter of a graph, in SI units.
pub fn range(param: &ParamItem, before: &Scope<'_>) -> Evaluated<Option<Limits>> {
    let Some(range) = &param.range else { return Ok(None) };
    let bound = |expr: &Expr| match declared(param, expr, before)? {
        Value::Number(n) => Ok(Some(n.value)),
        Value::Duration(d) => Ok(Some(d.as_secs_f64())),
        Value::RustDefault => Ok(None),
        _ => Err(Box::new(Diagnostic::error("wrong-value", expr.span, "both ends of a range must be numbers"))),
    };
    Ok(Some((bound(&range.low)?, bound(&range.high)?, range.inclusive)))
}

/// A value in the declaration of a parameter, where a plain number has the unit of the parameter. Values of other
/// parameters are already converted: their dimension shows it, except for dimensionless units such as `%`.
fn declared(param: &ParamItem, expr: &Expr, before: &Scope<'_>) -> Evaluated<Value> {
    let value = evaluate(expr, before)?;
    let unit = param.unit.as_ref().and_then(|unit| units::parse(&unit.text).ok());
    Ok(match unit {
        Some(unit) if !(unit.dimension.is_none() && names_parameter(expr)) => in_unit(value, unit),
        _ => value,
    })
}

/// Returns `true` if a parameter is part of an expression.
fn names_parameter(expr: &Expr) -> bool {
    match &expr.kind {
        ExprKind::Path(_) => true,
        ExprKind::List(items) => items.iter().any(names_parameter),
        ExprKind::Struct(_, fields) => fields.iter().any(|(_, value)| names_parameter(value)),
        ExprKind::Unary(_, inner) => names_parameter(inner),
        ExprKind::Binary(_, left, right) => names_parameter(left) || names_parameter(right),
        ExprKind::Number(..) | ExprKind::Text(_) | ExprKind::Bool(_) => false,
    }
}

fn in_unit(value: Value, unit: units::Unit) -> Value {
    match value {
        Value::Number(n) if n.dimension.is_none() => Value::Number(n.times(unit)),
        Value::List(items) => Value::List(items.into_iter().map(|item| in_unit(item, unit)).collect()),
        value => value,
    }
}

pub fn default(
    name: &Ident,
    (param, ty): (&ParamItem, &Type),
    at: Span,
    before: &Scope<'_>,
    is_used: bool,
) -> Evaluated<Value> {
    let wanted = wanted(param, ty, before)?;
    match &param.default {
        Some(expr) => wanted.fit(declared(param, expr, before)?, expr),
        None if !is_used => Ok(Value::RustDefault),
        None => {
            let message = format!("`{}` needs a value for `{}`", name.text, param.name.text);
            Err(Box::new(
                Diagnostic::error("missing-argument", at, message)
                    .also(param.name.span, "declared here, without a default"),
            ))
        }
    }
}
