//! Constants of Rust that a source file names by their path.

use super::{
    catalog::Catalog,
    items::ItemKind,
    library::{self, DURATION, PRIMITIVES, RUNTIME},
    tree::{Def, DefId},
    types::Type,
};

/// Constants of `core::f32::consts` and `core::f64::consts`.
#[rustfmt::skip]
const OF_FLOATS: [&str; 19] = [
    "E", "FRAC_1_PI", "FRAC_1_SQRT_2", "FRAC_2_PI", "FRAC_2_SQRT_PI", "FRAC_PI_2", "FRAC_PI_3", "FRAC_PI_4", "FRAC_PI_6",
    "FRAC_PI_8", "LN_10", "LN_2", "LOG10_2", "LOG10_E", "LOG2_10", "LOG2_E", "PI", "SQRT_2", "TAU",
];

const OF_DURATION: [&str; 2] = ["MAX", "ZERO"];

/// Result of looking up the path of a constant.
#[derive(Debug, Clone, PartialEq)]
pub enum Constant {
    /// A constant, as generated code spells it, and its type.
    Known(Vec<String>, Type),
    /// A constant that generated code cannot name, and its place.
    Hidden(String),
    /// Only rustc can decide, for example about a crate that is not scanned. Contains the path as generated code spells
    /// it.
    Unknown(Vec<String>),
    /// Not found. Contains the names that exist there.
    Missing(Vec<String>),
}

/// An associated constant of a primitive type: `f64::MAX`.
pub fn of_primitive(of: &str, name: &str) -> Constant {
    let known: &[&str] = match of {
        "f32" | "f64" => &["EPSILON", "INFINITY", "MAX", "MIN", "MIN_POSITIVE", "NAN", "NEG_INFINITY"],
        "bool" | "str" => &[],
        "char" => &["MAX"],
        _ => &["MAX", "MIN"],
    };
    if !known.contains(&name) {
        return Constant::Missing(known.iter().map(|name| (*name).to_owned()).collect());
    }
    let path = ["", "core", "primitive", of, name].map(str::to_owned);
    Constant::Known(path.into(), Type::Primitive(of.to_owned()))
}

/// Returns `true` if `self`, `Self`, `super` and `crate` occur only at the beginning of a path.
pub fn is_path(path: &[String]) -> bool {
    !path.iter().skip(1).any(|word| ["self", "Self", "super", "crate"].contains(&word.as_str()))
}

/// An unknown path of a source file as generated code spells it.
fn spelled(path: &[String]) -> Vec<String> {
    let relative = path.first().is_some_and(|first| first == "crate");
    (!relative).then(String::new).into_iter().chain(path.iter().cloned()).collect()
}

/// Looks up the constant that a path names in a crate of which only the names in `library.rs` are known.
fn of_listed(path: &[String]) -> Constant {
    let words: Vec<&str> = path.iter().map(String::as_str).collect();
    let known = |names: &[&str]| Constant::Missing(names.iter().map(|name| (*name).to_owned()).collect());
    let spelled = || [String::new()].into_iter().chain(path.iter().cloned()).collect();
    match words.as_slice() {
        [krate, of @ ("f32" | "f64"), "consts", name] if *krate != RUNTIME => match OF_FLOATS.contains(name) {
            true => Constant::Known(spelled(), Type::Primitive((*of).to_owned())),
            false => known(&OF_FLOATS),
        },
        [krate, "time", DURATION, name] if *krate != RUNTIME => match OF_DURATION.contains(name) {
            true => Constant::Known(spelled(), Type::Named("core::time::Duration".to_owned(), vec![])),
            false => known(&OF_DURATION),
        },
        [krate, of, name] | [krate, "primitive", of, name] if *krate != RUNTIME && PRIMITIVES.contains(of) => {
            of_primitive(of, name)
        }
        _ => Constant::Missing(vec![]),
    }
}

