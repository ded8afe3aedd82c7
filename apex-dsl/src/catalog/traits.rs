//! Traits of the standard library that types certainly have. Only rustc can decide about all others.

use super::{Catalog, Type, items::ItemKind};

/// A trait that generated code requires of tokens and nodes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Trait {
    /// Tokens that are stored are cloned.
    Clone,
    /// State has an initial value.
    Default,
    /// Tokens and nodes of other thread groups are moved to their threads.
    Send,
}

impl Catalog {
    /// Returns `true` if a type of the scanned crates derives the trait with this name.
    pub fn derives(&self, ty: &Type, name: &str) -> bool {
        let Type::Def(def, ..) = ty else { return false };
        matches!(&self.tree.defs[*def].kind, ItemKind::Type(item) if item.derives.iter().any(|derived| derived == name))
    }

    /// Returns `true` if a type certainly has a trait, `false` if not, or if the scan cannot decide.
    pub fn has_trait(&self, ty: &Type, wanted: Trait) -> bool {
        let all = |types: &[Type]| types.iter().all(|ty| self.has_trait(ty, wanted));
        match ty {
            Type::Primitive(name) => name != "str",
            Type::Named(name, args) => match name.rsplit("::").next().unwrap_or(name) {
                "String" | "Duration" => true,
                "Vec" | "Option" if name.len() < 7 => wanted == Trait::Default || all(args),
                "Box" => all(args),
                "PhantomData" => wanted != Trait::Send || all(args),
                _ => false,
            },
            Type::Def(def, _, args) => {
                let ItemKind::Type(item) = &self.tree.defs[*def].kind else { return false };
                let derived = match wanted {
                    Trait::Clone => "Clone",
                    Trait::Default => "Default",
                    Trait::Send => return false,
                };
                item.derives.iter().any(|name| name == derived) && all(args)
            }
            Type::Alias(_, _, target) | Type::Measured(target, _) => self.has_trait(target, wanted),
            Type::Array(item, Some(_)) => wanted != Trait::Default && self.has_trait(item, wanted),
            Type::Tuple(parts) => all(parts),
            Type::Array(_, None) | Type::Ref(_) | Type::Param(_) | Type::Unknown(_) => false,
        }
    }
}
