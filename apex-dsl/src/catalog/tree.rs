//! The module tree of the scanned crates, and what a path means in it.

use super::{
    CrateSpec,
    items::{Item, ItemKind},
    ty::Ty,
};
use crate::source::World;
use std::{
    collections::{BTreeMap, BTreeSet},
    path::{Path, PathBuf},
};

/// A module, by number.
pub type ModuleId = usize;
/// A definition, by number.
pub type DefId = usize;

/// How many imports are followed for one name.
const MAX_IMPORTS: usize = 32;
/// How deep module files nest.
const MAX_MODULES: usize = 64;

/// A module.
#[derive(Debug)]
pub struct Module {
    /// The crate, by number.
    pub krate: usize,
    /// What it exists only with.
    need: Option<Need>,
    parent: Option<ModuleId>,
    names: BTreeMap<String, Vec<Entry>>,
    globs: Vec<(Vec<String>, bool)>,
}

#[derive(Debug)]
struct Entry {
    public: bool,
    target: Target,
}

#[derive(Debug)]
enum Target {
    Module(ModuleId),
    Def(DefId),
    Import(Vec<String>),
}

/// What a crate does without.
#[derive(Debug, Clone, Copy, Default)]
pub struct Without {
    /// It can be built without the standard library.
    pub can_lack_std: bool,
    /// It is never built with it.
    pub lacks_std: bool,
    /// It uses `alloc`.
    pub has_heap: bool,
}

/// What something cannot do without.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Need {
    /// A heap.
    Heap,
    /// The standard library.
    Std,
}

/// A type or node that was seen.
#[derive(Debug)]
pub struct Def {
    /// What it exists only with, by the conditions on it and on the modules around it.
    pub need: Option<Need>,
    /// Its name.
    pub name: String,
    /// Where it is defined.
    pub module: ModuleId,
    /// The file.
    pub file: PathBuf,
    /// The line, from 1.
    pub line: usize,
    /// What it is.
    pub kind: ItemKind,
}

/// All modules of all scanned crates.
#[derive(Debug, Default)]
pub struct Tree {
    /// The modules.
    pub modules: Vec<Module>,
    /// The root module of each crate.
    pub roots: Vec<ModuleId>,
    /// What was found.
    pub defs: Vec<Def>,
    /// For each crate what it can do without.
    pub does_without: Vec<Without>,
    /// Items that the enabled features leave out: the crate, the name, and the condition.
    pub left_out: Vec<(usize, String, String)>,
    /// Files in which a macro hides nodes.
    pub hidden: Vec<PathBuf>,
    /// Files that are no Rust: the line of what is wrong, and what.
    pub broken: Vec<(PathBuf, usize, String)>,
    names: Vec<String>,
    dependencies: Vec<BTreeMap<String, usize>>,
}

impl Tree {
    /// Scans `crates`.
    pub fn scan(crates: &[CrateSpec], world: &mut dyn World) -> Self {
        let mut tree = Self::default();
        for (index, spec) in crates.iter().enumerate() {
            tree.names.push(spec.name.clone());
            tree.dependencies.push(spec.dependencies.clone());
            tree.does_without.push(Without::default());
            let root = tree.module(index, None, None);
            tree.roots.push(root);
            let folder = spec.root.parent().unwrap_or(Path::new("")).to_owned();
            tree.file(root, &spec.root, &folder, spec, world, 0);
        }
        tree
    }

    fn module(&mut self, krate: usize, parent: Option<ModuleId>, need: Option<Need>) -> ModuleId {
        self.modules.push(Module { krate, need, parent, names: BTreeMap::new(), globs: vec![] });
        self.modules.len() - 1
    }

    /// Adds the items of a file; `folder` is where the files of its child modules are.
    fn file(
        &mut self,
        module: ModuleId,
        file: &Path,
        folder: &Path,
        spec: &CrateSpec,
        world: &mut dyn World,
        depth: usize,
    ) {
        if depth > MAX_MODULES {
            return;
        }
        // A file that cannot be read is rustc's to report.
        if let Ok(items) = world.items(file) {
            self.items(module, &items, file, folder, spec, world, depth);
        }
    }

