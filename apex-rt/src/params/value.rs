//! Values of parameters, independent of their types.

use super::Rejection;
use core::{fmt, time::Duration};

/// A value of a parameter, in SI units. `Display` writes it in TOML.
///
/// ```
/// use apex_rt::params::{IntoParam, ParamRef};
///
/// let name = "laser".give();
/// assert!(matches!(name, ParamRef::Text("laser")));
/// assert_eq!((name.what(), name.to_string()), ("a string", "\"laser\"".to_owned()));
/// ```
#[derive(Clone, Copy)]
pub enum ParamRef<'a> {
    /// A truth value.
    Bool(bool),
    /// An integer.
    Integer(i128),
    /// A number of double precision.
    Float(f64),
    /// A number of single precision. Equal to a [`ParamRef::Float`] except for its spelling.
    Single(f32),
    /// A string.
    Text(&'a str),
    /// A list.
    List(&'a dyn GivenList),
    /// A value that no parameter takes, with its kind: `a table`.
    Other(&'static str),
}

/// The elements of a list.
///
/// ```
/// use apex_rt::params::{GivenList, IntoParam, ParamRef};
///
/// let weights = vec![0.5, 1.5];
/// let ParamRef::List(list) = weights.give() else { panic!("it is a list") };
/// assert_eq!((list.count(), list.element(1).to_string().as_str()), (2, "1.5"));
/// ```
pub trait GivenList {
    /// Number of elements.
    fn count(&self) -> usize;
    /// Returns element number `index`, which is below [`GivenList::count`].
    fn element(&self, index: usize) -> ParamRef<'_>;
}

/// A value that can be assigned to a parameter.
///
/// ```
/// use apex_rt::params::IntoParam;
/// use std::time::Duration;
///
/// // In TOML, and in SI units.
/// assert_eq!([1u8, 2].give().to_string(), "[1, 2]");
/// assert_eq!(Duration::from_millis(20).give().to_string(), "0.02");
/// ```
pub trait IntoParam {
    /// Returns the value, independent of its type.
    fn give(&self) -> ParamRef<'_>;
}

/// A type of parameters that can be read, set, saved and loaded. Implement it for your own types by those of their
/// contents.
///
/// ```
/// use apex_rt::params::{IntoParam, ParamRef, ParamValue, Rejection};
///
/// /// Number of a gear.
/// #[derive(Debug, PartialEq)]
/// struct Gear(u8);
///
/// impl IntoParam for Gear {
///     fn give(&self) -> ParamRef<'_> {
///         self.0.give()
///     }
/// }
///
/// impl ParamValue for Gear {
///     fn take(given: ParamRef<'_>) -> Result<Self, Rejection> {
///         u8::take(given).map(Self)
///     }
/// }
///
/// assert_eq!(Gear::take(3i64.give()), Ok(Gear(3)));
/// assert_eq!(Gear::take(300i64.give()), Err(Rejection::Fit("u8")));
/// ```
pub trait ParamValue: IntoParam + Sized {
    /// Converts a given value to this type.
    ///
    /// # Errors
    /// The value is of another kind, or does not fit into this type.
    fn take(given: ParamRef<'_>) -> Result<Self, Rejection>;
}

impl ParamRef<'_> {
    /// Returns the kind of the value, for messages: `a string`.
    pub const fn what(&self) -> &'static str {
        match self {
            Self::Bool(_) => "`true` or `false`",
            Self::Integer(_) => "an integer",
            Self::Float(_) | Self::Single(_) => "a number with a decimal point",
            Self::Text(_) => "a string",
            Self::List(_) => "a list",
            Self::Other(what) => what,
        }
    }

    /// Returns the refusal of this value where another kind was expected.
    pub const fn refuse(&self, expected: &'static str) -> Rejection {
        Rejection::Kind { expected, found: self.what() }
    }
}

impl fmt::Debug for ParamRef<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl fmt::Display for ParamRef<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Bool(value) => write!(f, "{value}"),
            Self::Integer(value) => write!(f, "{value}"),
            Self::Float(value) if value.is_nan() => f.write_str("nan"),
            Self::Single(value) if value.is_nan() => f.write_str("nan"),
            Self::Float(value) => write!(f, "{value:?}"),
            Self::Single(value) => write!(f, "{value:?}"),
            Self::Text(text) => quoted(text, f),
            Self::List(list) => {
                f.write_str("[")?;
                for index in 0..list.count() {
                    write!(f, "{}{}", if index > 0 { ", " } else { "" }, list.element(index))?;
                }
                f.write_str("]")
            }
            Self::Other(what) => f.write_str(what),
        }
    }
}

/// Writes a string in TOML.
fn quoted(text: &str, f: &mut fmt::Formatter<'_>) -> fmt::Result {
    use fmt::Write as _;
    f.write_char('"')?;
    for c in text.chars() {
        match c {
            '"' | '\\' => write!(f, "\\{c}")?,
            '\n' => f.write_str("\\n")?,
            '\t' => f.write_str("\\t")?,
            c if c.is_control() => write!(f, "\\u{:04X}", u32::from(c))?,
            c => f.write_char(c)?,
        }
    }
    f.write_char('"')
}

impl<T: IntoParam + ?Sized> IntoParam for &T {
    fn give(&self) -> ParamRef<'_> {
        (**self).give()
    }
}

impl IntoParam for ParamRef<'_> {
    fn give(&self) -> ParamRef<'_> {
        *self
    }
}

impl IntoParam for bool {
    fn give(&self) -> ParamRef<'_> {
        ParamRef::Bool(*self)
    }
}

