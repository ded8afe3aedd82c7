//! Constant expressions, and conversion of values to the types of parameters.

use crate::{
    catalog::{Catalog, Constant, Match, Type},
    fraction::Fraction,
    graph::{Number, Value},
    report::Diagnostic,
    source::Span,
    syntax::tree::{Expr, ExprKind, Ident, PathExpr},
    units::{self, Dimension, Unit},
};
use std::{cmp::Ordering, collections::BTreeMap, time::Duration};

use super::names::{SourceSet, suggest};

/// Error or value; the error is boxed because it is much larger than most values.
pub type Evaluated<T> = Result<T, Box<Diagnostic>>;

/// Meaning of the names in an expression.
pub struct Scope<'a> {
    /// Parameters of the graph that contains the expression.
    pub params: &'a BTreeMap<String, Value>,
    /// Names of Rust.
    pub rust: RustNames<'a>,
}

/// Names of Rust in source files.
#[derive(Clone, Copy)]
pub struct RustNames<'a> {
    /// The source files, with their imports.
    pub texts: &'a SourceSet,
    /// The types and constants.
    pub catalog: &'a Catalog,
}

fn error<T>(code: &'static str, span: Span, message: impl Into<String>) -> Evaluated<T> {
    Err(Box::new(Diagnostic::error(code, span, message)))
}

/// Evaluates an expression.
pub fn evaluate(expr: &Expr, scope: &Scope<'_>) -> Evaluated<Value> {
    match &expr.kind {
        ExprKind::Number(digits, unit) => number(digits, unit.as_deref(), expr.span),
        ExprKind::Text(text) => Ok(Value::Text(text.clone())),
        ExprKind::Bool(value) => Ok(Value::Bool(*value)),
        ExprKind::List(items) => {
            items.iter().map(|item| evaluate(item, scope)).collect::<Evaluated<_>>().map(Value::List)
        }
        ExprKind::Path(path) => match path.segments.as_slice() {
            [name] if scope.params.contains_key(&name.text) => Ok(scope.params[&name.text].clone()),
            _ => constant(path, scope),
        },
        ExprKind::Struct(path, fields) => super::structs::evaluate(path, fields, scope),
        ExprKind::Unary(operator, inner) => unary(operator, evaluate(inner, scope)?, expr.span),
        ExprKind::Binary(operator, left, right) => {
            let (a, b) = (evaluate(left, scope)?, evaluate(right, scope)?);
            binary(operator, (a, left.span), (b, right.span), expr.span)
        }
    }
}

fn constant(path: &PathExpr, scope: &Scope<'_>) -> Evaluated<Value> {
    match scope.rust.texts.constant(path, scope.rust.catalog) {
        Some(Constant::Known(path, ty)) => Ok(Value::Path(path, ty)),
        Some(Constant::Unknown(path)) => Ok(Value::Path(path, Type::Unknown(String::new()))),
        Some(Constant::Hidden(place)) => {
            let message = format!("the constant `{}` is not accessible from the program", path.text());
            let error = Diagnostic::error("unknown-name", path.span, message);
            Err(Box::new(error.note(format!("declared at {place}; it needs `pub` and a `pub use`"))))
        }
        Some(Constant::Missing(known)) => {
            let message = format!("there is no constant `{}`", path.text());
            let error = Diagnostic::error("unknown-name", path.span, message);
            Err(Box::new(match path.segments.last() {
                Some(last) => suggest(error, last, known.iter().map(String::as_str)),
                None => error,
            }))
        }
        None => Err(Box::new(unknown_name(path, scope))),
    }
}

fn unknown_name(path: &PathExpr, scope: &Scope<'_>) -> Diagnostic {
    let error = Diagnostic::error("unknown-name", path.span, format!("there is no parameter `{}` here", path.text()))
        .note("a value is a literal, a parameter of this graph, or the full path of a Rust constant");
    match path.segments.first() {
        Some(word) => suggest(error, word, scope.params.keys().map(String::as_str)),
        None => error,
    }
}

