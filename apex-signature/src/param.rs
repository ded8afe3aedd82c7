//! Parameters of nodes: `#[param(…)]` before an argument or a field.

use crate::{types::is_named, units};
use syn::{Attribute, Expr, ExprLit, ExprRange, ExprUnary, Lit, RangeLimits, Type, UnOp, spanned::Spanned as _};

/// `#[param(…)]` with the type of its argument or field.
pub struct ParamDecl {
    /// The type of the value.
    pub ty: Type,
    /// Unit of plain numbers, for example `m/s`.
    pub unit: Option<String>,
    /// Value without an argument in the source file.
    pub default: Option<Expr>,
    /// Legal values.
    pub range: Option<ExprRange>,
    /// `true` for `silence`: without tokens for this time the node is called with ⊥.
    pub is_silence: bool,
}

impl ParamDecl {
    /// Smallest and largest value, as far as they are written in plain numbers, and whether the largest is part of the
    /// range.
    pub fn limits(&self) -> Option<(Option<f64>, Option<f64>, bool)> {
        let range = self.range.as_ref()?;
        let number = |bound: &Option<Box<Expr>>| bound.as_deref().and_then(number);
        Some((number(&range.start), number(&range.end), matches!(range.limits, RangeLimits::Closed(_))))
    }

    /// The SI unit of its values, whatever the unit of the declaration is; none for plain numbers.
    pub fn si_unit(&self) -> Option<String> {
        let dimension = match self.is_duration() {
            true => units::Dimension::TIME,
            false => units::parse(self.unit.as_deref()?).ok()?.dimension,
        };
        (!dimension.is_none()).then(|| dimension.to_string())
    }

    /// Returns `true` if its type is called `Duration`.
    pub fn is_duration(&self) -> bool {
        is_named(&self.ty, "Duration")
    }
}

/// Reads the `#[param(…)]` of an argument or field of this type, if it has one.
pub fn param(attrs: &[Attribute], ty: &Type) -> syn::Result<Option<ParamDecl>> {
    let Some(attr) = attrs.iter().find(|a| a.path().is_ident("param")) else { return Ok(None) };
    let mut decl = ParamDecl { ty: ty.clone(), unit: None, default: None, range: None, is_silence: false };
    if matches!(attr.meta, syn::Meta::Path(_)) {
        return Ok(Some(decl));
    }
    attr.parse_nested_meta(|meta| {
        if meta.path.is_ident("unit") {
            let unit = meta.value()?.parse::<syn::LitStr>()?;
            decl.unit = Some(unit.value());
        } else if meta.path.is_ident("default") {
            decl.default = Some(meta.value()?.parse()?);
        } else if meta.path.is_ident("range") {
            let expr: Expr = meta.value()?.parse()?;
            let Expr::Range(range) = expr else {
                return Err(syn::Error::new(expr.span(), "a range is written `0.0..=2.0`"));
            };
            decl.range = Some(range);
        } else if meta.path.is_ident("silence") {
            decl.is_silence = true;
        } else {
            return Err(meta.error("a parameter has `unit`, `default`, `range` and `silence`"));
        }
        Ok(())
    })?;
    Ok(Some(decl))
}

/// Number that is written out.
fn number(expr: &Expr) -> Option<f64> {
    match expr {
        Expr::Lit(ExprLit { lit: Lit::Int(digits), .. }) => digits.base10_parse().ok(),
        Expr::Lit(ExprLit { lit: Lit::Float(digits), .. }) => digits.base10_parse().ok(),
        Expr::Unary(ExprUnary { op: UnOp::Neg(_), expr, .. }) => number(expr).map(|value| -value),
        _ => None,
    }
}
