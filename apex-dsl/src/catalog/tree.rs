//! The module tree of the scanned crates, and the lookup of paths in it.

use super::{
    cfg::{Conditions, Truth},
    crates::{CrateSpec, RustFiles},
    items::{Item, ItemKind, Seen},
    library,
    ty::Ty,
};
use crate::index::{IdVec, id};
use std::{
    collections::{BTreeMap, BTreeSet},
    path::{Path, PathBuf},
};

id! {
    /// Number of a module in [`Tree::modules`].
    ModuleId
}

id! {
    /// Number of a definition in [`Tree::defs`].
    DefId
}

/// Largest number of imports that are followed for one name.
const MAX_IMPORTS: usize = 32;
/// Largest depth of nested modules.
const MAX_MODULES: usize = 64;
/// Largest number of files that are read.
const MAX_FILES: usize = 20_000;

/// A module.
#[derive(Debug)]
pub struct Module {
    /// Number of its crate.
    pub krate: usize,
    /// Feature without which the module does not exist.
    need: Option<Need>,
    parent: Option<ModuleId>,
    /// File of the module.
    file: PathBuf,
    /// First and last line of an inline module.
    lines: Option<(usize, usize)>,
    /// `true` if a macro call in the module may make items that the scan does not see.
    is_open: bool,
    names: BTreeMap<String, Vec<Entry>>,
    globs: Vec<(Vec<String>, Option<ModuleId>)>,
}

#[derive(Debug)]
struct Entry {
    /// The outermost module in which the name is visible; `None` if it is visible everywhere.
    within: Option<ModuleId>,
    target: Target,
}

#[derive(Debug)]
enum Target {
    Module(ModuleId),
    Def(DefId),
    Import(Vec<String>),
}

/// Parts of the Rust libraries that a crate does without.
#[derive(Debug, Clone, Copy, Default)]
pub struct Without {
    /// `true` if the crate can be built without the standard library.
    pub can_lack_std: bool,
    /// `#![no_implicit_prelude]`
    pub lacks_prelude: bool,
    /// `true` if the crate is always built without the standard library.
    pub lacks_std: bool,
    /// `true` if the crate uses `alloc`.
    pub has_heap: bool,
}

/// Part of the Rust libraries that an item needs, or the feature for it without which the item does not exist.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Need {
    /// A heap.
    Heap,
    /// The standard library.
    Std,
}

/// A definition that the scan found, such as a type, a constant or a node.
#[derive(Debug)]
pub struct Def {
    /// Feature without which the definition does not exist, by its conditions and those of the modules around it.
    pub need: Option<Need>,
    /// Name of the definition.
    pub name: String,
    /// Module of the definition.
    pub module: ModuleId,
    /// The file.
    pub file: PathBuf,
    /// The line, from 1.
    pub line: usize,
    /// Kind of the item.
    pub kind: ItemKind,
}

/// All modules of all scanned crates.
#[derive(Debug, Default)]
pub struct Tree {
    /// The modules.
    pub modules: IdVec<ModuleId, Module>,
    /// The root module of each crate.
    pub roots: Vec<ModuleId>,
    /// Definitions.
    pub defs: IdVec<DefId, Def>,
    /// Parts of the Rust libraries that each crate does without.
    pub does_without: Vec<Without>,
    /// Items whose condition does not hold: the crate, the name, and the condition.
    pub left_out: Vec<(usize, String, String)>,
    /// Files in which a macro hides nodes.
    pub hidden: Vec<PathBuf>,
    /// Calls of `graph!`: the module, the folder of its file, and the name of the source file, which is empty if the
    /// graph is in the call.
    pub calls: Vec<(ModuleId, PathBuf, String)>,
    by_name: BTreeMap<String, Vec<DefId>>,
    files: usize,
    /// Files that cannot be parsed: the file, the line of the error, and the error.
    pub broken: Vec<(PathBuf, usize, String)>,
    names: Vec<String>,
    dependencies: Vec<BTreeMap<String, usize>>,
}

/// A search for the definitions that a path names.
struct Walk<'a> {
    tree: &'a Tree,
    /// Modules that have been searched, each with the rest of the path. Modules that import everything from each other
    /// are reached in many ways.
    seen: BTreeMap<ModuleId, Vec<Vec<String>>>,
    found: BTreeSet<DefId>,
}

