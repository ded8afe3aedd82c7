//! Conditions on a token: guards of state machines and expectations of tests.

use super::Value;

/// A condition on a token, or a part of one.
#[derive(Debug, Clone, PartialEq)]
pub enum Condition {
    /// The token.
    Token,
    /// A constant.
    Constant(Value),
    /// `-a`, `!a`
    Unary(&'static str, Box<Condition>),
    /// `a + b`, `a < b`, `a && b`
    Binary(Box<Condition>, &'static str, Box<Condition>),
}

impl Condition {
    /// Returns `true` if the condition contains arithmetic. Integer arithmetic may have no result: a division by zero,
    /// or a number beyond the widest type.
    pub fn computes(&self) -> bool {
        match self {
            Self::Token | Self::Constant(_) => false,
            Self::Unary(operator, inner) => *operator == "-" && inner.mentions_token() || inner.computes(),
            Self::Binary(a, operator, b) => is_arithmetic(operator) || a.computes() || b.computes(),
        }
    }

    /// Returns `true` if the token occurs in the condition.
    pub fn mentions_token(&self) -> bool {
        match self {
            Self::Token => true,
            Self::Constant(_) => false,
            Self::Unary(_, inner) => inner.mentions_token(),
            Self::Binary(a, _, b) => a.mentions_token() || b.mentions_token(),
        }
    }

    /// The condition as written in a source file, with `token` for the token.
    pub fn text(&self, token: &str) -> String {
        let part = |inner: &Self| match inner {
            Self::Binary(..) => format!("({})", inner.text(token)),
            _ => inner.text(token),
        };
        match self {
            Self::Token => token.to_owned(),
            Self::Constant(value) => value.text(),
            Self::Unary(operator, inner) => format!("{operator}{}", part(inner)),
            Self::Binary(a, operator, b) => format!("{} {operator} {}", part(a), part(b)),
        }
    }
}

/// Returns `true` if an operator computes a number from two numbers.
pub fn is_arithmetic(operator: &str) -> bool {
    matches!(operator, "+" | "-" | "*" | "/" | "%")
}
