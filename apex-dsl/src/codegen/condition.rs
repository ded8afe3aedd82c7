//! Conditions on a token as Rust. A comparison is made in the token's own type. What is computed with integers is
//! computed in a wide one, and where it has no result (a division by zero) the condition does not hold: nothing wraps,
//! nothing panics.

use super::tokens::constant;
use crate::{
    catalog::Type,
    graph::{Condition, Value, is_arithmetic},
};
use proc_macro2::TokenStream;
use quote::{format_ident, quote};

/// Expression that is `true` if `condition` holds for `*token`, which is of type `ty`.
pub fn holds(condition: &Condition, ty: &Type) -> TokenStream {
    let computes = condition.computes() && ty.is_integer();
    let test = Writer { ty, wide: computes.then(|| width(ty)) }.write(condition);
    match computes {
        true => quote!((|| ::core::option::Option::Some(#test))().unwrap_or(false)),
        false => test,
    }
}

/// The type in which tokens of type `ty` are computed with.
fn width(ty: &Type) -> TokenStream {
    match ty.wide_bits() {
        64 => quote!(::core::primitive::i64),
        _ => quote!(::core::primitive::i128),
    }
}

struct Writer<'a> {
    ty: &'a Type,
    /// The type of all numbers, if something is computed.
    wide: Option<TokenStream>,
}

impl Writer<'_> {
    fn write(&self, condition: &Condition) -> TokenStream {
        match condition {
            Condition::Token => match &self.wide {
                Some(wide) => quote!(<#wide as ::core::convert::TryFrom<_>>::try_from(*token).ok()?),
                None => quote!(*token),
            },
            Condition::Constant(value) => match (&self.wide, value) {
                (Some(wide), Value::Path(..)) => {
                    let value = constant(value, self.ty);
                    quote!(<#wide as ::core::convert::TryFrom<_>>::try_from(#value).ok()?)
                }
                _ => constant(value, self.ty),
            },
            Condition::Unary("-", inner) if self.wide.is_some() => {
                let inner = self.write(inner);
                quote!((#inner).checked_neg()?)
            }
            Condition::Unary(operator, inner) => {
                let (sign, inner) = (sign(operator), self.write(inner));
                quote!(#sign(#inner))
            }
            Condition::Binary(a, operator, b) => match &self.wide {
                Some(wide) if is_arithmetic(operator) => {
                    let (a, b) = (self.write(a), self.write(b));
                    let method = format_ident!("checked_{}", word(operator));
                    quote!(#wide::#method(#a, #b)?)
                }
                _ => {
                    let (a, sign, b) = (self.write(a), sign(operator), self.write(b));
                    quote!((#a #sign #b))
                }
            },
        }
    }
}

fn word(operator: &str) -> &'static str {
    match operator {
        "+" => "add",
        "-" => "sub",
        "*" => "mul",
        "/" => "div",
        _ => "rem",
    }
}

fn sign(operator: &str) -> TokenStream {
    match operator {
        "+" => quote!(+),
        "-" => quote!(-),
        "*" => quote!(*),
        "/" => quote!(/),
        "%" => quote!(%),
        "==" => quote!(==),
        "!=" => quote!(!=),
        "<" => quote!(<),
        "<=" => quote!(<=),
        ">" => quote!(>),
        ">=" => quote!(>=),
        "&&" => quote!(&&),
        "||" => quote!(||),
        _ => quote!(!),
    }
}