impl Walk<'_> {
    /// Follows `path` as Rust code in `module` means it.
    fn path(&mut self, module: ModuleId, path: &[String], imports: usize) {
        let [first, rest @ ..] = path else { return };
        if imports > MAX_IMPORTS {
            return;
        }
        let tree = self.tree;
        let krate = tree.modules[module].krate;
        match first.as_str() {
            "crate" => return self.enter(tree.roots[krate], rest, imports),
            "self" => return self.enter(module, rest, imports),
            "super" => {
                let up = tree.modules[module].parent.unwrap_or(module);
                let more = rest.first().is_some_and(|s| s == "super");
                return if more { self.path(up, rest, imports) } else { self.enter(up, rest, imports) };
            }
            _ => {}
        }
        if self.has_seen(module, path) {
            return;
        }
        let before = self.found.len();
        self.enter(module, path, imports);
        if self.found.len() == before
            && !rest.is_empty()
            && let Some(&other) = tree.dependencies[krate].get(first)
        {
            self.enter(tree.roots[other], rest, imports);
        }
    }

    /// Returns `true` if the path was followed in this module before.
    fn has_seen(&self, module: ModuleId, path: &[String]) -> bool {
        self.seen.get(&module).is_some_and(|seen| seen.iter().any(|seen| seen == path))
    }

    /// Follows `path` from the names in `module`.
    fn enter(&mut self, module: ModuleId, path: &[String], imports: usize) {
        let [first, rest @ ..] = path else { return };
        if self.has_seen(module, path) {
            return;
        }
        self.seen.entry(module).or_default().push(path.to_vec());
        let tree = self.tree;
        for entry in tree.modules[module].names.get(first).into_iter().flatten() {
            match &entry.target {
                Target::Module(child) => self.enter(*child, rest, imports),
                Target::Def(def) if rest.is_empty() => {
                    self.found.insert(*def);
                }
                Target::Def(_) => {}
                Target::Import(target) => {
                    // `use a::a;` must not lead back to itself.
                    let full: Vec<String> = target.iter().chain(rest).cloned().collect();
                    if full != path {
                        self.path(module, &full, imports + 1);
                    } else if let Some(&other) = tree.dependencies[tree.modules[module].krate].get(first) {
                        self.enter(tree.roots[other], rest, imports + 1);
                    }
                }
            }
        }
        // Names of the module itself hide names from glob imports.
        if !rest.is_empty() && tree.modules[module].names.contains_key(first) {
            return;
        }
        for (glob, _) in &tree.modules[module].globs {
            if imports < MAX_IMPORTS && glob.first().is_some_and(|g| g != first) {
                let full: Vec<String> = glob.iter().chain(path).cloned().collect();
                // A glob counts as several imports, because it is followed for every name.
                self.path(module, &full, imports + 8);
            }
        }
    }
}

impl Tree {
    /// Scans `crates`. `own` are the crates of the package; rustc has printed `conditions` for them.
    pub fn scan(crates: &[CrateSpec], own: &[usize], conditions: &Conditions, world: &mut dyn RustFiles) -> Self {
        let mut tree = Self::default();
        for (index, spec) in crates.iter().enumerate() {
            tree.names.push(spec.name.clone());
            tree.dependencies.push(spec.dependencies.clone());
            tree.does_without.push(Without::default());
            let root = tree.module(index, None, None, &spec.root, None);
            tree.roots.push(root);
            let folder = spec.root.parent().unwrap_or(Path::new("")).to_owned();
            let is_own = own.contains(&index);
            let mut scan = Scan { tree: &mut tree, spec, is_own, conditions, world, open: vec![] };
            scan.file(root, &spec.root, &folder);
        }
        for (id, def) in tree.defs.iter_enumerated() {
            tree.by_name.entry(def.name.clone()).or_default().push(id);
        }
        tree
    }

    fn module(
        &mut self,
        krate: usize,
        parent: Option<ModuleId>,
        need: Option<Need>,
        file: &Path,
        lines: Option<(usize, usize)>,
    ) -> ModuleId {
        let (file, names, globs) = (file.to_owned(), BTreeMap::new(), vec![]);
        self.modules.push(Module { krate, need, parent, file, lines, is_open: false, names, globs })
    }

