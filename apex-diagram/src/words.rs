//! Types, parameters and modifiers in the short form for boxes.

use crate::text::shortened;
use apex_dsl::{
    catalog::{Catalog, DefaultValue, Literal, ParamSig},
    graph::{Library, Modifiers, Value},
    units,
};
use std::time::Duration;

/// Maximum length of a line in a box, in characters.
const LONGEST: usize = 34;
/// Maximum number of parameters in a box.
const MOST: usize = 4;

/// Name of a type.
pub fn type_name(library: &Library, catalog: &Catalog) -> String {
    shortened(&catalog.signatures[library.signature].name, LONGEST)
}

/// Parameters with values other than the default.
pub fn parameters(library: &Library, catalog: &Catalog) -> Vec<String> {
    let params = &catalog.signatures[library.signature].params;
    let differs = |(param, value): &(&ParamSig, &Value)| !is_default(param, value);
    let lines = params.iter().zip(&library.params).filter(differs);
    limited(lines.map(|(param, given)| argument(&param.name, given, param.unit.as_deref())).collect())
}

/// Arguments of a nested graph.
pub fn arguments(args: &[(String, Value)]) -> Vec<String> {
    limited(args.iter().map(|(name, given)| argument(name, given, None)).collect())
}

fn limited(mut lines: Vec<String>) -> Vec<String> {
    if lines.len() > MOST {
        let more = lines.len() + 1 - MOST;
        lines.truncate(MOST - 1);
        lines.push(format!("… {more} more"));
    }
    lines
}

fn argument(name: &str, given: &Value, unit: Option<&str>) -> String {
    shortened(&format!("{name} = {}", value(given, unit)), LONGEST)
}

fn is_default(param: &ParamSig, value: &Value) -> bool {
    match (&param.default, value) {
        (_, Value::RustDefault) => true,
        (Some(DefaultValue::Literal(Literal::Number(default, _))), Value::Number(n)) => same(*default, n.value),
        (Some(DefaultValue::Literal(Literal::Number(default, _))), Value::Duration(d)) => {
            same(*default, d.as_secs_f64())
        }
        (Some(DefaultValue::Literal(Literal::Bool(default))), Value::Bool(b)) => default == b,
        (Some(DefaultValue::Literal(Literal::Text(default))), Value::Text(t)) => default == t,
        _ => false,
    }
}

fn same(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-9 * a.abs()
}

/// A value in the notation of the language; a number is in this unit.
pub fn value(given: &Value, unit: Option<&str>) -> String {
    match given {
        Value::Number(n) => {
            let known = unit.and_then(|text| Some((text, units::parse(text).ok()?.size())));
            let (number, unit) = match known {
                Some((text, factor)) => (n.value / factor, format!(" {text}")),
                None if n.dimension.is_none() => (n.value, String::new()),
                None => (n.value, format!(" {}", n.dimension)),
            };
            let (short, degrees) = (rounded(number), rounded(number.to_degrees()));
            // 45 deg is easier to read than 0.785398163 rad.
            if unit == " rad" && degrees.len() < short.len() { format!("{degrees} deg") } else { short + &unit }
        }
        Value::Bool(b) => b.to_string(),
        Value::Text(text) => format!("{text:?}"),
        Value::List(values) => {
            let values: Vec<String> = values.iter().take(20).map(|v| value(v, unit)).collect();
            format!("[{}]", values.join(", "))
        }
        Value::Unit => "()".to_owned(),
        Value::Duration(d) => duration(*d),
        Value::Struct(_) => given.text(),
        Value::Path(path, _) => path.last().cloned().unwrap_or_default(),
        Value::RustDefault => "…".to_owned(),
    }
}

/// Removes the rounding error of a division.
fn rounded(number: f64) -> String {
    format!("{number:.9e}").parse().unwrap_or(number).to_string()
}

/// A duration in the largest unit without a fraction.
pub fn duration(d: Duration) -> String {
    let seconds = d.as_secs();
    if d.subsec_nanos() == 0 && seconds > 0 {
        return match (seconds % 3600, seconds % 60) {
            (0, _) => format!("{} h", seconds / 3600),
            (_, 0) => format!("{} min", seconds / 60),
            _ => format!("{seconds} s"),
        };
    }
    match d.as_nanos() {
        n if n % 1_000_000 == 0 => format!("{} ms", n / 1_000_000),
        n if n % 1000 == 0 => format!("{} us", n / 1000),
        n => format!("{n} ns"),
    }
}

/// Modifiers of an instance in one line, or `None` if it has none.
pub fn modifiers(modifiers: &Modifiers) -> Option<String> {
    let timed = [
        ("every", modifiers.every),
        ("after", modifiers.after),
        ("timeout", modifiers.timeout),
        ("deadline", modifiers.deadline),
    ];
    let timed = timed.into_iter().filter_map(|(word, time)| Some(format!("{word} {}", duration(time?))));
    let group = modifiers.group.iter().map(|group| format!("on {group}"));
    let flags = [
        ("skip", modifiers.skip),
        ("pipelined", modifiers.pipelined),
        ("essential", modifiers.essential),
        ("restart", modifiers.restart),
    ];
    let flags = flags.into_iter().filter(|(_, on)| *on).map(|(word, _)| word.to_owned());
    let words: Vec<String> = timed.chain(group).chain(flags).collect();
    (!words.is_empty()).then(|| words.join(" "))
}