fn number(digits: &str, unit: Option<&str>, span: Span) -> Evaluated<Value> {
    let too_large = || error("bad-number", span, "this number is too large");
    let whole = match digits.strip_prefix("0x") {
        Some(hex) => i128::from_str_radix(hex, 16).ok(),
        None => digits.parse().ok(),
    };
    let number = match whole {
        Some(whole) => Number::whole(whole),
        None if digits.starts_with("0x") || digits.bytes().all(|b| b.is_ascii_digit()) => return too_large(),
        None => {
            let value = digits.parse().unwrap_or(f64::INFINITY);
            Number { exact: Fraction::parse(digits), ..Number::plain(value) }
        }
    };
    let Some(unit) = unit else {
        return if number.value.is_finite() { Ok(Value::Number(number)) } else { too_large() };
    };
    match units::parse(unit).map(|unit| number.times(unit)) {
        Ok(number) if number.value.is_finite() => Ok(Value::Number(number)),
        Ok(_) => too_large(),
        Err(part) => {
            // `part` is a piece of `unit`, which ends the number.
            let start = span.end as usize - unit.len() + (part.as_ptr() as usize - unit.as_ptr() as usize);
            Err(Box::new(unknown_unit(part, Span::new(span.file, start, start + part.len()))))
        }
    }
}

/// The error at a unit that does not exist.
fn unknown_unit(unit: &str, span: Span) -> Diagnostic {
    let word = Ident { text: unit.to_owned(), span };
    let error = Diagnostic::error("unknown-unit", span, format!("there is no unit `{unit}`"));
    if let Some((_, instead)) = units::ELSEWHERE.iter().find(|(name, _)| *name == unit) {
        return error.note(*instead);
    }
    let error = error
        .note("units are for example `m`, `cm`, `s`, `ms`, `Hz`, `deg`, `rad`, `kg`, `m/s`, `rad/s`, `m/s^2`, `%`");
    suggest(error, &word, units::names())
}

/// The unit behind a type.
pub fn declared_unit(unit: &Ident) -> Evaluated<Unit> {
    units::parse(&unit.text).map_err(|part| {
        let start = unit.span.start as usize + (part.as_ptr() as usize - unit.text.as_ptr() as usize);
        Box::new(unknown_unit(part, Span::new(unit.span.file, start, start + part.len())))
    })
}

fn unary(operator: &str, value: Value, span: Span) -> Evaluated<Value> {
    match (operator, value) {
        (_, Value::RustDefault) => Ok(Value::RustDefault),
        ("-", Value::Number(n)) => {
            let exact = n.exact.and_then(Fraction::checked_neg);
            if exact.is_none() && n.integer().is_some() {
                return error("bad-number", span, "this number is too large");
            }
            Ok(Value::Number(Number { value: -n.value, exact, ..n }))
        }
        ("!", Value::Bool(b)) => Ok(Value::Bool(!b)),
        (_, value) => error("wrong-value", span, format!("`{operator}` cannot be applied to {}", describe(&value))),
    }
}

fn binary(operator: &str, (a, at_a): (Value, Span), (b, at_b): (Value, Span), span: Span) -> Evaluated<Value> {
    match (&a, &b) {
        // An unknown value fits everywhere.
        (Value::RustDefault, _) | (_, Value::RustDefault) => Ok(Value::RustDefault),
        (Value::Number(x), Value::Number(y)) => arithmetic(operator, (*x, at_a), (*y, at_b), span),
        (Value::Bool(x), Value::Bool(y)) => match operator {
            "&&" => Ok(Value::Bool(*x && *y)),
            "||" => Ok(Value::Bool(*x || *y)),
            "==" => Ok(Value::Bool(x == y)),
            "!=" => Ok(Value::Bool(x != y)),
            _ => error("wrong-value", span, format!("`{operator}` cannot be applied to truth values")),
        },
        (Value::Text(x), Value::Text(y)) if operator == "==" => Ok(Value::Bool(x == y)),
        (Value::Text(x), Value::Text(y)) if operator == "!=" => Ok(Value::Bool(x != y)),
        _ => {
            let message = format!("`{operator}` cannot be applied to {} and {}", describe(&a), describe(&b));
            error("wrong-value", span, message)
        }
    }
}