    /// All definitions with this name.
    pub fn named(&self, name: &str) -> &[DefId] {
        self.by_name.get(name).map_or(&[], Vec::as_slice)
    }

    /// The innermost module of crate `krate` that contains a line of a file.
    pub fn module_at(&self, krate: usize, file: &Path, line: usize) -> Option<ModuleId> {
        let holds = |m: &Module| m.lines.is_none_or(|(first, last)| (first..=last).contains(&line));
        let modules = self.modules.iter_enumerated();
        modules.filter(|(_, m)| m.krate == krate && m.file == file && holds(m)).map(|(id, _)| id).next_back()
    }

    /// Returns `true` if `module` is `outer` or is inside it.
    fn is_inside(&self, module: ModuleId, outer: ModuleId) -> bool {
        std::iter::successors(Some(module), |m| self.modules[*m].parent).any(|m| m == outer)
    }

    /// The outermost module in which an item of `module` with this visibility can be named; `None` if it is visible
    /// everywhere.
    fn within(&self, module: ModuleId, seen: &Seen) -> Option<ModuleId> {
        match seen {
            Seen::Everywhere => None,
            Seen::InCrate => Some(self.roots.get(self.modules[module].krate).copied().unwrap_or(module)),
            Seen::Within(path) => Some(self.find_module(module, path).unwrap_or(module)),
            Seen::InModule => Some(module),
        }
    }

    /// Returns `true` if an item that can be named only inside the module `within` can be named at `site`.
    fn is_seen(&self, within: Option<ModuleId>, site: Option<ModuleId>) -> bool {
        match (within, site) {
            (None, _) => true,
            (Some(within), Some(site)) => self.is_inside(site, within),
            (Some(_), None) => false,
        }
    }

    /// Returns `true` if code at `site` can use a field of a struct in `module`.
    pub fn sees_field(&self, module: ModuleId, seen: &Seen, site: Option<ModuleId>) -> bool {
        self.is_seen(self.within(module, seen), site)
    }

    /// Returns `true` if the module at `path` may have items that the scan does not see: from a macro, or from a glob
    /// import.
    pub fn may_hide(&self, from: ModuleId, path: &[String]) -> bool {
        match self.find_module(from, path) {
            Some(module) => {
                // Glob imports from these crates are preludes, without types and constants that source files need.
                let mut globs = self.modules[module].globs.iter();
                self.modules[module].is_open || globs.any(|(path, _)| !library::is_listed(path))
            }
            // The module does not exist, unless it is hidden itself, in a module further out.
            None => path.split_last().is_none_or(|(_, parent)| self.may_hide(from, parent)),
        }
    }

    /// Definitions that `path` names in `module`.
    pub fn resolve(&self, module: ModuleId, path: &[String]) -> Vec<DefId> {
        let mut walk = Walk { tree: self, seen: BTreeMap::new(), found: BTreeSet::new() };
        walk.path(module, path, 0);
        walk.found.into_iter().collect()
    }

    /// Definitions that `module` itself contains or imports under this name, without those of glob imports.
    pub fn named_in(&self, module: ModuleId, name: &str) -> Vec<DefId> {
        let entries = self.modules[module].names.get(name).into_iter().flatten();
        let defs = entries.flat_map(|entry| match &entry.target {
            Target::Def(def) => vec![*def],
            Target::Import(path) => self.resolve(module, path),
            Target::Module(_) => vec![],
        });
        defs.collect()
    }

    /// Full path of a name that `module` imports from a crate that is not scanned.
    pub fn external(&self, module: ModuleId, path: &[String]) -> Option<String> {
        let [first, rest @ ..] = path else { return None };
        self.modules[module].names.get(first)?.iter().find_map(|entry| match &entry.target {
            Target::Import(target) if !["crate", "self", "super"].contains(&target[0].as_str()) => {
                Some(target.iter().chain(rest).cloned().collect::<Vec<_>>().join("::"))
            }
            _ => None,
        })
    }

