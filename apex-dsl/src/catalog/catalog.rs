//! The catalog: what a graph can refer to.

use super::{
    crates::{Crates, RustFiles, Site},
    items::ItemKind,
    signature::{Signature, SignatureId},
    tree::{Def, DefId, ModuleId, Need, Tree},
    types::Type,
};
use crate::index::IdVec;
use std::{
    collections::{BTreeMap, BTreeSet},
    path::{Path, PathBuf},
};

/// All node signatures and types that a graph can refer to.
#[derive(Debug, Default)]
pub struct Catalog {
    /// The node types.
    pub signatures: IdVec<SignatureId, Signature>,
    pub(super) tree: Tree,
    pub(super) crates: Crates,
    pub(super) by_def: BTreeMap<DefId, SignatureId>,
    /// Current module of the generated code; `None` is outside of all scanned crates.
    pub(super) site: Option<ModuleId>,
    pub(super) paths: BTreeMap<DefId, Vec<String>>,
}

impl Catalog {
    /// Scans `crates`.
    pub fn load(crates: Crates, world: &mut dyn RustFiles) -> Self {
        let tree = Tree::scan(&crates.all, &crates.own, &crates.conditions, world);
        let site = site(&tree, &crates);
        let paths = tree.paths(site);
        let mut catalog = Self { tree, crates, site, paths, ..Self::default() };
        catalog.collect();
        catalog
    }

    /// Node types that are declared in Rust.
    pub fn rust_nodes(&self) -> impl Iterator<Item = (SignatureId, &Signature)> {
        self.signatures.iter_enumerated().take(self.by_def.len())
    }

    /// Removes the state machines of source files that were checked before.
    pub fn forget_machines(&mut self) {
        self.signatures.truncate(self.by_def.len());
    }

    /// Makes room for `count` state machines and returns their numbers.
    pub fn reserve_machines(&mut self, count: usize) -> Vec<SignatureId> {
        (0..count).map(|_| self.signatures.push(Signature::default())).collect()
    }

    /// Stores the signature of a state machine, whose number is reserved.
    pub fn add_machine(&mut self, id: SignatureId, signature: Signature) {
        self.signatures[id] = signature;
    }

    /// Smallest part of the Rust libraries that the crate of the program does without. `None` if it uses the standard
    /// library.
    pub fn lacks(&self) -> Option<Need> {
        let here = self.tree.does_without.get(self.crates.here)?;
        match (here.lacks_std, here.has_heap) {
            (false, _) => None,
            (true, true) => Some(Need::Std),
            (true, false) => Some(Need::Heap),
        }
    }

    /// Describes the condition under which one of these names would exist, if an item with this name was left out.
    pub fn left_out(&self, names: &[&str]) -> Option<String> {
        let (krate, name, cfg) = self.tree.left_out.iter().find(|(_, name, _)| names.contains(&name.as_str()))?;
        Some(format!("`{name}` of `{}` exists only with `{cfg}`", self.crates.all[*krate].name))
    }

    /// Node types that `path` names in a source file.
    pub fn nodes(&self, path: &[String]) -> Vec<SignatureId> {
        self.defs(path).iter().filter_map(|def| self.by_def.get(def).copied()).collect()
    }

    /// Types that `path` names in a source file.
    pub fn types(&self, path: &[String]) -> Vec<DefId> {
        self.defs(path)
            .into_iter()
            .filter(|d| matches!(self.tree.defs[*d].kind, ItemKind::Type(_) | ItemKind::Alias(_)))
            .collect()
    }

    pub(super) fn defs(&self, path: &[String]) -> Vec<DefId> {
        let found = self.crates.own.iter().map(|own| self.defs_in(*own, path)).find(|found| !found.is_empty());
        found.unwrap_or_default()
    }

    /// Definitions that `path` names in one of the package's own crates. A name without a path may be in any module.
    fn defs_in(&self, krate: usize, path: &[String]) -> Vec<DefId> {
        let found = self.tree.resolve(self.tree.roots[krate], path);
        match path {
            [name] if found.is_empty() => {
                let is_meant = |d: &&DefId| self.tree.modules[self.tree.defs[**d].module].krate == krate;
                self.tree.named(name).iter().filter(is_meant).copied().collect()
            }
            _ => found,
        }
    }

    /// Returns `true` if `name` is a scanned crate that a source file can import from.
    pub fn is_crate(&self, name: &str) -> bool {
        name == "crate" || self.crates.own.iter().any(|own| self.crates.all[*own].dependencies.contains_key(name))
    }

    /// Returns `true` if `name` is a crate that is not scanned: its types can be named, but nothing else is known.
    pub fn is_extern(&self, name: &str) -> bool {
        ["std", "core", "alloc"].contains(&name)
            || self.crates.own.iter().any(|own| self.crates.all[*own].externs.contains(name))
    }

    /// Returns `true` if generated code can name a crate: one of the standard library, or on which the package depends.
    pub fn knows_crate(&self, name: &str) -> bool {
        self.is_crate(name) || self.is_extern(name)
    }

    /// Returns `true` if generated code can name all crates of a type.
    pub fn can_name(&self, ty: &Type) -> bool {
        self.foreign_crate(ty).is_none()
    }

