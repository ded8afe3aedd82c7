use super::{
    library,
    tree::{DefId, Need},
};
use crate::units;
use std::fmt;

/// A type whose names have been looked up as far as the scan can see.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Type {
    /// `u64`, `bool`, `str` …
    Primitive(String),
    /// A type of a crate that is not scanned, by its full path, or one of the standard library that needs no
    /// import: `Vec`, `Option`, `String`, `Box`.
    Named(String, Vec<Type>),
    /// A definition that was seen.
    Def(DefId, String, Vec<Type>),
    /// A `type` alias whose target the scan knows only in part, or whose target generated code cannot name.
    Alias(DefId, String, Box<Type>),
    /// `[T; N]`, `[T]`
    Array(Box<Type>, Option<String>),
    /// `(A, B)`
    Tuple(Vec<Type>),
    /// `&T`
    Ref(Box<Type>),
    /// A number in a unit: the type of tokens only, never a part of another type.
    Measured(Box<Type>, String),
    /// A type parameter of the signature around it.
    Param(String),
    /// Any other type, as it was written.
    Unknown(String),
}

/// Result of the comparison of two types.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Match {
    /// The types are the same.
    Same,
    /// The types are certainly different.
    Different,
    /// Only rustc can decide.
    Unknown,
}

const LISTS: [&str; 2] = ["Vec", "heapless::Vec"];
/// Parts of `std` that `core` has under the same name.
const CORE: [&str; 8] = ["time", "ops", "num", "cmp", "marker", "option", "result", "primitive"];
/// Returns `true` if an item of `std` is also in `core`.
fn is_in_core(path: &str) -> bool {
    path.split("::").nth(1).is_some_and(|module| CORE.contains(&module)) && !path.ends_with("Instant")
}

impl Type {
    /// The path of [`TIME`].
    pub(super) const RUNTIME_TIME: &str = "apex_rt::Time";

    /// Returns `true` for points in time.
    pub fn is_time(&self) -> bool {
        matches!(self, Self::Named(name, _) if name == Self::RUNTIME_TIME)
    }

    /// `()`
    pub fn unit() -> Self {
        Self::Tuple(vec![])
    }

    /// Returns `true` for `()`.
    pub fn is_unit(&self) -> bool {
        *self == Self::unit()
    }

    /// Name without a path and arguments: `f64`, `Duration`. Empty for arrays, tuples and references.
    pub fn name(&self) -> &str {
        match self {
            Self::Primitive(name) | Self::Def(_, name, _) | Self::Alias(_, name, _) | Self::Param(name) => name,
            Self::Named(text, _) | Self::Unknown(text) => text.rsplit("::").next().unwrap_or(text),
            Self::Measured(number, _) => number.name(),
            _ => "",
        }
    }

    /// The type in Rust, which knows no units.
    pub fn without_unit(&self) -> &Self {
        match self {
            Self::Measured(number, _) => number,
            other => other,
        }
    }

    /// The unit of the tokens, if it is declared and known.
    pub fn measured_in(&self) -> Option<units::Unit> {
        match self {
            Self::Measured(_, unit) => units::parse(unit).ok(),
            _ => None,
        }
    }

    /// Returns `true` for a number, and for a type that may be one.
    pub fn may_be_a_number(&self) -> bool {
        match self {
            Self::Primitive(name) => !["bool", "char", "str"].contains(&name.as_str()),
            _ => self.may_be_another(),
        }
    }

    /// Returns `true` for a whole number.
    pub fn is_integer(&self) -> bool {
        matches!(self.without_unit(), Self::Primitive(name) if name.starts_with(['i', 'u']))
    }

    /// Number of bits of the integers in which those of this type are computed with.
    pub fn wide_bits(&self) -> u32 {
        match self.name() {
            "u8" | "u16" | "u32" | "i8" | "i16" | "i32" => 64,
            _ => 128,
        }
    }

    /// Part of the Rust libraries that the type needs, and the type in it that is the reason.
    pub fn needs(&self) -> Option<(Need, String)> {
        let of_all = |types: &[Self]| types.iter().filter_map(Self::needs).max_by_key(|(need, _)| *need);
        match self {
            Self::Named(name, args) => {
                let own = match name.as_str() {
                    "Vec" | "String" | "Box" => Some(Need::Heap),
                    name if name.starts_with("alloc::") => Some(Need::Heap),
                    name if name.starts_with("std::") && !is_in_core(name) => Some(Need::Std),
                    _ => None,
                };
                own.map(|need| (need, self.to_string())).or_else(|| of_all(args))
            }
            Self::Def(_, _, args) | Self::Tuple(args) => of_all(args),
            Self::Alias(_, _, inner) | Self::Array(inner, _) | Self::Ref(inner) | Self::Measured(inner, _) => {
                inner.needs()
            }
            Self::Primitive(_) | Self::Param(_) | Self::Unknown(_) => None,
        }
    }

