//! Arguments of nodes and graphs.

use super::{
    condition::names_in,
    scope::{Evaluated, RustNames, Scope},
    suggest::suggest,
    time::{duration, period, seconds},
    value::{declared_unit, describe, evaluate},
    wanted::Wanted,
};
use crate::{
    catalog::{DefaultValue, Limits, Literal, ParamSig, Signature, Type},
    graph::{Modifiers, Number, Value},
    report::{Diagnostic, Diagnostics},
    source::Span,
    syntax::tree::{Arg, Expr, ExprKind, Ident, Modifier, ModifierKind, ParamItem},
    units,
};
use std::{
    collections::{BTreeMap, BTreeSet},
    time::Duration,
};

/// Placeholder for an unknown time.
pub const ANY_TIME: Duration = Duration::from_secs(1);

/// The given arguments by name, and `true` if all of them have a known name. Reports errors of the list itself.
fn by_name<'a>(
    args: &'a [Arg],
    known: &[&str],
    (what, is_port): (&str, &dyn Fn(&str) -> bool),
    diagnostics: &mut Diagnostics,
) -> (BTreeMap<&'a str, &'a Expr>, bool) {
    let mut given: BTreeMap<&str, (&Ident, &Expr)> = BTreeMap::new();
    let mut whole = true;
    for arg in args {
        if diagnostics.is_full() {
            return (BTreeMap::new(), false);
        }
        let Some(name) = &arg.name else {
            let mut error =
                Diagnostic::error("unnamed-argument", arg.value.span, "an argument needs the name of its parameter");
            if let [only] = known {
                let start = Span { end: arg.value.span.start, ..arg.value.span };
                error = error.fix(format!("name it `{only}`"), start, format!("{only} = "));
            } else if !known.is_empty() {
                error = error.note(format!("the parameters of `{what}` are {}", quoted(known)));
            }
            diagnostics.push(error);
            whole = false;
            continue;
        };
        if !known.contains(&name.text.as_str()) {
            let message = format!("`{what}` has no parameter `{}`", name.text);
            let error = Diagnostic::error("unknown-argument", name.span, message);
            diagnostics.push(if is_port(&name.text) {
                error.note(format!("`{}` is an input: connect it, `… -> name.{};`", name.text, name.text))
            } else if let Some(modifier) = MODIFIERS_WITH_TIME.iter().find(|modifier| **modifier == name.text) {
                error.note(format!("it is a modifier, written after the instance: `{what}() {modifier} 5s`"))
            } else if known.is_empty() {
                error.note(format!("`{what}` has no parameters"))
            } else {
                suggest(error, name, known.iter().copied()).note(format!("its parameters are {}", quoted(known)))
            });
            whole = false;
        } else if let Some((first, _)) = given.insert(&name.text, (name, &arg.value)) {
            let message = format!("`{}` is given twice", name.text);
            diagnostics
                .push(Diagnostic::error("duplicate-argument", name.span, message).also(first.span, "first given here"));
        }
    }
    (given.into_iter().map(|(name, (_, value))| (name, value)).collect(), whole)
}

/// Modifiers that are mistaken for parameters.
const MODIFIERS_WITH_TIME: [&str; 4] = ["every", "after", "timeout", "deadline"];

/// Returns `true` if the modifier `name` is among the arguments of a node.
pub fn has_misplaced(args: &[Arg], signature: &Signature, name: &str) -> bool {
    let is_param = signature.params.iter().any(|param| param.name == name);
    !is_param && args.iter().any(|arg| arg.name.as_ref().is_some_and(|given| given.text == name))
}

fn quoted(names: &[&str]) -> String {
    names.iter().map(|n| format!("`{n}`")).collect::<Vec<_>>().join(", ")
}

