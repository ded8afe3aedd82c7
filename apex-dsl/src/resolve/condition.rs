//! Conditions on a token: checks of their types and of the constants in them.

use super::{
    scope::{Evaluated, Scope},
    value::{describe, evaluate, limits},
    wanted::Wanted,
};
use crate::{
    catalog::Type,
    graph::{Condition, Number, Value, is_arithmetic},
    report::Diagnostic,
    source::Span,
    syntax::tree::{Expr, ExprKind, Ident},
};

/// Kind of a part of a condition.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Number,
    Truth,
    /// A type whose comparisons only rustc knows.
    Other,
}

/// Note on what is neither true nor false.
const COMPARE: &str = "compare it by `==`, `!=`, `<`, `<=`, `>` or `>=`";

/// Reads conditions on a token.
pub struct Conditions<'a> {
    /// Name of the token in messages.
    pub name: &'a str,
    /// Name of the token in the condition; empty if it has none.
    pub token: &'a str,
    /// Type of the token.
    pub ty: &'a Type,
    /// Meaning of other names.
    pub scope: &'a Scope<'a>,
}

impl Conditions<'_> {
    /// Reads a condition in which the token has its name.
    pub fn read(&self, expr: &Expr) -> Evaluated<Condition> {
        let (condition, kind) = self.part(expr)?;
        let what = match (kind, &condition) {
            (Kind::Number, _) => "a number".to_owned(),
            (Kind::Other, Condition::Token) if !self.ty.may_be_another() => format!("a `{}`", self.ty),
            _ => return Ok(condition),
        };
        let message = format!("a condition must be true or false, but this is {what}");
        let error = Diagnostic::error("wrong-value", expr.span, message);
        Err(Box::new(error.note(COMPARE)))
    }

    /// Comparison of the token with a constant.
    pub fn comparison(&self, operator: &'static str, value: &Expr) -> Evaluated<Condition> {
        let (constant, kind) = self.part(value)?;
        let token = (Condition::Token, self.kind_of_token());
        let (condition, _) = self.binary(operator, (token, value), ((constant, kind), value), value.span)?;
        Ok(condition)
    }

    /// A token that is true or false by itself, at this place.
    pub fn truth(&self, span: Span) -> Evaluated<Condition> {
        if self.kind_of_token() == Kind::Truth {
            return Ok(Condition::Token);
        }
        let message = format!("a condition must be true or false, but `{}` is a `{}`", self.name, self.ty);
        let error = Diagnostic::error("wrong-value", span, message);
        Err(Box::new(error.note(COMPARE)))
    }

    /// Comparison of the token with a number, up to a difference: `== 1.5m +- 1cm`.
    pub fn nearness(&self, operator: &str, value: &Expr, tolerance: &Expr) -> Evaluated<Condition> {
        let error = |message: &str| Box::new(Diagnostic::error("wrong-value", tolerance.span, message));
        if !matches!(operator, "==" | "!=") {
            return Err(error("`+-` belongs to `==` or `!=`"));
        }
        if matches!(evaluate(tolerance, self.scope)?, Value::Number(n) if n.value < 0.0) {
            return Err(error("the tolerance behind `+-` must not be negative"));
        }
        let bound = |sign| {
            let (value, tolerance) = (Box::new(value.clone()), Box::new(tolerance.clone()));
            Expr { span: value.span.to(tolerance.span), kind: ExprKind::Binary(sign, value, tolerance) }
        };
        let (low, high) = (self.comparison(">=", &bound("-"))?, self.comparison("<=", &bound("+"))?);
        let near = Condition::Binary(Box::new(low), "&&", Box::new(high));
        Ok(if operator == "!=" { Condition::Unary("!", Box::new(near)) } else { near })
    }

    /// Turns an error about an unknown name in a condition into one that suggests the name of the token.
    fn unknown_token(&self, error: Box<Diagnostic>, expr: &Expr) -> Box<Diagnostic> {
        let names = names_in(expr);
        let unknown = names.into_iter().find(|name| name.span == error.primary.span);
        let Some(name) = unknown.filter(|_| error.code == "unknown-name" && !self.token.is_empty()) else {
            return error;
        };
        let message = format!("there is no `{}` here: the token has the name of its slot, `{}`", name.text, self.token);
        let error = Diagnostic::error("unknown-name", name.span, message);
        let error =
            error.note("a guard compares the token with literals and with Rust constants, written with their path");
        Box::new(error.guess(format!("did you mean `{}`?", self.token), name.span, self.token))
    }

    fn kind_of_token(&self) -> Kind {
        match self.ty {
            Type::Primitive(name) if name == "bool" => Kind::Truth,
            _ if is_number(self.ty) => Kind::Number,
            _ => Kind::Other,
        }
    }

    fn part(&self, expr: &Expr) -> Evaluated<(Condition, Kind)> {
        if !mentions(expr, self.token) {
            let value = evaluate(expr, self.scope).map_err(|error| self.unknown_token(error, expr))?;
            let kind = match &value {
                Value::Number(_) => Kind::Number,
                Value::Bool(_) => Kind::Truth,
                _ => Kind::Other,
            };
            return Ok((Condition::Constant(value), kind));
        }
        match &expr.kind {
            ExprKind::Path(_) => Ok((Condition::Token, self.kind_of_token())),
            ExprKind::Unary(operator, inner) => {
                let (condition, kind) = self.part(inner)?;
                let wanted = if *operator == "!" { Kind::Truth } else { Kind::Number };
                if kind != wanted {
                    return self.cannot(operator, &[(&condition, kind)], expr.span);
                }
                Ok((Condition::Unary(operator, Box::new(condition)), kind))
            }
            ExprKind::Binary(operator, a, b) => {
                let (left, right) = (self.part(a)?, self.part(b)?);
                self.binary(operator, (left, a), (right, b), expr.span)
            }
            _ => {
                let message = "a condition can only compare the token with constants";
                Err(Box::new(Diagnostic::error("wrong-value", expr.span, message)))
            }
        }
    }

    fn binary(
        &self,
        operator: &'static str,
        ((left, a), left_expr): ((Condition, Kind), &Expr),
        ((right, b), right_expr): ((Condition, Kind), &Expr),
        span: Span,
    ) -> Evaluated<(Condition, Kind)> {
        let result = match operator {
            "&&" | "||" if (a, b) == (Kind::Truth, Kind::Truth) => Kind::Truth,
            _ if is_arithmetic(operator) && (a, b) == (Kind::Number, Kind::Number) => Kind::Number,
            "==" | "!=" if a == b || a == Kind::Other || b == Kind::Other => Kind::Truth,
            "<" | "<=" | ">" | ">="
                if (a == b && a != Kind::Truth) || (a != b && a != Kind::Truth && b != Kind::Truth) =>
            {
                Kind::Truth
            }
            _ => return self.cannot(operator, &[(&left, a), (&right, b)], span),
        };
        if matches!(operator, "/" | "%") && matches!(&right, Condition::Constant(Value::Number(n)) if n.value == 0.0) {
            return Err(Box::new(Diagnostic::error("bad-number", span, "division by zero")));
        }
        let computes = is_arithmetic(operator) || left.computes() || right.computes();
        if computes && matches!(self.ty, Type::Measured(..)) {
            let message =
                format!("the token is in a unit (`{}`): it can be compared, but not be calculated with", self.ty);
            return Err(Box::new(Diagnostic::error("wrong-unit", span, message)));
        }
        let (left, right) = (self.fit(left, left_expr, computes)?, self.fit(right, right_expr, computes)?);
        for constant in [&left, &right] {
            self.check_struct(operator, constant, span)?;
        }
        Ok((Condition::Binary(Box::new(left), operator, Box::new(right)), result))
    }

    fn cannot<T>(&self, operator: &str, parts: &[(&Condition, Kind)], span: Span) -> Evaluated<T> {
        let words: Vec<String> = parts
            .iter()
            .map(|(condition, kind)| match (condition, kind) {
                (Condition::Constant(value), _) => describe(value),
                (Condition::Token, _) => format!("a token `{}`", self.ty),
                (_, Kind::Number) => "a number".to_owned(),
                _ => "a truth value".to_owned(),
            })
            .collect();
        let message = format!("`{operator}` cannot be applied to {}", words.join(" and "));
        Err(Box::new(Diagnostic::error("wrong-value", span, message)))
    }

    /// Fits a constant to the type of the token that it is compared with. This type does not limit the result of a
    /// computation.
    fn fit(&self, condition: Condition, expr: &Expr, computes: bool) -> Evaluated<Condition> {
        let Condition::Constant(value) = condition else { return Ok(condition) };
        if computes && let Value::Number(n) = value {
            return self.number(n, expr).map(Condition::Constant);
        }
        if matches!(self.ty, Type::Def(..)) && !matches!(value, Value::Path(..) | Value::Struct(_) | Value::RustDefault)
        {
            let message = format!("the token is a `{}`, but this is {}", self.ty, describe(&value));
            let error = Diagnostic::error("wrong-value", expr.span, message);
            return Err(Box::new(
                error.note("compare it with a Rust constant of this type, or with `Name { field: value }`"),
            ));
        }
        let declared = format!("a token of `{}` is a `{}`", self.name, self.ty);
        let wanted = Wanted { name: self.name, ty: self.ty, unit: None, range: None, declared };
        wanted.fit(value, expr).map(Condition::Constant)
    }

    /// Reports a comparison with a struct that Rust may not have: only rustc knows comparisons that are not derived.
    fn check_struct(&self, operator: &str, constant: &Condition, span: Span) -> Evaluated<()> {
        let Condition::Constant(Value::Struct(given)) = constant else { return Ok(()) };
        let name = given.ty.name();
        let error =
            |message: String, note: String| Err(Box::new(Diagnostic::error("wrong-value", span, message).note(note)));
        if !matches!(operator, "==" | "!=") {
            return error(
                format!("`{operator}` cannot be applied to a struct"),
                "a struct is compared by `==` or `!=`".to_owned(),
            );
        }
        match self.scope.rust.catalog.implements(&given.ty, "PartialEq") {
            true => Ok(()),
            false => error(
                format!("a `{name}` cannot be compared: it does not derive `PartialEq`"),
                format!("write `#[derive(PartialEq)]` before `{name}`, or compare with a Rust constant of this type"),
            ),
        }
    }

    fn number(&self, n: Number, expr: &Expr) -> Evaluated<Value> {
        if !n.dimension.is_none() {
            let message = "tokens have no unit in calculations, but this value has one";
            return Err(Box::new(Diagnostic::error("wrong-unit", expr.span, message)));
        }
        match (limits(self.ty.name()), n.integer()) {
            (None, _) => Ok(Value::Number(Number { is_float: true, ..n })),
            (Some(_), Some(integer)) if i64::try_from(integer).is_ok() => Ok(Value::Number(n)),
            (Some(_), Some(_)) => {
                Err(Box::new(Diagnostic::error("bad-number", expr.span, "this number is too large for calculations")))
            }
            (Some(_), None) => {
                let message = format!("the token is a whole number (`{}`), but this is not", self.ty);
                Err(Box::new(Diagnostic::error("wrong-value", expr.span, message)))
            }
        }
    }
}

fn is_number(ty: &Type) -> bool {
    matches!(ty.without_unit(), Type::Primitive(name) if matches!(name.as_str(), "f32" | "f64") || limits(name).is_some())
}

fn mentions(expr: &Expr, name: &str) -> bool {
    names_in(expr).iter().any(|found| found.text == name)
}

/// The plain names in an expression, without longer paths.
pub fn names_in(expr: &Expr) -> Vec<&Ident> {
    match &expr.kind {
        ExprKind::Path(path) => match path.segments.as_slice() {
            [name] => vec![name],
            _ => vec![],
        },
        ExprKind::Unary(_, inner) => names_in(inner),
        ExprKind::Binary(_, a, b) => [names_in(a), names_in(b)].concat(),
        ExprKind::List(items) => items.iter().flat_map(names_in).collect(),
        ExprKind::Struct(_, fields) => fields.iter().flat_map(|(_, value)| names_in(value)).collect(),
        ExprKind::Number(..) | ExprKind::Text(_) | ExprKind::Bool(_) => vec![],
    }
}
