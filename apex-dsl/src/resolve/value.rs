//! Constant expressions.

use super::{
    scope::{Evaluated, Scope},
    structs,
    suggest::suggest,
};
use crate::{
    catalog::{Constant, Type},
    fraction::Fraction,
    graph::{FieldValue, Number, StructValue, Value},
    report::Diagnostic,
    source::Span,
    syntax::tree::{Expr, ExprKind, Ident, PathExpr},
    units::{self, Unit},
};
use std::cmp::Ordering;

/// The error with this message, as the result of an evaluation.
pub fn error<T>(code: &'static str, span: Span, message: impl Into<String>) -> Evaluated<T> {
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
        ExprKind::Struct(path, fields) => structure(path, fields, scope),
        ExprKind::Unary(operator, inner) => unary(operator, evaluate(inner, scope)?, expr.span),
        ExprKind::Binary(operator, left, right) => {
            let (a, b) = (evaluate(left, scope)?, evaluate(right, scope)?);
            binary(operator, (a, left.span), (b, right.span), expr.span)
        }
    }
}

/// Evaluates a struct with these fields.
fn structure(path: &PathExpr, fields: &[(Ident, Expr)], scope: &Scope<'_>) -> Evaluated<Value> {
    let Some((spelled, declared)) = structs::declared(path, fields, scope.rust)? else { return Ok(Value::RustDefault) };
    let field = |(name, expr): &(Ident, Expr)| {
        let ty = declared.fields.iter().find(|field| field.name == name.text).map(|field| field.ty.clone());
        let value = evaluate(expr, scope)?;
        Ok(FieldValue { name: name.text.clone(), ty: ty.unwrap_or_else(Type::unit), value })
    };
    let fields = fields.iter().map(field).collect::<Evaluated<_>>()?;
    Ok(Value::Struct(StructValue { path: spelled, ty: declared.ty, fields }))
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

/// Kind of a quantity, for messages.
pub fn kind(n: Number) -> String {
    if n.dimension.is_none() {
        n.dimension.noun().to_owned()
    } else {
        format!("{} ({})", n.dimension.noun(), n.dimension)
    }
}

/// A number with its unit, as written in a source file.
pub fn si(n: Number) -> String {
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