fn arithmetic(operator: &str, (x, at_x): (Number, Span), (y, at_y): (Number, Span), span: Span) -> Evaluated<Value> {
    let dimension = match operator {
        "*" => x.dimension.combine(y.dimension, 1),
        "/" => x.dimension.combine(y.dimension, -1),
        _ if x.dimension == y.dimension => Some(x.dimension),
        _ => {
            let message = format!("`{operator}` needs two values of the same kind");
            let diagnostic = Diagnostic::error("wrong-unit", span, message)
                .also(at_x, format!("this is {}", kind(x)))
                .also(at_y, format!("this is {}", kind(y)));
            return Err(Box::new(diagnostic));
        }
    };
    let Some(dimension) = dimension else {
        return error("wrong-unit", span, "the exponents in the unit of this value are too large");
    };
    let exact = x.exact.zip(y.exact);
    // A number that is not a fraction, or too long for one, is rounded; whole numbers never are.
    let result = |value: f64, exactly: fn(Fraction, Fraction) -> Option<Fraction>| {
        let is_whole = x.integer().is_some() && y.integer().is_some();
        match exact.and_then(|(a, b)| exactly(a, b)) {
            None if is_whole || !value.is_finite() => error("bad-number", span, "this number is too large"),
            exact => {
                let value = exact.map_or(value, Fraction::value);
                let is_float = x.is_float || y.is_float || exact.and_then(Fraction::integer).is_none();
                Ok(Value::Number(Number { value, exact, is_float, dimension }))
            }
        }
    };
    let order = || exact.and_then(|(a, b)| a.checked_cmp(b)).or_else(|| x.value.partial_cmp(&y.value));
    let truth = |is: fn(Ordering) -> bool| Ok(Value::Bool(order().is_some_and(is)));
    match operator {
        "+" => result(x.value + y.value, Fraction::checked_add),
        "-" => result(x.value - y.value, Fraction::checked_sub),
        "*" => result(x.value * y.value, Fraction::checked_mul),
        "/" | "%" if y.value == 0.0 => error("bad-number", span, "division by zero"),
        "/" => result(x.value / y.value, Fraction::checked_div),
        "%" => result(x.value % y.value, Fraction::checked_rem),
        "<" => truth(Ordering::is_lt),
        ">" => truth(Ordering::is_gt),
        "<=" => truth(Ordering::is_le),
        ">=" => truth(Ordering::is_ge),
        "==" => truth(Ordering::is_eq),
        "!=" => truth(Ordering::is_ne),
        _ => error("wrong-value", span, format!("`{operator}` cannot be applied to numbers")),
    }
}

fn kind(n: Number) -> String {
    if n.dimension.is_none() {
        n.dimension.noun().to_owned()
    } else {
        format!("{} ({})", n.dimension.noun(), n.dimension)
    }
}

/// A number with its unit, as written in a source file.
fn si(n: Number) -> String {
    if n.dimension.is_none() { n.value.to_string() } else { format!("{}{}", n.value, n.dimension) }
}

/// Description of a value for messages.
pub fn describe(value: &Value) -> String {
    match value {
        Value::Number(n) => kind(*n),
        Value::Bool(_) => "a truth value".to_owned(),
        Value::Text(_) => "a string".to_owned(),
        Value::List(_) => "a list".to_owned(),
        Value::Duration(_) => "a time".to_owned(),
        Value::Unit => "`()`".to_owned(),
        Value::Path(..) => format!("`{}`", value.text()),
        Value::Struct(given) => format!("a `{}`", given.ty.name()),
        Value::RustDefault => "a default".to_owned(),
    }
}

/// Requirements of a parameter on its value.
pub struct Wanted<'a> {
    /// Name of the parameter, for messages.
    pub name: &'a str,
    /// Type of the parameter.
    pub ty: &'a Type,
    /// Unit of the parameter.
    pub unit: Option<&'a str>,
    /// Smallest and largest value in SI units, and `true` if the largest value is included.
    pub range: Option<(Option<f64>, Option<f64>, bool)>,
    /// Place of the declaration, as a sentence.
    pub declared: String,
}

