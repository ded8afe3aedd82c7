//! Parameters, as far as they are known at compile time.

use core::fmt;

/// A parameter of a program.
///
/// ```
/// use apex_rt::prelude::*;
///
/// apex_macros::graph!("examples/smooth.afg");
///
/// # fn main() {
/// let weight = &Smooth::PARAMS[0];
/// assert_eq!((weight.name, weight.ty, weight.unit), ("filter.weight", "f64", None));
/// assert_eq!(weight.range.to_string(), "0..=1");
/// # }
/// ```
#[derive(Debug, PartialEq)]
pub struct ParamInfo {
    /// Full name: `fast.planner.speed`.
    pub name: &'static str,
    /// Type, as written in its declaration.
    pub ty: &'static str,
    /// SI unit of its numbers.
    pub unit: Option<&'static str>,
    /// Range of its values, as far as it is known.
    pub range: ParamRange,
}

/// Range of a parameter, as far as the compiler knows it. A bound that is not a plain number is missing.
///
/// ```
/// use apex_rt::params::ParamRange;
///
/// let range = ParamRange { min: Some(0.0), max: None, inclusive: false };
/// assert!(range.is_known());
/// assert_eq!(range.to_string(), "0..");
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ParamRange {
    /// The smallest value.
    pub min: Option<f64>,
    /// The largest value.
    pub max: Option<f64>,
    /// `true` if the largest value is part of the range.
    pub inclusive: bool,
}

/// A parameter in the declaration of its node type.
#[doc(hidden)]
#[derive(Debug)]
pub struct Declared {
    unit: Option<&'static str>,
    range: ParamRange,
}

impl Declared {
    /// Returns a parameter with the SI unit of its numbers, and its range.
    pub const fn new(unit: Option<&'static str>, range: ParamRange) -> Self {
        Self { unit, range }
    }

    /// Returns such a parameter with values that are also in another range.
    #[must_use]
    pub const fn within(&self, range: ParamRange) -> Self {
        Self { unit: self.unit, range: self.range.and(range) }
    }

    /// Returns the row of such a parameter of a program.
    pub const fn of(&self, name: &'static str, ty: &'static str) -> ParamInfo {
        ParamInfo { name, ty, unit: self.unit, range: self.range }
    }
}

impl ParamRange {
    /// Returns the range with these bounds.
    pub const fn new(min: Option<f64>, max: Option<f64>, inclusive: bool) -> Self {
        Self { min, max, inclusive }
    }

    /// Returns `true` if at least one bound is known.
    pub const fn is_known(&self) -> bool {
        self.min.is_some() || self.max.is_some()
    }

    /// Returns the range of the values that are in both.
    const fn and(self, other: Self) -> Self {
        let min = match (self.min, other.min) {
            (Some(one), Some(other)) if one > other => Some(one),
            (one, None) => one,
            (_, other) => other,
        };
        let Self { max, inclusive, .. } = match (self.max, other.max) {
            (Some(one), Some(of_other)) if one < of_other || one == of_other && !self.inclusive => self,
            (Some(_), None) => self,
            _ => other,
        };
        Self { min, max, inclusive }
    }

    /// Returns `true` if a number is in the range.
    pub(super) fn has(&self, value: f64) -> bool {
        let is_above = self.min.is_none_or(|min| value >= min);
        let is_below = |max: f64| if self.inclusive { value <= max } else { value < max };
        is_above && self.max.is_none_or(is_below)
    }
}

impl fmt::Display for ParamRange {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(min) = self.min {
            write!(f, "{min}")?;
        }
        f.write_str(if self.inclusive && self.max.is_some() { "..=" } else { ".." })?;
        self.max.map_or(Ok(()), |max| write!(f, "{max}"))
    }
}