impl Catalog {
    /// Looks up a constant.
    pub fn constant(&self, path: &[String]) -> Constant {
        let unknown = || Constant::Unknown(spelled(path));
        let Some((last, parent)) = path.split_last().filter(|_| is_path(path)) else {
            return Constant::Missing(vec![]);
        };
        if library::is_listed(path) {
            return of_listed(path);
        }
        if let [of] = parent
            && PRIMITIVES.contains(&of.as_str())
        {
            return of_primitive(of, last);
        }
        let mut found = self.defs(path).into_iter().filter_map(|def| Some((def, self.type_of_constant(def)?)));
        if let Some((def, ty)) = found.next() {
            return self.spelled(def, None, ty);
        }
        let types = if parent.is_empty() { vec![] } else { self.types(parent) };
        for &def in &types {
            if let Some(ty) = self.type_of_associated(def, last) {
                return self.spelled(def, Some(last), ty);
            }
        }
        if !types.is_empty() {
            let known: Vec<String> = types.iter().flat_map(|def| self.associated_names(*def)).collect();
            // A trait or a macro may add constants to the type that the scan does not see.
            return if known.is_empty() { unknown() } else { Constant::Missing(known) };
        }
        if !self.defs(parent).is_empty() {
            return Constant::Missing(vec![]);
        }
        match path.first() {
            Some(first) if self.is_crate(first) && !self.may_hide(parent) => {
                Constant::Missing(self.names_in(parent).into_iter().map(str::to_owned).collect())
            }
            Some(first) if self.knows_crate(first) => unknown(),
            _ => Constant::Missing(vec![]),
        }
    }

    fn spelled(&self, def: DefId, name: Option<&String>, ty: Type) -> Constant {
        match self.path(def) {
            Some(path) => Constant::Known(path.iter().chain(name).cloned().collect(), ty),
            None => {
                let (file, line) = self.place(def);
                Constant::Hidden(format!("{}:{line}", file.display()))
            }
        }
    }

    /// Type of a constant, or of a struct without fields.
    fn type_of_constant(&self, def: DefId) -> Option<Type> {
        let Def { module, kind, name, .. } = &self.tree.defs[def];
        match kind {
            ItemKind::Constant(ty) => Some(self.type_of(ty, *module, &[])),
            ItemKind::Type(ty) if ty.values.iter().any(String::is_empty) => Some(Type::Def(def, name.clone(), vec![])),
            _ => None,
        }
    }

    /// Type of a variant, or of a constant in an `impl`.
    fn type_of_associated(&self, def: DefId, name: &str) -> Option<Type> {
        let Def { module, kind, name: of, .. } = &self.tree.defs[def];
        let this = || Type::Def(def, of.clone(), vec![]);
        if let ItemKind::Type(ty) = kind
            && ty.values.iter().any(|value| value == name)
        {
            return Some(if ty.arguments.1 == 0 { this() } else { Type::Unknown(of.clone()) });
        }
        let mut constants = self.constants_of(def).filter(|(constant, _)| constant == name);
        let (_, ty) = constants.next()?;
        Some(if ty.is_parameter("Self") { this() } else { self.type_of(ty, *module, &[]) })
    }

    fn associated_names(&self, def: DefId) -> Vec<String> {
        let variants = match &self.tree.defs[def].kind {
            ItemKind::Type(ty) => ty.values.clone(),
            _ => vec![],
        };
        variants.into_iter().chain(self.constants_of(def).map(|(name, _)| name.clone())).collect()
    }

    /// Constants in the `impl` blocks of a type in its own module.
    fn constants_of(&self, def: DefId) -> impl Iterator<Item = &(String, super::Ty)> {
        let Def { module, name, .. } = &self.tree.defs[def];
        let all = self.tree.named("").iter().map(|def| &self.tree.defs[*def]);
        all.filter(move |other| other.module == *module).flat_map(move |other| match &other.kind {
            ItemKind::Constants(of, constants) if of == name => constants.as_slice(),
            _ => &[],
        })
    }
}