impl Wanted<'_> {
    /// The value as the parameter stores it; an error if it does not fit.
    pub fn fit(&self, value: Value, expr: &Expr) -> Evaluated<Value> {
        let fitted = self.check_constant(&value, self.ty, expr).and_then(|()| self.fit_type(value, self.ty, expr));
        fitted.map_err(|error| Box::new(error.note(self.declared.clone())))
    }

    /// Reports a constant of Rust whose type is not `ty`, that of the parameter or of its elements.
    fn check_constant(&self, value: &Value, ty: &Type, expr: &Expr) -> Evaluated<()> {
        let Value::Path(_, own) = value else { return Ok(()) };
        if own.compare(ty) != Match::Different {
            return Ok(());
        }
        let subject = if ty == self.ty { "" } else { "an element of " };
        let message = format!("{subject}`{}` is a `{ty}`, but {} is a `{own}`", self.name, describe(value));
        error("wrong-value", expr.span, message)
    }

    fn wrong(&self, value: &Value, ty: &Type, span: Span) -> Evaluated<Value> {
        let wanted = if ty.name() == "Duration" || ty.is_time() { "time".to_owned() } else { format!("`{ty}`") };
        let message = format!("`{}` is a {wanted}, but this is {}", self.name, describe(value));
        error("wrong-value", span, message)
    }

    fn fit_type(&self, value: Value, ty: &Type, expr: &Expr) -> Evaluated<Value> {
        if let Type::Measured(number, unit) = ty {
            return self.fit_measured(value, number, unit, expr);
        }
        match ty.name() {
            _ if ty.is_time() => return self.fit_duration(value, ty, expr),
            "Duration" if !matches!(ty, Type::Def(..)) => return self.fit_duration(value, ty, expr),
            "f32" | "f64" => return self.fit_number(value, ty, expr),
            name if limits(name).is_some() => return self.fit_integer(value, ty, expr),
            _ => {}
        }
        match (ty, &value) {
            (_, Value::Path(..) | Value::RustDefault) => Ok(value),
            (Type::Ref(inner), _) => self.fit_type(value, inner, expr),
            (Type::Primitive(name), Value::Bool(_)) if name == "bool" => Ok(value),
            (Type::Primitive(name), Value::Text(_)) if name == "str" => Ok(value),
            (Type::Named(name, _), Value::Text(_)) if name == "String" => Ok(value),
            (Type::Array(element, len), Value::List(items)) => {
                if let Some(len) = len.as_ref().and_then(|n| n.parse::<usize>().ok())
                    && len != items.len()
                {
                    return error(
                        "wrong-value",
                        expr.span,
                        format!("`{}` takes {len} values, not {}", self.name, items.len()),
                    );
                }
                let fit = |(i, item): (usize, &Value)| {
                    let expr = element_of(expr, i);
                    self.check_constant(item, element, expr)?;
                    self.fit_type(item.clone(), element, expr)
                };
                items.iter().enumerate().map(fit).collect::<Evaluated<_>>().map(Value::List)
            }
            (_, Value::Struct(given)) if given.ty.compare(ty) != Match::Different => {
                super::structs::fit(given, ty, expr)
            }
            // Only rustc knows the type behind another name, which may be a number.
            _ if ty.may_be_another() && !matches!(value, Value::List(_)) => Ok(value),
            _ => self.wrong(&value, ty, expr.span),
        }
    }

    /// A value for a token of type `ty` in `unit`. It stays in SI: generated code has it in the unit.
    fn fit_measured(&self, value: Value, ty: &Type, unit: &str, expr: &Expr) -> Evaluated<Value> {
        let (Value::Number(n), Ok(measure)) = (&value, units::parse(unit)) else {
            return self.fit_type(value, ty, expr);
        };
        Wanted { unit: Some(unit), declared: String::new(), ..*self }.check_unit(*n, expr)?;
        self.fit_type(Value::Number(n.in_unit(measure)), ty, expr)?;
        Ok(value)
    }

    fn check_unit(&self, n: Number, expr: &Expr) -> Evaluated<()> {
        let unit = self.unit.and_then(|u| units::parse(u).ok());
        let wanted = unit.map_or(Dimension::NONE, |u| u.dimension);
        if n.dimension == wanted {
            return Ok(());
        }
        if n.dimension.is_none() {
            let unit = self.unit.unwrap_or_default();
            let message = format!("`{}` is {}: the unit is missing", self.name, wanted.noun());
            let ty = self.ty.without_unit().to_string().replace("core::time::", "");
            let declared = if ty.contains("Duration") { ty } else { format!("{ty}[{unit}]") };
            return Err(Box::new(missing_unit(message, expr, &declared, &[(&format!("`{unit}`"), unit)])));
        }
        let message =
            format!("`{}` is {}, but this is {}", self.name, kind(Number { dimension: wanted, ..n }), kind(n));
        let error = Diagnostic::error("wrong-unit", expr.span, message);
        Err(Box::new(if wanted == Dimension::TIME { minutes(error, expr) } else { error }))
    }

    fn check_range(&self, value: f64, span: Span) -> Evaluated<()> {
        let Some((low, high, inclusive)) = self.range else { return Ok(()) };
        let below = low.is_some_and(|low| value < low);
        let above = high.is_some_and(|high| if inclusive { value > high } else { value >= high });
        if !below && !above {
            return Ok(());
        }
        let bound = |b: Option<f64>| b.map(|v| v.to_string()).unwrap_or_default();
        let dimension = self.unit.and_then(|u| units::parse(u).ok()).map_or(Dimension::NONE, |u| u.dimension);
        let unit = if dimension.is_none() { String::new() } else { format!(" {dimension}") };
        let dots = if inclusive { "..=" } else { ".." };
        let message = format!(
            "{value}{unit} is out of range: `{}` must be in {}{dots}{}{unit}",
            self.name,
            bound(low),
            bound(high)
        );
        error("out-of-range", span, message)
    }

    fn fit_number(&self, value: Value, ty: &Type, expr: &Expr) -> Evaluated<Value> {
        match value {
            Value::Number(n) => {
                self.check_unit(n, expr)?;
                self.check_range(n.value, expr.span)?;
                if ty.name() == "f32" && n.value.abs() > f32::MAX.into() {
                    return error("out-of-range", expr.span, format!("{} does not fit into `{ty}`", n.value));
                }
                Ok(Value::Number(Number { is_float: true, ..n }))
            }
            Value::Path(..) | Value::RustDefault => Ok(value),
            _ => self.wrong(&value, ty, expr.span),
        }
    }

    fn fit_integer(&self, value: Value, ty: &Type, expr: &Expr) -> Evaluated<Value> {
        match value {
            Value::Number(n) => {
                self.check_unit(n, expr)?;
                self.check_range(n.value, expr.span)?;
                let Some(integer) = n.integer() else {
                    let message = format!("`{}` must be a whole number (`{ty}`), but this is {}", self.name, si(n));
                    return error("wrong-value", expr.span, message);
                };
                match limits(ty.name()) {
                    Some((low, high)) if integer < low || integer > high => {
                        error("out-of-range", expr.span, format!("{integer} does not fit into `{ty}` ({low}..={high})"))
                    }
                    _ => Ok(value),
                }
            }
            Value::Path(..) | Value::RustDefault => Ok(value),
            _ => self.wrong(&value, ty, expr.span),
        }
    }

    fn fit_duration(&self, value: Value, ty: &Type, expr: &Expr) -> Evaluated<Value> {
        match value {
            Value::Number(n) => {
                let seconds = Wanted { unit: Some("s"), ..Self { declared: String::new(), ..*self } };
                seconds.check_unit(n, expr)?;
                seconds.check_range(n.value, expr.span)?;
                duration(n, expr).map(Value::Duration)
            }
            Value::Duration(_) | Value::Path(..) | Value::RustDefault => Ok(value),
            _ => self.wrong(&value, ty, expr.span),
        }
    }
}