/// Values of all parameters of a node.
pub fn of_node(
    signature: &Signature,
    args: &[Arg],
    at: Span,
    scope: &Scope<'_>,
    origins: &Origins,
    fed: &dyn Fn(&str) -> bool,
    diagnostics: &mut Diagnostics,
) -> Vec<Value> {
    let known: Vec<&str> = signature.params.iter().map(|p| p.name.as_str()).collect();
    let is_port = |name: &str| signature.ports.iter().any(|port| port.name == name && !port.kind.sends());
    let (given, whole) = by_name(args, &known, (&signature.name, &is_port), diagnostics);
    let mut values = vec![];
    for param in &signature.params {
        let value = match given.get(param.name.as_str()) {
            Some(expr) => evaluate(expr, scope)
                .and_then(|value| wanted(signature, param).fit(value, expr))
                .map_err(|error| handed_down(error, expr, origins)),
            // An argument with a wrong name may be meant for this parameter.
            None if !whole && param.default.is_none() => Ok(Value::RustDefault),
            None => default(signature, param, at, fed),
        };
        values.push(value.unwrap_or_else(|error| {
            diagnostics.push(*error);
            Value::RustDefault
        }));
    }
    values
}

/// Requirements of a parameter of a node on its value.
pub fn wanted<'a>(signature: &Signature, param: &'a ParamSig) -> Wanted<'a> {
    Wanted {
        name: &param.name,
        ty: &param.ty,
        unit: param.unit.as_deref(),
        range: param.range,
        declared: format!("`{}` is declared at {}:{}", param.name, signature.file.display(), signature.line),
    }
}

fn default(signature: &Signature, param: &ParamSig, at: Span, fed: &dyn Fn(&str) -> bool) -> Evaluated<Value> {
    match &param.default {
        Some(DefaultValue::Literal(Literal::Number(value, _))) if param.ty.name() == "Duration" => {
            seconds(Number::plain(*value), at).map(Value::Duration)
        }
        Some(DefaultValue::Literal(Literal::Number(value, is_whole))) => {
            Ok(Value::Number(if *is_whole { Number::whole(*value as i128) } else { Number::plain(*value) }))
        }
        Some(DefaultValue::Literal(Literal::Bool(value))) => Ok(Value::Bool(*value)),
        Some(DefaultValue::Literal(Literal::Text(text))) => Ok(Value::Text(text.clone())),
        Some(DefaultValue::Rust) => Ok(Value::RustDefault),
        // A function takes the value that arrives at the port, whereas a struct needs an initial one.
        None if signature.is_function && fed(&param.name) => Ok(Value::RustDefault),
        None => {
            let unit = param.unit.as_deref().unwrap_or_default();
            let message = format!("`{}` needs a value for `{}`", signature.name, param.name);
            let error = Diagnostic::error("missing-argument", at, message)
                .note(format!("write `{} = …{unit}`; it is a `{}`", param.name, param.ty))
                .note(format!("`{}` is declared at {}:{}", signature.name, signature.file.display(), signature.line));
            Err(Box::new(error))
        }
    }
}

/// Origin of a parameter's value that is passed on.
#[derive(Debug, Clone, Copy)]
pub struct Origin {
    /// The value as written.
    given: Span,
    /// The parameter of the graph that passes the value on.
    declared: Span,
    /// What that parameter, and those from which it has its value, allow.
    range: Option<Limits>,
}

/// Origins of the values of a graph's parameters.
pub type Origins = BTreeMap<String, Origin>;

/// Origins of the values of `params`: arguments in `args`, which may name parameters of the graph around, or defaults.
/// `inside` has the values.
pub fn origins(params: &[ParamItem], args: &[Arg], around: &Origins, inside: &Scope<'_>) -> Origins {
    let of_param = |param: &ParamItem| {
        let arg = argument(args, &param.name.text);
        let value = arg.or(param.default.as_ref())?;
        let handed = arg.and_then(only_param).and_then(|name| around.get(name));
        let given = handed.map_or(value.span, |origin| origin.given);
        // A mistake in it has been reported.
        let own = range(param, inside).ok().flatten();
        let range = both(own, handed.and_then(|origin| origin.range));
        Some((param.name.text.clone(), Origin { given, declared: param.name.span, range }))
    };
    params.iter().filter_map(of_param).collect()
}