impl ParamValue for bool {
    fn take(given: ParamRef<'_>) -> Result<Self, Rejection> {
        match given {
            ParamRef::Bool(value) => Ok(value),
            other => Err(other.refuse("`true` or `false`")),
        }
    }
}

macro_rules! integers {
    ($($ty:ident)*) => { $(
        impl IntoParam for $ty {
            fn give(&self) -> ParamRef<'_> {
                // An `i128` has room for all of these types.
                ParamRef::Integer(*self as i128)
            }
        }

        impl ParamValue for $ty {
            fn take(given: ParamRef<'_>) -> Result<Self, Rejection> {
                match given {
                    ParamRef::Integer(value) => Self::try_from(value).map_err(|_| Rejection::Fit(stringify!($ty))),
                    other => Err(other.refuse("an integer")),
                }
            }
        }
    )* };
}

integers!(i8 i16 i32 i64 isize u8 u16 u32 u64 usize);

impl IntoParam for f64 {
    fn give(&self) -> ParamRef<'_> {
        ParamRef::Float(*self)
    }
}

impl ParamValue for f64 {
    fn take(given: ParamRef<'_>) -> Result<Self, Rejection> {
        match given {
            ParamRef::Integer(value) => Ok(value as Self),
            ParamRef::Float(value) => Ok(value),
            ParamRef::Single(value) => Ok(Self::from(value)),
            other => Err(other.refuse("a number")),
        }
    }
}

impl IntoParam for f32 {
    fn give(&self) -> ParamRef<'_> {
        ParamRef::Single(*self)
    }
}

impl ParamValue for f32 {
    fn take(given: ParamRef<'_>) -> Result<Self, Rejection> {
        if let ParamRef::Single(value) = given {
            return Ok(value);
        }
        let exact = f64::take(given)?;
        let value = exact as Self;
        if value.is_infinite() && exact.is_finite() { Err(Rejection::Fit("f32")) } else { Ok(value) }
    }
}

impl IntoParam for Duration {
    /// Returns the time in seconds.
    fn give(&self) -> ParamRef<'_> {
        ParamRef::Float(self.as_secs_f64())
    }
}

impl ParamValue for Duration {
    fn take(given: ParamRef<'_>) -> Result<Self, Rejection> {
        let seconds = f64::take(given).map_err(|_| given.refuse("a number of seconds"))?;
        Self::try_from_secs_f64(seconds).map_err(|_| Rejection::Fit("Duration"))
    }
}

impl IntoParam for str {
    fn give(&self) -> ParamRef<'_> {
        ParamRef::Text(self)
    }
}

impl<const N: usize> IntoParam for heapless::String<N> {
    fn give(&self) -> ParamRef<'_> {
        ParamRef::Text(self)
    }
}

impl<const N: usize> ParamValue for heapless::String<N> {
    fn take(given: ParamRef<'_>) -> Result<Self, Rejection> {
        match given {
            ParamRef::Text(text) => Self::try_from(text).map_err(|_| Rejection::Long { most: N }),
            other => Err(other.refuse("a string")),
        }
    }
}

macro_rules! lists {
    ($($(#[$cfg:meta])? [$($generics:tt)*] $ty:ty;)*) => { $(
        $(#[$cfg])?
        impl<T: IntoParam, $($generics)*> GivenList for $ty {
            fn count(&self) -> usize {
                self.len()
            }
            fn element(&self, index: usize) -> ParamRef<'_> {
                self.get(index).map_or(ParamRef::Other("nothing"), T::give)
            }
        }

        $(#[$cfg])?
        impl<T: IntoParam, $($generics)*> IntoParam for $ty {
            fn give(&self) -> ParamRef<'_> {
                ParamRef::List(self)
            }
        }
    )* };
}

lists! {
    [const N: usize] [T; N];
    [const N: usize] heapless::Vec<T, N>;
    #[cfg(feature = "alloc")]
    [] alloc::vec::Vec<T>;
}

/// Returns the elements of a list.
fn elements<T: ParamValue>(
    given: ParamRef<'_>,
) -> Result<impl ExactSizeIterator<Item = Result<T, Rejection>>, Rejection> {
    match given {
        ParamRef::List(list) => Ok((0..list.count()).map(|index| T::take(list.element(index)))),
        other => Err(other.refuse("a list")),
    }
}

impl<T: ParamValue, const N: usize> ParamValue for heapless::Vec<T, N> {
    fn take(given: ParamRef<'_>) -> Result<Self, Rejection> {
        let mut list = Self::new();
        for element in elements(given)? {
            list.push(element?).map_err(|_| Rejection::Long { most: N })?;
        }
        Ok(list)
    }
}

impl<T: ParamValue, const N: usize> ParamValue for [T; N] {
    fn take(given: ParamRef<'_>) -> Result<Self, Rejection> {
        let found = elements::<T>(given)?.len();
        let list = if found == N { heapless::Vec::<T, N>::take(given)?.into_array().ok() } else { None };
        list.ok_or(Rejection::Length { expected: N, found })
    }
}

#[cfg(feature = "alloc")]
impl<T: ParamValue> ParamValue for alloc::vec::Vec<T> {
    fn take(given: ParamRef<'_>) -> Result<Self, Rejection> {
        elements(given)?.collect()
    }
}

#[cfg(feature = "alloc")]
impl IntoParam for alloc::string::String {
    fn give(&self) -> ParamRef<'_> {
        ParamRef::Text(self)
    }
}

#[cfg(feature = "alloc")]
impl ParamValue for alloc::string::String {
    fn take(given: ParamRef<'_>) -> Result<Self, Rejection> {
        match given {
            ParamRef::Text(text) => Ok(text.into()),
            other => Err(other.refuse("a string")),
        }
    }
}
