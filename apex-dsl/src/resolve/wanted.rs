//! Requirements of a parameter, a port or a field on its value, and conversion of the value to the type.

use super::{
    scope::Evaluated,
    time::{duration, minutes, missing_unit},
    value::{describe, error, kind, limits, si},
};
use crate::{
    catalog::{Limits, Match, Type},
    graph::{FieldValue, Number, StructValue, Value},
    report::Diagnostic,
    source::Span,
    syntax::tree::{Expr, ExprKind},
    units::{self, Dimension},
};

/// Requirements of a parameter on its value.
pub struct Wanted<'a> {
    /// Name of the parameter, for messages.
    pub name: &'a str,
    /// Type of the parameter.
    pub ty: &'a Type,
    /// Unit of the parameter.
    pub unit: Option<&'a str>,
    /// Smallest and largest value in SI units, and `true` if the largest value is included.
    pub range: Option<Limits>,
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
            (_, Value::Struct(given)) if given.ty.compare(ty) != Match::Different => fit_struct(given, ty, expr),
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

/// The struct with fields that fit its declaration. The type arguments are those of `ty`, as far as it has any.
fn fit_struct(given: &StructValue, ty: &Type, expr: &Expr) -> Evaluated<Value> {
    let argument = |name: &str| match (&given.ty, ty) {
        (Type::Def(_, _, params), Type::Def(_, _, args)) => {
            let position = params.iter().position(|param| matches!(param, Type::Param(param) if param == name));
            position.and_then(|position| args.get(position).cloned())
        }
        _ => None,
    };
    let field = |field: &FieldValue| {
        let ty = field.ty.substitute(&argument);
        let declared = format!("`{}: {ty}` is a field of `{}`", field.name, given.ty.name());
        let wanted = Wanted { name: &field.name, ty: &ty, unit: None, range: None, declared };
        let value = wanted.fit(field.value.clone(), value_of(expr, &field.name))?;
        Ok(FieldValue { name: field.name.clone(), ty: ty.clone(), value })
    };
    let fields = given.fields.iter().map(field).collect::<Evaluated<_>>()?;
    Ok(Value::Struct(StructValue { fields, ..given.clone() }))
}

/// The expression of a field, if it is written here.
fn value_of<'a>(expr: &'a Expr, name: &str) -> &'a Expr {
    match &expr.kind {
        ExprKind::Struct(_, fields) => fields.iter().find(|(field, _)| field.text == name).map_or(expr, |(_, at)| at),
        _ => expr,
    }
}