    #[allow(clippy::too_many_arguments)]
    fn items(
        &mut self,
        module: ModuleId,
        items: &[Item],
        file: &Path,
        folder: &Path,
        spec: &CrateSpec,
        world: &mut dyn World,
        depth: usize,
    ) {
        for item in items {
            if let Some(cfg) = item.cfg.iter().find(|cfg| !enabled(cfg, &spec.features)) {
                let krate = spec_index(self, module);
                self.left_out.push((krate, item.name.clone(), cfg.split_whitespace().collect()));
                continue;
            }
            let need = self.modules[module].need.max(need(item, &spec.features));
            let target = match &item.kind {
                ItemKind::Module(path, content) => {
                    let child = self.module(spec_index(self, module), Some(module), need);
                    let inner = folder.join(&item.name);
                    match (content, path) {
                        (Some(content), _) => self.items(child, content, file, &inner, spec, world, depth + 1),
                        (None, Some(path)) => {
                            let path = file.parent().unwrap_or(Path::new("")).join(path);
                            let folder = path.parent().unwrap_or(Path::new("")).to_owned();
                            self.file(child, &path, &folder, spec, world, depth + 1);
                        }
                        (None, None) => {
                            let flat = inner.with_extension("rs");
                            let nested = inner.join("mod.rs");
                            let path = if world.exists(&flat) { flat } else { nested };
                            self.file(child, &path, &inner, spec, world, depth + 1);
                        }
                    }
                    Target::Module(child)
                }
                ItemKind::Import(path) => Target::Import(path.clone()),
                ItemKind::Glob(path) => {
                    self.modules[module].globs.push((path.clone(), item.public));
                    continue;
                }
                ItemKind::NoStd { always } => {
                    let krate = spec_index(self, module);
                    let without = &mut self.does_without[krate];
                    (without.can_lack_std, without.lacks_std) = (true, *always);
                    continue;
                }
                ItemKind::Extern => {
                    let krate = spec_index(self, module);
                    self.does_without[krate].has_heap |= matches!(item.name.as_str(), "alloc" | "std");
                    continue;
                }
                ItemKind::Hidden => {
                    self.hidden.push(file.to_owned());
                    continue;
                }
                ItemKind::Broken(reason) => {
                    self.broken.push((file.to_owned(), item.line, reason.clone()));
                    continue;
                }
                kind => {
                    let (name, file) = (item.name.clone(), file.to_owned());
                    self.defs.push(Def { need, name, module, file, line: item.line, kind: kind.clone() });
                    Target::Def(self.defs.len() - 1)
                }
            };
            self.modules[module]
                .names
                .entry(item.name.clone())
                .or_default()
                .push(Entry { public: item.public, target });
        }
    }

    /// The definitions that `path` names in `module`.
    pub fn resolve(&self, module: ModuleId, path: &[String]) -> Vec<DefId> {
        let mut found = BTreeSet::new();
        self.walk(module, path, 0, &mut found);
        found.into_iter().collect()
    }

    fn walk(&self, module: ModuleId, path: &[String], imports: usize, found: &mut BTreeSet<DefId>) {
        let [first, rest @ ..] = path else { return };
        if imports > MAX_IMPORTS {
            return;
        }
        let krate = self.modules[module].krate;
        match first.as_str() {
            "crate" => return self.enter(self.roots[krate], rest, imports, found),
            "self" => return self.enter(module, rest, imports, found),
            "super" => {
                let up = self.modules[module].parent.unwrap_or(module);
                return if rest.first().is_some_and(|s| s == "super") {
                    self.walk(up, rest, imports, found)
                } else {
                    self.enter(up, rest, imports, found)
                };
            }
            _ => {}
        }
        let before = found.len();
        self.enter(module, path, imports, found);
        if found.len() == before
            && !rest.is_empty()
            && let Some(&other) = self.dependencies[krate].get(first)
        {
            self.enter(self.roots[other], rest, imports, found);
        }
    }

    /// `path` relative to what stands in `module`.
    fn enter(&self, module: ModuleId, path: &[String], imports: usize, found: &mut BTreeSet<DefId>) {
        let [first, rest @ ..] = path else { return };
        for entry in self.modules[module].names.get(first).into_iter().flatten() {
            match &entry.target {
                Target::Module(child) => self.enter(*child, rest, imports, found),
                Target::Def(def) if rest.is_empty() => {
                    found.insert(*def);
                }
                Target::Def(_) => {}
                Target::Import(target) => {
                    // `use a::a;` must not lead back to itself.
                    let full: Vec<String> = target.iter().chain(rest).cloned().collect();
                    if full != path {
                        self.walk(module, &full, imports + 1, found);
                    } else if let Some(&other) = self.dependencies[self.modules[module].krate].get(first) {
                        self.enter(self.roots[other], rest, imports + 1, found);
                    }
                }
            }
        }
        for (glob, _) in &self.modules[module].globs {
            if imports < MAX_IMPORTS && glob.first().is_some_and(|g| g != first) {
                let full: Vec<String> = glob.iter().chain(path).cloned().collect();
                self.walk(module, &full, imports + 8, found);
            }
        }
    }

    /// The full path of a name that `module` imports from a crate that is not scanned.
    pub fn external(&self, module: ModuleId, path: &[String]) -> Option<String> {
        let [first, rest @ ..] = path else { return None };
        self.modules[module].names.get(first)?.iter().find_map(|entry| match &entry.target {
            Target::Import(target) if !["crate", "self", "super"].contains(&target[0].as_str()) => {
                Some(target.iter().chain(rest).cloned().collect::<Vec<_>>().join("::"))
            }
            _ => None,
        })
    }