/// Ranges of the graph's parameters that a node gets as they are, for each of its parameters.
pub fn passed_on(signature: &Signature, args: &[Arg], origins: &Origins) -> Vec<Option<Limits>> {
    let range = |param: &ParamSig| origins.get(only_param(argument(args, &param.name)?)?)?.range;
    signature.params.iter().map(range).collect()
}

/// Range of the values that are in both ranges.
fn both(one: Option<Limits>, other: Option<Limits>) -> Option<Limits> {
    let (Some((low, high, inside)), Some((other_low, other_high, other_inside))) = (one, other) else {
        return one.or(other);
    };
    let low = low.into_iter().chain(other_low).reduce(f64::max);
    let is_smaller = |one: f64, other: f64| one < other || one == other && !inside;
    Some(match (high, other_high) {
        (Some(one), Some(other)) if is_smaller(one, other) => (low, high, inside),
        (Some(_), None) => (low, high, inside),
        _ => (low, other_high, other_inside),
    })
}

/// The argument with this name.
fn argument<'a>(args: &'a [Arg], name: &str) -> Option<&'a Expr> {
    args.iter().find(|arg| arg.name.as_ref().is_some_and(|given| given.text == name)).map(|arg| &arg.value)
}

/// The name of the parameter, if an expression consists of nothing else.
fn only_param(expr: &Expr) -> Option<&str> {
    match &expr.kind {
        ExprKind::Path(path) => match path.segments.as_slice() {
            [name] => Some(&name.text),
            _ => None,
        },
        _ => None,
    }
}

/// Adds the origins of the parameters in `expr` to an error about its value. A single parameter that is out of range is
/// reported where its value was given; all other errors are reported where the value is used.
fn handed_down(mut error: Box<Diagnostic>, expr: &Expr, origins: &Origins) -> Box<Diagnostic> {
    if let Some(origin) = only_param(expr).and_then(|name| origins.get(name))
        && error.code == "out-of-range"
        && error.primary.span == expr.span
    {
        error.primary.span = origin.given;
        return Box::new(error.also(origin.declared, "this parameter").also(expr.span, "is passed on here"));
    }
    let names: BTreeSet<&str> = names_in(expr).into_iter().map(|name| name.text.as_str()).collect();
    let given = names.into_iter().filter_map(|name| Some((name, origins.get(name)?)));
    given.fold(error, |error, (name, origin)| Box::new(error.also(origin.given, format!("`{name}` is given here"))))
}