    /// A crate of a type that the package does not depend on: only a library that it uses does.
    pub fn foreign_crate<'t>(&self, ty: &'t Type) -> Option<&'t str> {
        let of_all = |types: &'t [Type]| types.iter().find_map(|ty| self.foreign_crate(ty));
        match ty {
            Type::Named(name, args) => {
                let krate = name.split_once("::").map(|(krate, _)| krate);
                krate.filter(|name| *name != "apex_rt" && !self.knows_crate(name)).or_else(|| of_all(args))
            }
            Type::Def(_, _, args) | Type::Tuple(args) => of_all(args),
            Type::Array(inner, _) | Type::Ref(inner) | Type::Measured(inner, _) => self.foreign_crate(inner),
            Type::Primitive(_) | Type::Alias(..) | Type::Param(_) | Type::Unknown(_) => None,
        }
    }

    /// Returns `true` if the crate of the program has no preludes, and so no attributes of tools.
    pub fn lacks_prelude(&self) -> bool {
        self.tree.does_without.get(self.crates.here).is_some_and(|without| without.lacks_prelude)
    }

    /// All definitions with this name.
    pub fn find(&self, name: &str) -> Vec<DefId> {
        self.tree.named(name).to_vec()
    }

    /// For an item with this name that is marked `#[node]` but is not a node: the reason, the file and the line.
    pub fn refused(&self, name: &str) -> Option<(&str, &Path, usize)> {
        self.tree.named(name).iter().find_map(|def| match &self.tree.defs[*def] {
            Def { kind: ItemKind::Refused(reason), file, line, .. } => {
                Some((reason.as_str(), file.strip_prefix(&self.crates.root).unwrap_or(file), *line))
            }
            _ => None,
        })
    }

    /// Returns `true` if `path` names an item that is marked `#[node]` but is not a node.
    pub fn is_refused(&self, path: &[String]) -> bool {
        self.defs(path).iter().any(|def| matches!(self.tree.defs[*def].kind, ItemKind::Refused(_)))
    }

    /// Names that may follow `path`, for suggestions.
    pub fn names_in(&self, path: &[String]) -> Vec<&str> {
        self.crates.own.iter().flat_map(|own| self.tree.names_in(self.tree.roots[*own], path)).collect()
    }

    /// Files in which a macro makes nodes that the scan cannot see.
    pub fn hidden(&self) -> &[PathBuf] {
        &self.tree.hidden
    }

    /// Errors of the Rust files that cannot be read, each as a sentence.
    pub fn broken(&self) -> impl Iterator<Item = String> {
        self.tree.broken.iter().map(|(file, line, reason)| {
            let file = file.strip_prefix(&self.crates.root).unwrap_or(file).display();
            format!("the nodes in {file} are unknown: line {line} cannot be read ({reason})")
        })
    }

    /// Returns `true` if a definition is a type.
    pub fn is_type(&self, def: DefId) -> bool {
        matches!(self.tree.defs[def].kind, ItemKind::Type(_) | ItemKind::Alias(_))
    }

    /// Smallest and largest number of type arguments of a type; `None` for a generic alias, whose parameters are not
    /// known.
    pub fn arguments(&self, def: DefId) -> Option<(usize, usize)> {
        match &self.tree.defs[def].kind {
            ItemKind::Type(ty) => Some(ty.arguments),
            ItemKind::Alias(Some(_)) => Some((0, 0)),
            _ => None,
        }
    }

    /// Returns `true` if an argument of a type may be a number.
    pub fn takes_number(&self, def: DefId, argument: usize) -> bool {
        match &self.tree.defs[def].kind {
            ItemKind::Type(ty) => ty.numbers.contains(&argument),
            // The parameters of a generic alias are not known.
            _ => true,
        }
    }

    /// Names of the types in the package's own crates.
    pub fn own_types(&self) -> impl Iterator<Item = &str> {
        let is_own = |def: &&Def| self.crates.own.contains(&self.tree.modules[def.module].krate);
        let is_type = |def: &&Def| matches!(def.kind, ItemKind::Type(_) | ItemKind::Alias(_));
        self.tree.defs.iter().filter(is_own).filter(is_type).map(|def| def.name.as_str())
    }

    /// Returns `true` if the module `parent` may have items that the scan does not see, for example from a macro.
    pub fn may_hide(&self, parent: &[String]) -> bool {
        self.crates.own.iter().any(|own| self.tree.may_hide(self.tree.roots[*own], parent))
    }

    /// The name of a definition.
    pub fn name(&self, def: DefId) -> &str {
        &self.tree.defs[def].name
    }

    /// Place of a definition: file, and line from 1.
    pub fn place(&self, def: DefId) -> (PathBuf, usize) {
        let def = &self.tree.defs[def];
        (def.file.strip_prefix(&self.crates.root).unwrap_or(&def.file).to_owned(), def.line)
    }

    /// Scanned crates that a source file can import from.
    pub fn crate_names(&self) -> BTreeSet<&str> {
        let dependencies = self.crates.own.iter().flat_map(|own| self.crates.all[*own].dependencies.keys());
        dependencies.map(String::as_str).collect()
    }

    /// Path by which generated code reaches a definition.
    pub fn path(&self, def: DefId) -> Option<&[String]> {
        self.paths.get(&def).map(Vec::as_slice)
    }
}

/// Module of the site, if it is known without a source file.
fn site(tree: &Tree, crates: &Crates) -> Option<ModuleId> {
    match &crates.site {
        Site::Crate => tree.roots.get(crates.here).copied(),
        Site::Text => None,
    }
}
