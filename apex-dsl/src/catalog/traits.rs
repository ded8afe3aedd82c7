//! Traits of the standard library that types certainly have. Only rustc can decide about all others.

use super::{catalog::Catalog, items::ItemKind, types::Type};

/// A trait that generated code requires of tokens and nodes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Trait {
    /// Tokens that are stored are cloned.
    Clone,
    /// State has an initial value.
    Default,
    /// Tokens and nodes of other thread groups are moved to their threads.
    Send,
    /// Bounds of nodes ask for it.
    Copy,
}

impl Trait {
    /// The trait with this name.
    pub fn named(name: &str) -> Option<Self> {
        [Self::Clone, Self::Default, Self::Send, Self::Copy].into_iter().find(|of| of.name() == name)
    }

    const fn name(self) -> &'static str {
        match self {
            Self::Clone => "Clone",
            Self::Default => "Default",
            Self::Send => "Send",
            Self::Copy => "Copy",
        }
    }
}

impl Catalog {
    /// Returns `true` if a type of the scanned crates derives or implements the trait with this name, at least with
    /// some type arguments.
    pub fn implements(&self, ty: &Type, name: &str) -> bool {
        let Type::Def(def, ..) = ty else { return false };
        matches!(&self.tree.defs[*def].kind, ItemKind::Type(item) if item.traits.iter().any(|of| of.name == name))
    }

    /// Returns `true` if a type certainly has a trait, `false` if not, or if the scan cannot decide.
    pub fn has_trait(&self, ty: &Type, wanted: Trait) -> bool {
        let all = |types: &[Type]| types.iter().all(|ty| self.has_trait(ty, wanted));
        match ty {
            Type::Primitive(name) => name != "str",
            Type::Named(name, args) => match name.rsplit("::").next().unwrap_or(name) {
                "Duration" => true,
                "String" => wanted != Trait::Copy,
                "Vec" if name.len() < 7 => wanted == Trait::Default || wanted != Trait::Copy && all(args),
                "Option" if name.len() < 7 => wanted == Trait::Default || all(args),
                "Box" => wanted != Trait::Copy && all(args),
                "PhantomData" => wanted != Trait::Send || all(args),
                _ => false,
            },
            Type::Def(def, _, args) => {
                let ItemKind::Type(item) = &self.tree.defs[*def].kind else { return false };
                // Nobody writes an `impl` of it: whether it holds depends on all that is inside.
                if wanted == Trait::Send {
                    return false;
                }
                item.traits.iter().any(|of| of.name == wanted.name() && (!of.of_arguments || all(args)))
            }
            Type::Alias(_, _, target) | Type::Measured(target, _) => self.has_trait(target, wanted),
            Type::Array(item, Some(_)) => wanted != Trait::Default && self.has_trait(item, wanted),
            Type::Tuple(parts) => all(parts),
            Type::Array(_, None) | Type::Ref(_) | Type::Param(_) | Type::Unknown(_) => false,
        }
    }
}