    /// Compares two types as far as the scan knows them.
    pub fn compare(&self, other: &Self) -> Match {
        use Type::{Alias, Array, Def, Measured, Named, Param, Primitive, Ref, Tuple, Unknown};
        match (self, other) {
            (Measured(a, x), Measured(b, y)) if x == y || self.measured_in() == other.measured_in() => a.compare(b),
            (Measured(..), Measured(..)) => Match::Different,
            // A port without a unit fits all.
            (Measured(number, _), other) | (other, Measured(number, _)) => number.compare(other),
            (Alias(a, ..), Alias(b, ..)) if a == b => Match::Same,
            (Alias(.., target), other) | (other, Alias(.., target)) => target.compare(other),
            (Unknown(_) | Param(_), _) | (_, Unknown(_) | Param(_)) => Match::Unknown,
            (Primitive(a), Primitive(b)) => Match::of(a == b),
            (Named(a, x), Named(b, y)) => named(a, x, b, y),
            (Def(a, _, x), Def(b, _, y)) if a == b => all(x, y),
            (Tuple(x), Tuple(y)) => all(x, y),
            (Ref(a), Ref(b)) => a.compare(b),
            (Array(a, n), Array(b, m)) => match (n, m) {
                (None, None) => a.compare(b),
                (Some(n), Some(m)) if n == m => a.compare(b),
                (Some(n), Some(m)) if n.parse::<u64>().is_ok() && m.parse::<u64>().is_ok() => Match::Different,
                (None, _) | (_, None) => Match::Different,
                _ => Match::Unknown,
            },
            // A path into a crate that is not scanned may be an alias of the other type.
            (Named(name, _), _) | (_, Named(name, _)) if library::name_of_listed(name).is_none() => Match::Unknown,
            _ => Match::Different,
        }
    }

    /// The type with its type parameters replaced by the types that `lookup` returns for them.
    pub fn substitute(&self, lookup: &impl Fn(&str) -> Option<Type>) -> Self {
        let each = |types: &[Self]| types.iter().map(|t| t.substitute(lookup)).collect();
        match self {
            Self::Param(name) => lookup(name).unwrap_or_else(|| self.clone()),
            Self::Named(name, args) => Self::Named(name.clone(), each(args)),
            Self::Def(def, name, args) => Self::Def(*def, name.clone(), each(args)),
            Self::Array(inner, len) => {
                let len = len.as_ref().map(|n| lookup(n).map_or_else(|| n.clone(), |t| t.to_string()));
                Self::Array(Box::new(inner.substitute(lookup)), len)
            }
            Self::Tuple(parts) => Self::Tuple(each(parts)),
            Self::Ref(inner) => Self::Ref(Box::new(inner.substitute(lookup))),
            Self::Measured(inner, unit) => Self::Measured(Box::new(inner.substitute(lookup)), unit.clone()),
            Self::Primitive(_) | Self::Alias(..) | Self::Unknown(_) => self.clone(),
        }
    }

    /// The type with its type parameters renamed.
    pub fn rename(self, names: &[(String, String)]) -> Self {
        self.substitute(&|name| names.iter().find(|(from, _)| from == name).map(|(_, to)| Self::Param(to.clone())))
    }

    /// The type that the type parameter `name` must have for `self` to match `concrete`. It has no unit, because the
    /// node may compute anything from it.
    pub fn bind(&self, name: &str, concrete: &Self) -> Option<Type> {
        let concrete = concrete.without_unit();
        let pairs = |a: &[Self], b: &[Self]| a.iter().zip(b).find_map(|(a, b)| a.bind(name, b));
        match (self, concrete) {
            (Self::Param(param), _) if param == name => Some(concrete.clone()),
            (Self::Named(a, x), Self::Named(b, y)) if a == b => pairs(x, y),
            (Self::Def(a, _, x), Self::Def(b, _, y)) if a == b => pairs(x, y),
            (Self::Tuple(x), Self::Tuple(y)) => pairs(x, y),
            (Self::Array(a, _), Self::Array(b, _)) | (Self::Ref(a), Self::Ref(b)) => a.bind(name, b),
            (Self::Measured(number, _), concrete) => number.bind(name, concrete),
            (Self::Alias(.., target), concrete) => target.bind(name, concrete),
            (declared, Self::Alias(.., target)) => declared.bind(name, target),
            _ => None,
        }
    }