    /// For each definition the shortest path that generated code can use in the module `site`, or outside of all
    /// scanned crates.
    pub fn paths(&self, site: Option<ModuleId>) -> BTreeMap<DefId, Vec<String>> {
        let here = site.map(|site| self.modules[site].krate);
        let mut paths = BTreeMap::new();
        for (krate, &root) in self.roots.iter().enumerate() {
            let start = match here == Some(krate) {
                true => vec!["crate".to_owned()],
                false => vec![String::new(), self.names[krate].clone()],
            };
            let mut queue = std::collections::VecDeque::from([(root, start)]);
            let mut seen = BTreeSet::new();
            while let Some((module, path)) = queue.pop_front() {
                if !seen.insert(module) || path.len() > MAX_MODULES {
                    continue;
                }
                self.list(module, site, &path, &mut paths, &mut queue);
            }
        }
        paths
    }

    /// Adds the paths of all definitions in a module that are visible at `site`, and queues the modules in it.
    fn list(
        &self,
        module: ModuleId,
        site: Option<ModuleId>,
        path: &[String],
        paths: &mut BTreeMap<DefId, Vec<String>>,
        queue: &mut std::collections::VecDeque<(ModuleId, Vec<String>)>,
    ) {
        let is_seen = |within: Option<ModuleId>| self.is_seen(within, site);
        for (name, entries) in &self.modules[module].names {
            for entry in entries.iter().filter(|e| is_seen(e.within)) {
                let here: Vec<String> = path.iter().cloned().chain([name.clone()]).collect();
                match &entry.target {
                    Target::Module(child) => queue.push_back((*child, here)),
                    Target::Def(def) => {
                        paths.entry(*def).or_insert(here);
                    }
                    Target::Import(target) => {
                        for def in self.resolve(module, target) {
                            paths.entry(def).or_insert_with(|| here.clone());
                        }
                        // `pub use` of a module.
                        if let Some(child) = self.find_module(module, target) {
                            queue.push_back((child, here));
                        }
                    }
                }
            }
        }
        for (glob, _) in self.modules[module].globs.iter().filter(|(_, within)| is_seen(*within)) {
            if let Some(child) = self.find_module(module, glob) {
                queue.push_back((child, path.to_vec()));
            }
        }
    }

    fn find_module(&self, from: ModuleId, path: &[String]) -> Option<ModuleId> {
        let mut module = from;
        for (i, segment) in path.iter().enumerate() {
            module = match segment.as_str() {
                "crate" => self.roots[self.modules[module].krate],
                "self" => module,
                "super" => self.modules[module].parent?,
                name => {
                    let child =
                        self.modules[module].names.get(name).into_iter().flatten().find_map(|e| match e.target {
                            Target::Module(child) => Some(child),
                            _ => None,
                        });
                    match child {
                        Some(child) => child,
                        None if i == 0 => self.roots[*self.dependencies[self.modules[module].krate].get(name)?],
                        None => return None,
                    }
                }
            };
        }
        Some(module)
    }

    /// Names that can follow `path` in an import, for suggestions.
    pub fn names_in(&self, from: ModuleId, path: &[String]) -> Vec<&str> {
        let module = if path.is_empty() { Some(from) } else { self.find_module(from, path) };
        module.map(|m| self.modules[m].names.keys().map(String::as_str).collect()).unwrap_or_default()
    }

    /// Target of a type alias; `None` for other definitions, `Some(None)` for a generic alias.
    pub fn alias(&self, def: DefId) -> Option<&Option<Ty>> {
        match &self.defs[def].kind {
            ItemKind::Alias(target) => Some(target),
            _ => None,
        }
    }
}

/// The scan of one crate.
struct Scan<'a> {
    tree: &'a mut Tree,
    spec: &'a CrateSpec,
    is_own: bool,
    conditions: &'a Conditions,
    world: &'a mut dyn RustFiles,
    /// Files that are being read, outermost first. A file that includes itself is not read again.
    open: Vec<PathBuf>,
}

