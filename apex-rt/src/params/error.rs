//! Errors of values for parameters.

use super::info::ParamInfo;
use core::fmt;

/// Reason for the refusal of a value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Rejection {
    /// The value is of another kind.
    Kind {
        /// Kind that the parameter takes: `a number`.
        expected: &'static str,
        /// Kind that was given: `a string`.
        found: &'static str,
    },
    /// The value does not fit into this type.
    Fit(&'static str),
    /// The value is a list of another length.
    Length {
        /// Number of elements that the parameter takes.
        expected: usize,
        /// Number of elements that were given.
        found: usize,
    },
    /// The value is a list or a string that is too long.
    Long {
        /// Maximum number of elements or bytes.
        most: usize,
    },
    /// The value is written in more bytes than a value may have that is set while the program runs.
    Size {
        /// Maximum number of bytes.
        most: usize,
    },
    /// The value is out of the declared range.
    Range,
    /// The type of the parameter is not a [`ParamValue`](super::ParamValue).
    Opaque,
}

/// Reason why a parameter could not be read or set.
///
/// ```
/// use apex_rt::{params::ParamError, prelude::*};
///
/// apex_macros::graph!("examples/smooth.afg");
///
/// # fn main() {
/// let error = Smooth::new().set_param("filter.wight", 0.25).expect_err("it is misspelt");
/// assert_eq!(error, ParamError::Unknown { nearest: Some("filter.weight") });
/// assert_eq!(error.to_string(), "there is no parameter of this name; did you mean `filter.weight`?");
/// # }
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ParamError {
    /// There is no parameter of this name.
    Unknown {
        /// The most similar name, if one is similar enough.
        nearest: Option<&'static str>,
    },
    /// The value was refused. The parameter keeps its value.
    Refused {
        /// The parameter.
        param: &'static ParamInfo,
        /// Reason for the refusal.
        refusal: Rejection,
    },
    /// The program, which ran on another thread, has ended.
    Ended,
}

impl Rejection {
    /// Writes a sentence about `param`, which includes `value` if it is known.
    pub(super) fn say(
        &self,
        param: &ParamInfo,
        value: Option<&dyn fmt::Display>,
        f: &mut fmt::Formatter<'_>,
    ) -> fmt::Result {
        let name = param.name;
        match self {
            Self::Kind { expected, found } => write!(f, "`{name}` ({}) takes {expected}, not {found}", param.ty),
            Self::Fit(ty) => write!(f, "the value of `{name}` does not fit into `{ty}`"),
            Self::Length { expected, found } => {
                write!(f, "`{name}` ({}) takes {expected} elements, not {found}", param.ty)
            }
            Self::Long { most } => write!(f, "the value of `{name}` is too long: there is room for {most}"),
            Self::Size { most } => write!(
                f,
                "the value of `{name}` ({}) is too long: while the program runs it has at most {most} bytes of text; write a longer one into the source file or a file for `--params`",
                param.ty
            ),
            Self::Range => {
                match value {
                    Some(value) => write!(f, "`{name}` cannot be {value}")?,
                    None => write!(f, "the value of `{name}` is out of range")?,
                }
                match (param.range.is_known(), param.unit) {
                    (true, Some(unit)) => write!(f, ": its range is {} ({unit})", param.range),
                    (true, None) => write!(f, ": its range is {}", param.range),
                    (false, _) => f.write_str(": it is outside the range that its node type declares"),
                }
            }
            Self::Opaque => {
                write!(f, "`{name}` is a `{}`: parameters of this type can only be set in the graph", param.ty)
            }
        }
    }
}

impl fmt::Display for ParamError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unknown { nearest: Some(near) } => {
                write!(f, "there is no parameter of this name; did you mean `{near}`?")
            }
            Self::Unknown { nearest: None } => {
                f.write_str("there is no parameter of this name; `PARAMS` of the program lists all")
            }
            Self::Refused { param, refusal } => refusal.say(param, None, f),
            Self::Ended => f.write_str("the program has ended"),
        }
    }
}

impl core::error::Error for ParamError {}

/// Length in bytes from which names are not compared.
const MAX_NAME: usize = 128;

/// Returns the one of `names` that is most similar to `name`, if it is similar enough.
pub(super) fn nearest(name: &str, names: impl Iterator<Item = &'static str>) -> Option<&'static str> {
    let limit = (name.len() / 3).max(1);
    let near = names.filter(|n| n.len().abs_diff(name.len()) <= limit).filter_map(|n| Some((distance(name, n)?, n)));
    near.filter(|(distance, _)| *distance <= limit).min_by_key(|(distance, _)| *distance).map(|(_, n)| n)
}

/// Edit distance of two names in bytes, in which a swap of two neighbours counts 1; `None` if `b` is too long.
fn distance(a: &str, b: &str) -> Option<usize> {
    let (a, b) = (a.as_bytes(), b.as_bytes());
    let width = b.len() + 1;
    if width > MAX_NAME {
        return None;
    }
    let mut rows = [[0; MAX_NAME]; 2];
    rows[0].iter_mut().enumerate().for_each(|(j, cell)| *cell = j);
    for (i, x) in a.iter().enumerate() {
        let [above, before] = rows;
        let mut row = [i + 1; MAX_NAME];
        for (j, y) in b.iter().enumerate() {
            let best = (above[j] + usize::from(x != y)).min(above[j + 1] + 1).min(row[j] + 1);
            let swapped = i > 0 && j > 0 && *x == b[j - 1] && a[i - 1] == *y;
            row[j + 1] = if swapped { best.min(before[j - 1] + 1) } else { best };
        }
        rows = [row, above];
    }
    rows[0][..width].last().copied()
}
