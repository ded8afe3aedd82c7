//! Traits of the standard library that types certainly have. Of all others only rustc knows.

use super::{Catalog, Type, items::ItemKind};

/// A trait that generated code asks of tokens and of nodes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Trait {
    /// Tokens are copied where they are kept.
    Clone,
    /// State has a value to start with.
    Default,
    /// Tokens and nodes of another thread group are moved to its thread.
    Send,
}

impl Catalog {
    /// Whether a type certainly has a trait; `false` also where the scan cannot tell.
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
            Type::Alias(_, _, target) => self.has_trait(target, wanted),
            Type::Array(item, Some(_)) => wanted != Trait::Default && self.has_trait(item, wanted),
            Type::Tuple(parts) => all(parts),
            Type::Array(_, None) | Type::Ref(_) | Type::Param(_) | Type::Unknown(_) => false,
        }
    }
}