/// Values of all parameters of a graph that is not nested.
pub fn of_graph(
    name: &Ident,
    params: &[(&ParamItem, Type)],
    given: Option<(&[Arg], &Scope<'_>)>,
    rust: RustNames<'_>,
    at: Span,
    diagnostics: &mut Diagnostics,
) -> BTreeMap<String, Value> {
    of_graph_inside((name, &|_| false), params, given, rust, &Origins::new(), at, diagnostics)
}

/// Values of all parameters of a graph, given with their types. `is_port` tells its inputs and slots by their names.
/// `origins` are those of the graph around.
pub fn of_graph_inside(
    (name, is_port): (&Ident, &dyn Fn(&str) -> bool),
    params: &[(&ParamItem, Type)],
    given: Option<(&[Arg], &Scope<'_>)>,
    rust: RustNames<'_>,
    origins: &Origins,
    at: Span,
    diagnostics: &mut Diagnostics,
) -> BTreeMap<String, Value> {
    let known: Vec<&str> = params.iter().map(|(p, _)| p.name.text.as_str()).collect();
    let (exprs, whole) = match given {
        Some((args, _)) => by_name(args, &known, (&name.text, is_port), diagnostics),
        None => (BTreeMap::new(), true),
    };
    let mut values: BTreeMap<String, Value> = BTreeMap::new();
    for (param, ty) in params {
        // If the default does not fit its own parameter, only that is reported: arguments cannot be checked then.
        let default = graph_default(name, (param, ty), at, &Scope { params: &values, rust }, false);
        let value = match (exprs.get(param.name.text.as_str()), given) {
            (Some(_), Some(_)) if default.is_err() => default,
            (Some(expr), Some((_, scope))) => {
                let fitting = graph_param(param, ty, &Scope { params: &values, rust })
                    .and_then(|w| w.fit(evaluate(expr, scope)?, expr));
                fitting.map_err(|error| handed_down(error, expr, origins))
            }
            _ if !whole && param.default.is_none() => Ok(Value::RustDefault),
            // The parameters of a graph need no value while it is not used.
            _ => graph_default(name, (param, ty), at, &Scope { params: &values, rust }, given.is_some()),
        };
        match value {
            Ok(value) => {
                values.insert(param.name.text.clone(), value);
            }
            Err(error) => {
                diagnostics.push(*error);
                values.insert(param.name.text.clone(), Value::RustDefault);
            }
        }
    }
    values
}

/// Requirements of a parameter of a graph on its value.
pub fn graph_param<'a>(param: &'a ParamItem, ty: &'a Type, before: &Scope<'_>) -> Evaluated<Wanted<'a>> {
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
fn range(param: &ParamItem, before: &Scope<'_>) -> Evaluated<Option<Limits>> {
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

fn graph_default(
    name: &Ident,
    (param, ty): (&ParamItem, &Type),
    at: Span,
    before: &Scope<'_>,
    is_used: bool,
) -> Evaluated<Value> {
    let wanted = graph_param(param, ty, before)?;
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

/// Modifiers that remain with a node; `each` and `delay` are left to the caller.
pub fn modifiers(list: &[Modifier], scope: &Scope<'_>, origins: &Origins, diagnostics: &mut Diagnostics) -> Modifiers {
    let mut modifiers = Modifiers::default();
    let mut time = |expr: &Expr, of_number: fn(Number, &Expr) -> Evaluated<Duration>| -> Option<Duration> {
        let value = evaluate(expr, scope).and_then(|value| match value {
            Value::Number(n) => of_number(n, expr),
            Value::Duration(d) => Ok(d),
            // The value is not known yet: any time will do for the checks.
            Value::RustDefault => Ok(ANY_TIME),
            other => Err(Box::new(Diagnostic::error(
                "wrong-value",
                expr.span,
                format!("expected a time, but this is {}", describe(&other)),
            ))),
        });
        match value {
            Ok(duration) if duration.is_zero() => {
                diagnostics.push(Diagnostic::error("out-of-range", expr.span, "the time must be greater than zero"));
                Some(ANY_TIME)
            }
            Ok(duration) => Some(duration),
            Err(error) => {
                diagnostics.push(*handed_down(error, expr, origins));
                // The modifier itself is present, whatever its time.
                Some(ANY_TIME)
            }
        }
    };
    for modifier in list {
        match &modifier.kind {
            ModifierKind::Every(expr) => modifiers.every = time(expr, period),
            ModifierKind::After(expr) => modifiers.after = time(expr, duration),
            ModifierKind::Timeout(expr) => modifiers.timeout = time(expr, duration),
            ModifierKind::Deadline(expr) => modifiers.deadline = time(expr, duration),
            ModifierKind::On(group) => modifiers.group = Some(group.text.clone()),
            ModifierKind::Pipelined => modifiers.pipelined = true,
            ModifierKind::Skip => modifiers.skip = true,
            ModifierKind::Essential => modifiers.essential = true,
            ModifierKind::Restart => modifiers.restart = true,
            ModifierKind::Each { .. } | ModifierKind::Delay(_) => {}
        }
    }
    modifiers
}
