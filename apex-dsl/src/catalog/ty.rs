use serde::{Deserialize, Serialize};
use std::fmt;

/// A Rust type as written, before its names are looked up.
#[derive(Debug, Clone, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Ty {
    /// `a::B<C>`
    Path(Vec<String>, Vec<Ty>),
    /// `[T; N]`, `[T]`
    Array(Box<Ty>, Option<String>),
    /// `(A, B)`
    Tuple(Vec<Ty>),
    /// `&T`
    Ref(Box<Ty>),
    /// A number with a unit: `f32[m]` in a source file, `#[unit("m")]` in Rust.
    Measured(Box<Ty>, String),
    /// Anything else, as tokens.
    Other(String),
}

impl Ty {
    /// `()`
    pub fn unit() -> Self {
        Self::Tuple(vec![])
    }

    /// Reads a type from Rust syntax.
    pub fn from_syn(ty: &syn::Type) -> Self {
        use quote::ToTokens as _;
        match ty {
            syn::Type::Path(path) if path.qself.is_none() && !has_lifetime(path) => {
                let plain = |name: String| name.strip_prefix("r#").map(str::to_owned).unwrap_or(name);
                let segments = path.path.segments.iter().map(|s| plain(s.ident.to_string())).collect();
                let args = match path.path.segments.last().map(|s| &s.arguments) {
                    Some(syn::PathArguments::AngleBracketed(args)) => {
                        args.args.iter().filter_map(Self::from_argument).collect()
                    }
                    _ => vec![],
                };
                Self::Path(segments, args)
            }
            syn::Type::Array(array) => {
                Self::Array(Box::new(Self::from_syn(&array.elem)), Some(array.len.to_token_stream().to_string()))
            }
            syn::Type::Slice(slice) => Self::Array(Box::new(Self::from_syn(&slice.elem)), None),
            syn::Type::Tuple(tuple) => Self::Tuple(tuple.elems.iter().map(Self::from_syn).collect()),
            syn::Type::Reference(reference) => Self::Ref(Box::new(Self::from_syn(&reference.elem))),
            syn::Type::Paren(inner) => Self::from_syn(&inner.elem),
            syn::Type::Group(inner) => Self::from_syn(&inner.elem),
            other => Self::Other(other.to_token_stream().to_string()),
        }
    }

    /// The type with a unit, if there is one.
    pub fn measured(self, unit: Option<String>) -> Self {
        match unit {
            Some(unit) => Self::Measured(Box::new(self), unit),
            None => self,
        }
    }

    fn from_argument(argument: &syn::GenericArgument) -> Option<Self> {
        use quote::ToTokens as _;
        match argument {
            syn::GenericArgument::Type(ty) => Some(Self::from_syn(ty)),
            syn::GenericArgument::Const(value) => Some(Self::Other(value.to_token_stream().to_string())),
            _ => None,
        }
    }

    /// The last segment of a path: `f32`, `Duration`.
    pub fn name(&self) -> Option<&str> {
        match self {
            Self::Path(path, _) => path.last().map(String::as_str),
            _ => None,
        }
    }

    /// Returns `true` for the type parameter `name`.
    pub fn is_parameter(&self, name: &str) -> bool {
        matches!(self, Self::Path(path, args) if args.is_empty() && path.len() == 1 && path[0] == name)
    }

    /// Returns `true` if `name` occurs in the type.
    pub fn mentions(&self, name: &str) -> bool {
        match self {
            Self::Path(_, args) => self.is_parameter(name) || args.iter().any(|a| a.mentions(name)),
            Self::Array(inner, len) => inner.mentions(name) || len.as_deref() == Some(name),
            Self::Tuple(parts) => parts.iter().any(|p| p.mentions(name)),
            Self::Ref(inner) | Self::Measured(inner, _) => inner.mentions(name),
            Self::Other(text) => text == name,
        }
    }
}

/// Returns `true` for `Cow<'static, T>`, whose lifetime belongs to it and is not checked here.
fn has_lifetime(path: &syn::TypePath) -> bool {
    let is_lifetime = |argument: &syn::GenericArgument| matches!(argument, syn::GenericArgument::Lifetime(_));
    path.path.segments.iter().any(|segment| match &segment.arguments {
        syn::PathArguments::AngleBracketed(arguments) => arguments.args.iter().any(is_lifetime),
        _ => false,
    })
}

impl fmt::Display for Ty {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let list = |f: &mut fmt::Formatter<'_>, types: &[Self]| {
            types.iter().enumerate().try_for_each(|(i, t)| write!(f, "{}{t}", if i > 0 { ", " } else { "" }))
        };
        match self {
            Self::Path(path, args) if args.is_empty() => f.write_str(&path.join("::")),
            Self::Path(path, args) => {
                write!(f, "{}<", path.join("::"))?;
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
            Self::Measured(inner, unit) => write!(f, "{inner}[{unit}]"),
            Self::Other(text) => f.write_str(text),
        }
    }
}