/// The element of a list, if it is written as one.
pub fn element_of(list: &Expr, index: usize) -> &Expr {
    match &list.kind {
        ExprKind::List(items) => items.get(index).unwrap_or(list),
        _ => list,
    }
}

/// An error about a value without a unit, where one of `units` (name and symbol) is expected. The unit can be suggested
/// only behind a number; a parameter must be declared as `declared`.
fn missing_unit(message: impl Into<String>, expr: &Expr, declared: &str, units: &[(&str, &str)]) -> Diagnostic {
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
fn minutes(error: Diagnostic, expr: &Expr) -> Diagnostic {
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

/// The smallest and the largest value of an integer type.
pub fn limits(name: &str) -> Option<(i128, i128)> {
    Some(match name {
        "u8" => (0, u8::MAX.into()),
        "u16" => (0, u16::MAX.into()),
        "u32" => (0, u32::MAX.into()),
        "u64" | "usize" => (0, u64::MAX.into()),
        "i8" => (i8::MIN.into(), i8::MAX.into()),
        "i16" => (i16::MIN.into(), i16::MAX.into()),
        "i32" => (i32::MIN.into(), i32::MAX.into()),
        "i64" | "isize" => (i64::MIN.into(), i64::MAX.into()),
        "u128" => (0, i128::MAX),
        "i128" => (i128::MIN, i128::MAX),
        _ => return None,
    })
}