    /// Returns `true` if the type may be an alias of any other type, so that only rustc knows its values.
    pub fn may_be_another(&self) -> bool {
        match self {
            Self::Unknown(_) | Self::Param(_) => true,
            Self::Alias(.., target) => target.is_open() || target.may_be_another(),
            Self::Named(name, _) => !library::is_standard(name),
            Self::Measured(number, _) => number.may_be_another(),
            _ => false,
        }
    }

    /// Returns `true` if a part of the type is unknown, or is an open type parameter.
    pub fn is_open(&self) -> bool {
        match self {
            Self::Unknown(_) | Self::Param(_) => true,
            Self::Named(_, args) | Self::Def(_, _, args) | Self::Tuple(args) => args.iter().any(Self::is_open),
            Self::Array(inner, len) => inner.is_open() || len.as_ref().is_some_and(|n| n.parse::<u64>().is_err()),
            Self::Ref(inner) | Self::Measured(inner, _) => inner.is_open(),
            Self::Primitive(_) | Self::Alias(..) => false,
        }
    }

    /// Returns `true` if the type parameter `name` occurs in the type, or may occur in an unknown part of it.
    pub fn may_mention(&self, name: &str) -> bool {
        let any = |types: &[Self]| types.iter().any(|ty| ty.may_mention(name));
        match self {
            Self::Param(param) => param == name,
            Self::Unknown(text) => !text.is_empty(),
            Self::Named(_, args) | Self::Def(_, _, args) | Self::Tuple(args) => any(args),
            Self::Array(inner, len) => inner.may_mention(name) || len.as_deref() == Some(name),
            Self::Alias(_, _, inner) | Self::Ref(inner) | Self::Measured(inner, _) => inner.may_mention(name),
            Self::Primitive(_) => false,
        }
    }

    /// The element type of a list; `None` if the type is not known to be a list that `each` supports.
    pub fn list_item(&self) -> Option<Type> {
        match self {
            Self::Alias(.., target) => target.list_item(),
            Self::Named(name, args) if LISTS.contains(&name.as_str()) => args.first().cloned(),
            _ => None,
        }
    }
}

impl Match {
    fn of(same: bool) -> Self {
        if same { Self::Same } else { Self::Different }
    }
}

/// Compares two named types. Paths into crates that are not scanned may be aliases of each other, so only lists and the
/// types that are listed are known to be different.
fn named(a: &str, x: &[Type], b: &str, y: &[Type]) -> Match {
    let known = |name| LISTS.into_iter().find(|list| *list == name).or_else(|| library::name_of_listed(name));
    let args = all(x, y);
    match (known(a), known(b)) {
        (Some(a), Some(b)) if a != b => Match::Different,
        (Some(_), Some(_)) => args,
        _ if a == b && args == Match::Same => args,
        _ => Match::Unknown,
    }
}

fn all(a: &[Type], b: &[Type]) -> Match {
    if a.len() != b.len() {
        return Match::Unknown;
    }
    a.iter().zip(b).map(|(a, b)| a.compare(b)).fold(Match::Same, |sum, one| match (sum, one) {
        (Match::Different, _) | (_, Match::Different) => Match::Different,
        (Match::Unknown, _) | (_, Match::Unknown) => Match::Unknown,
        _ => Match::Same,
    })
}

impl fmt::Display for Type {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let list = |f: &mut fmt::Formatter<'_>, types: &[Self]| {
            types.iter().enumerate().try_for_each(|(i, t)| write!(f, "{}{t}", if i > 0 { ", " } else { "" }))
        };
        match self {
            Self::Primitive(name) | Self::Alias(_, name, _) | Self::Param(name) | Self::Unknown(name) => {
                f.write_str(name)
            }
            Self::Named(name, args) | Self::Def(_, name, args) => {
                f.write_str(name)?;
                if args.is_empty() {
                    return Ok(());
                }
                f.write_str("<")?;
                list(f, args)?;
                f.write_str(">")
            }
            Self::Array(inner, Some(len)) => write!(f, "[{inner}; {len}]"),
            Self::Array(inner, None) => write!(f, "[{inner}]"),
            Self::Tuple(parts) => {
                f.write_str("(")?;
                list(f, parts)?;
                f.write_str(")")
            }
            Self::Ref(inner) => write!(f, "&{inner}"),
            Self::Measured(number, unit) => write!(f, "{number}[{unit}]"),
        }
    }
}