    /// For each definition the shortest path that generated code in crate `here` can use.
    pub fn public_paths(&self, here: usize) -> BTreeMap<DefId, Vec<String>> {
        let mut paths = BTreeMap::new();
        for (krate, &root) in self.roots.iter().enumerate() {
            let start =
                if krate == here { vec!["crate".to_owned()] } else { vec![String::new(), self.names[krate].clone()] };
            let mut queue = std::collections::VecDeque::from([(root, start)]);
            let mut seen = BTreeSet::new();
            while let Some((module, path)) = queue.pop_front() {
                if !seen.insert(module) || path.len() > MAX_MODULES {
                    continue;
                }
                self.list(module, krate == here, &path, &mut paths, &mut queue);
            }
        }
        paths
    }

    fn list(
        &self,
        module: ModuleId,
        own: bool,
        path: &[String],
        paths: &mut BTreeMap<DefId, Vec<String>>,
        queue: &mut std::collections::VecDeque<(ModuleId, Vec<String>)>,
    ) {
        for (name, entries) in &self.modules[module].names {
            for entry in entries.iter().filter(|e| e.public || own) {
                let here: Vec<String> = path.iter().cloned().chain([name.clone()]).collect();
                match &entry.target {
                    Target::Module(child) => queue.push_back((*child, here)),
                    Target::Def(def) => {
                        paths.entry(*def).or_insert(here);
                    }
                    Target::Import(target) if entry.public => {
                        let mut found = BTreeSet::new();
                        self.walk(module, target, 0, &mut found);
                        for def in found {
                            paths.entry(def).or_insert_with(|| here.clone());
                        }
                    }
                    Target::Import(_) => {}
                }
            }
        }
        for (glob, _) in self.modules[module].globs.iter().filter(|(_, public)| *public) {
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

    /// Names that can stand behind `path` in an import, for suggestions.
    pub fn names_in(&self, from: ModuleId, path: &[String]) -> Vec<&str> {
        let module = if path.is_empty() { Some(from) } else { self.find_module(from, path) };
        module.map(|m| self.modules[m].names.keys().map(String::as_str).collect()).unwrap_or_default()
    }

    /// What a type that is an alias stands for.
    pub fn alias(&self, def: DefId) -> Option<&Option<Ty>> {
        match &self.defs[def].kind {
            ItemKind::Alias(target) => Some(target),
            _ => None,
        }
    }
}

/// What an item exists only with: without these features it would not be there.
fn need(item: &Item, features: &BTreeSet<String>) -> Option<Need> {
    let exists_without = |left_out: &[&str]| {
        let features = features.iter().filter(|f| !left_out.contains(&f.as_str())).cloned().collect();
        item.cfg.iter().all(|cfg| enabled(cfg, &features))
    };
    match () {
        () if item.cfg.is_empty() || exists_without(&["std", "alloc"]) => None,
        () if exists_without(&["std"]) => Some(Need::Heap),
        () => Some(Need::Std),
    }
}

fn spec_index(tree: &Tree, module: ModuleId) -> usize {
    tree.modules[module].krate
}

/// Evaluates the tokens of a `cfg`. What cannot be known (target, rustc's own conditions) counts as true.
fn enabled(cfg: &str, features: &BTreeSet<String>) -> bool {
    let compact: String = cfg.chars().filter(|c| !c.is_whitespace()).collect();
    evaluate(&compact, features, 0).unwrap_or(true)
}

fn evaluate(cfg: &str, features: &BTreeSet<String>, depth: usize) -> Option<bool> {
    if depth > 16 {
        return None;
    }
    let inner = |prefix: &str| cfg.strip_prefix(prefix)?.strip_suffix(')');
    if let Some(feature) = cfg.strip_prefix("feature=\"").and_then(|f| f.strip_suffix('"')) {
        return Some(features.contains(feature));
    }
    if cfg == "test" {
        return Some(false);
    }
    if let Some(of) = inner("not(") {
        return evaluate(of, features, depth + 1).map(|v| !v);
    }
    if let Some(of) = inner("all(") {
        return Some(split(of).iter().all(|part| evaluate(part, features, depth + 1).unwrap_or(true)));
    }
    if let Some(of) = inner("any(") {
        return Some(split(of).iter().any(|part| evaluate(part, features, depth + 1).unwrap_or(true)));
    }
    None
}

/// The parts between the commas that are in no bracket.
fn split(list: &str) -> Vec<&str> {
    let (mut depth, mut start, mut parts) = (0, 0, vec![]);
    for (i, c) in list.char_indices() {
        match c {
            '(' => depth += 1,
            ')' => depth -= 1,
            ',' if depth == 0 => {
                parts.push(&list[start..i]);
                start = i + 1;
            }
            _ => {}
        }
    }
    parts.push(&list[start..]);
    parts.retain(|p| !p.is_empty());
    parts
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn conditions() {
        let features = BTreeSet::from(["std".to_owned()]);
        for (cfg, expected) in [
            ("feature = \"std\"", true),
            ("feature = \"gui\"", false),
            ("not (feature = \"std\")", false),
            ("all (feature = \"std\" , not (feature = \"gui\"))", true),
            ("any (feature = \"gui\" , feature = \"std\")", true),
            ("test", false),
            ("target_os = \"none\"", true),
        ] {
            assert_eq!(enabled(cfg, &features), expected, "{cfg}");
        }
    }
}
