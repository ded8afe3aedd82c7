//! Expressions.

use super::Builder;
use crate::{
    report::Diagnostic,
    source::Span,
    syntax::{Rule, tokens::unescape, tree::*},
};
use pest::iterators::Pair;

/// Largest number of operators in an expression, including the expressions around it. It limits the depth of the tree.
const MAX_OPERATORS: usize = 200;

impl Builder<'_> {
    pub(super) fn expr(&mut self, pair: Pair<'_, Rule>) -> Expr {
        let span = self.span(&pair);
        let mut parts: Vec<Pair<'_, Rule>> = pair.into_inner().collect();
        let count = parts.len();
        if self.open + count > 2 * MAX_OPERATORS {
            self.broken = true;
            let message = format!("an expression has at most {MAX_OPERATORS} operators");
            self.diagnostics.push(Diagnostic::error("too-large", span, message));
            parts.retain(|p| p.as_rule() == Rule::primary);
            parts.truncate(1);
        }
        let count = parts.len();
        self.open += count;
        let expr = self.binary(&mut parts.into_iter().peekable(), 0, span);
        self.open -= count;
        expr
    }

    /// Parses operators by precedence climbing. Operators of the same level associate to the left.
    fn binary<'i>(
        &mut self,
        parts: &mut std::iter::Peekable<impl Iterator<Item = Pair<'i, Rule>>>,
        level: u8,
        span: Span,
    ) -> Expr {
        let mut left = self.prefixed(parts, span);
        while let Some((operator, precedence)) = parts.peek().and_then(operator).filter(|(_, p)| *p >= level) {
            parts.next();
            let right = self.binary(parts, precedence + 1, span);
            let span = left.span.to(right.span);
            left = Expr { kind: ExprKind::Binary(operator, Box::new(left), Box::new(right)), span };
        }
        left
    }

    fn prefixed<'i>(&mut self, parts: &mut impl Iterator<Item = Pair<'i, Rule>>, span: Span) -> Expr {
        let mut prefixes = vec![];
        for part in parts {
            if part.as_rule() == Rule::prefix {
                let sign = if part.as_str().starts_with('!') { "!" } else { "-" };
                prefixes.push((sign, self.span(&part)));
                continue;
            }
            let primary = self.primary(part);
            return prefixes.into_iter().rev().fold(primary, |inner, (sign, at)| {
                let span = at.to(inner.span);
                Expr { kind: ExprKind::Unary(sign, Box::new(inner)), span }
            });
        }
        Expr { kind: ExprKind::Bool(false), span }
    }

    fn primary(&mut self, pair: Pair<'_, Rule>) -> Expr {
        let span = self.span(&pair);
        let Some(inner) = pair.into_inner().next() else {
            return Expr { kind: ExprKind::Bool(false), span };
        };
        let kind = match inner.as_rule() {
            Rule::number => {
                let text = inner.as_str();
                let unit = inner.into_inner().find(|p| p.as_rule() == Rule::unit).map(|p| p.as_str().to_owned());
                let digits = &text[..text.len() - unit.as_ref().map_or(0, String::len)];
                ExprKind::Number(digits.replace('_', ""), unit)
            }
            Rule::string => ExprKind::Text(unescape(inner.as_str())),
            Rule::list_expr => {
                ExprKind::List(inner.into_inner().filter(|p| p.as_rule() == Rule::expr).map(|p| self.expr(p)).collect())
            }
            Rule::struct_expr => self.structure(inner),
            Rule::expr => return Expr { span, ..self.expr(inner) },
            // Pairs include the white space behind a word.
            _ => match inner.as_str().trim_end() {
                "true" => ExprKind::Bool(true),
                "false" => ExprKind::Bool(false),
                _ => ExprKind::Path(self.path(inner)),
            },
        };
        Expr { kind, span }
    }
}

impl Builder<'_> {
    /// `Pose2 { x: 1m, y: 0m }`
    fn structure(&mut self, pair: Pair<'_, Rule>) -> ExprKind {
        let mut parts = pair.into_inner();
        let Some(path) = parts.next().map(|path| self.path(path)) else { return ExprKind::Bool(false) };
        let mut fields = vec![];
        for field in parts.flat_map(Pair::into_inner).filter(|p| p.as_rule() == Rule::field) {
            let mut parts = field.into_inner();
            let name = parts.next().map(|name| self.ident(&name));
            let value = parts.find(|p| p.as_rule() == Rule::expr).map(|value| self.expr(value));
            fields.extend(name.zip(value));
        }
        ExprKind::Struct(path, fields)
    }
}

fn operator(pair: &Pair<'_, Rule>) -> Option<(&'static str, u8)> {
    Some(match pair.as_str().trim_end() {
        _ if pair.as_rule() != Rule::binary => return None,
        "||" => ("||", 1),
        "&&" => ("&&", 2),
        "==" => ("==", 3),
        "!=" => ("!=", 3),
        "<=" => ("<=", 3),
        ">=" => (">=", 3),
        "<" => ("<", 3),
        ">" => (">", 3),
        "+" => ("+", 4),
        "-" => ("-", 4),
        "*" => ("*", 5),
        "/" => ("/", 5),
        _ => ("%", 5),
    })
}