impl Scan<'_> {
    /// Adds the items of a file. `folder` contains the files of its child modules.
    fn file(&mut self, module: ModuleId, file: &Path, folder: &Path) {
        if self.open.len() > MAX_MODULES || self.tree.files >= MAX_FILES || self.open.iter().any(|f| f == file) {
            return;
        }
        self.tree.files += 1;
        // rustc reports files that cannot be read.
        if let Ok(items) = self.world.items(file) {
            self.open.push(file.to_owned());
            self.items(module, &items, file, folder, 0);
            self.open.pop();
        }
    }

    fn items(&mut self, module: ModuleId, items: &[Item], file: &Path, folder: &Path, depth: usize) {
        for item in items {
            let krate = self.tree.modules[module].krate;
            if let Some(cfg) = item.cfg.iter().find(|cfg| self.is_left_out(cfg)) {
                self.tree.left_out.push((krate, item.name.clone(), cfg.split_whitespace().collect()));
                continue;
            }
            let Some(target) = self.target(module, item, file, folder, depth) else { continue };
            let within = self.tree.within(module, &item.seen);
            let names = &mut self.tree.modules[module].names;
            names.entry(item.name.clone()).or_default().push(Entry { within, target });
        }
    }

    fn is_left_out(&self, cfg: &str) -> bool {
        self.conditions.evaluate(cfg, &self.spec.features, self.is_own) == Truth::No
    }

    /// Adds an item that is not left out. Returns the target of its name, if it has a name.
    fn target(&mut self, module: ModuleId, item: &Item, file: &Path, folder: &Path, depth: usize) -> Option<Target> {
        let krate = self.tree.modules[module].krate;
        let need = self.tree.modules[module].need.max(self.need(item));
        match &item.kind {
            ItemKind::Module(content, last) => {
                let child = self.tree.module(krate, Some(module), need, file, Some((item.line, *last)));
                if depth < MAX_MODULES {
                    self.items(child, content, file, &folder.join(&item.name), depth + 1);
                }
                return Some(Target::Module(child));
            }
            ItemKind::ModuleFile(path) => {
                let (path, folder) = self.module_file(path.as_deref(), &item.name, file, folder);
                let child = self.tree.module(krate, Some(module), need, &path, None);
                self.file(child, &path, &folder);
                return Some(Target::Module(child));
            }
            ItemKind::Import(path) => return Some(Target::Import(path.clone())),
            ItemKind::Glob(path) => {
                let within = self.tree.within(module, &item.seen);
                self.tree.modules[module].globs.push((path.clone(), within));
            }
            ItemKind::NoPrelude => self.tree.does_without[krate].lacks_prelude = true,
            ItemKind::NoStd { always } => {
                let without = &mut self.tree.does_without[krate];
                (without.can_lack_std, without.lacks_std) = (true, *always);
            }
            ItemKind::Extern => {
                self.tree.does_without[krate].has_heap |= matches!(item.name.as_str(), "alloc" | "std");
            }
            ItemKind::Macro(hides_nodes) => {
                self.tree.modules[module].is_open = true;
                if *hides_nodes {
                    self.tree.hidden.push(file.to_owned());
                }
            }
            ItemKind::Call(text) => {
                let folder = file.parent().unwrap_or(Path::new("")).to_owned();
                self.tree.calls.push((module, folder, text.clone()));
            }
            ItemKind::Broken(reason) => self.tree.broken.push((file.to_owned(), item.line, reason.clone())),
            kind => {
                let (name, file) = (item.name.clone(), file.to_owned());
                let def = Def { need, name, module, file, line: item.line, kind: kind.clone() };
                return Some(Target::Def(self.tree.defs.push(def)));
            }
        }
        None
    }

    /// File of a module, and folder of the modules inside.
    fn module_file(&mut self, path: Option<&str>, name: &str, file: &Path, folder: &Path) -> (PathBuf, PathBuf) {
        if let Some(path) = path {
            let path = file.parent().unwrap_or(Path::new("")).join(path);
            let folder = path.parent().unwrap_or(Path::new("")).to_owned();
            return (path, folder);
        }
        let inner = folder.join(name);
        let flat = inner.with_extension("rs");
        let path = if self.world.exists(&flat) { flat } else { inner.join("mod.rs") };
        (path, inner)
    }

    /// Feature without which an item does not exist: `std`, or one of `std` and `alloc`.
    fn need(&self, item: &Item) -> Option<Need> {
        let exists_without = |left_out: &[&str]| {
            let features = self.spec.features.iter().filter(|f| !left_out.contains(&f.as_str())).cloned().collect();
            item.cfg.iter().all(|cfg| self.conditions.evaluate(cfg, &features, self.is_own) != Truth::No)
        };
        match () {
            () if item.cfg.is_empty() || exists_without(&["std", "alloc"]) => None,
            () if exists_without(&["std"]) => Some(Need::Heap),
            () => Some(Need::Std),
        }
    }
}
