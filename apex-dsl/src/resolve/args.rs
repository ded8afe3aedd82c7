//! Arguments of nodes and graphs.

use super::{
    declared,
    origins::{Origins, handed_down},
    scope::{Evaluated, RustNames, Scope},
    suggest::suggest,
    time::{duration, period, seconds},
    value::{describe, evaluate},
    wanted::Wanted,
};
use crate::{
    catalog::{DefaultValue, Literal, ParamSig, Signature, Type},
    graph::{Modifiers, Number, Value},
    report::{Diagnostic, Diagnostics},
    source::Span,
    syntax::tree::{Arg, Expr, Ident, Modifier, ModifierKind, ParamItem},
};
use std::{collections::BTreeMap, time::Duration};

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
        let default = declared::default(name, (param, ty), at, &Scope { params: &values, rust }, false);
        let value = match (exprs.get(param.name.text.as_str()), given) {
            (Some(_), Some(_)) if default.is_err() => default,
            (Some(expr), Some((_, scope))) => {
                let fitting = declared::wanted(param, ty, &Scope { params: &values, rust })
                    .and_then(|w| w.fit(evaluate(expr, scope)?, expr));
                fitting.map_err(|error| handed_down(error, expr, origins))
            }
            _ if !whole && param.default.is_none() => Ok(Value::RustDefault),
            // The parameters of a graph need no value while it is not used.
            _ => declared::default(name, (param, ty), at, &Scope { params: &values, rust }, given.is_some()),
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
