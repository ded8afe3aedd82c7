//! Types as they are written, and their meaning.

use super::{
    catalog::Catalog,
    items::ItemKind,
    library::{self, DURATION, PRIMITIVES, STD, TIME},
    tree::{DefId, ModuleId},
    ty::Ty,
    types::Type,
};

/// Largest number of aliases that are followed.
const MAX_ALIASES: usize = 16;

/// Looks up a path: definitions that it names, or the full path of an item that is not scanned.
type Resolve<'a> = dyn Fn(&[String]) -> (Vec<DefId>, Option<String>) + 'a;

impl Catalog {
    /// Looks up the names of a type that was written in a scanned module.
    pub fn type_of(&self, ty: &Ty, module: ModuleId, generics: &[String]) -> Type {
        self.lookup(ty, generics, 0, &|path| (self.tree.resolve(module, path), self.tree.external(module, path)))
    }

    /// Looks up the names of a type that was written in a source file.
    pub fn type_in_text(&self, ty: &Ty, generics: &[String]) -> Type {
        // In Rust, `Time` may be any type.
        let runtime = |path: &[String]| matches!(path, [name] if name == TIME).then(|| Type::RUNTIME_TIME.to_owned());
        self.lookup(ty, generics, 0, &|path| (self.types(path), runtime(path)))
    }

    fn lookup(&self, ty: &Ty, generics: &[String], aliases: usize, resolve: &Resolve<'_>) -> Type {
        let inner = |t: &Ty| self.lookup(t, generics, aliases, resolve);
        match ty {
            Ty::Array(element, len) => Type::Array(Box::new(inner(element)), len.clone()),
            Ty::Tuple(parts) => Type::Tuple(parts.iter().map(inner).collect()),
            Ty::Ref(target) => Type::Ref(Box::new(inner(target))),
            Ty::Measured(number, unit) => Type::Measured(Box::new(inner(number)), unit.clone()),
            Ty::Other(text) => Type::Unknown(text.clone()),
            Ty::Path(path, args) => {
                let name = path.last().map_or("", String::as_str);
                if path.len() == 1 && args.is_empty() && generics.iter().any(|g| g == name) {
                    return Type::Param(name.to_owned());
                }
                let args: Vec<Type> = args.iter().map(inner).collect();
                let (defs, external) = resolve(path);
                let def = defs
                    .into_iter()
                    .find(|d| matches!(self.tree.defs[*d].kind, ItemKind::Type(_) | ItemKind::Alias(_)));
                if let Some(def) = def {
                    return match self.tree.alias(def) {
                        None => Type::Def(def, name.to_owned(), args),
                        Some(Some(target)) if aliases < MAX_ALIASES => {
                            let module = self.tree.defs[def].module;
                            let target = self.lookup(target, &[], aliases + 1, &|path| {
                                (self.tree.resolve(module, path), self.tree.external(module, path))
                            });
                            // Generated code can name the alias, also where it cannot name its target.
                            let is_kept = target.is_open() || !self.can_name(&target);
                            if is_kept { Type::Alias(def, name.to_owned(), Box::new(target)) } else { target }
                        }
                        Some(_) => Type::Unknown(ty.to_string()),
                    };
                }
                let full = external.as_ref().map(|path| path.split("::").map(str::to_owned).collect::<Vec<_>>());
                if let Some(short) = library::short(full.as_deref().unwrap_or(path)) {
                    return Type::Named(short.to_owned(), args);
                }
                if let Some(external) = external {
                    return Type::Named(external, args);
                }
                if path.len() == 1 && PRIMITIVES.contains(&name) {
                    return Type::Primitive(name.to_owned());
                }
                if path.len() == 1 && name == DURATION && args.is_empty() {
                    return Type::Named("core::time::Duration".to_owned(), args);
                }
                if path.len() > 1 || STD.contains(&name) {
                    return Type::Named(path.join("::"), args);
                }
                Type::Unknown(ty.to_string())
            }
        }
    }
}
