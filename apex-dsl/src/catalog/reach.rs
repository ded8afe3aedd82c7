//! Place of the generated code, and the items that it can reach from there.

use super::{
    catalog::Catalog,
    crates::Site,
    items::ItemKind,
    signature::SignatureId,
    tree::{DefId, ModuleId},
};
use std::path::{Path, PathBuf};

impl Catalog {
    /// A path of generated code as a source file of the package spells it: with `crate` for its own crates.
    pub fn written(&self, path: &[String]) -> Vec<String> {
        let is_own = |name: &String| self.crates.own.iter().any(|own| self.crates.all[*own].name == *name);
        match path {
            [first, krate, rest @ ..] if first.is_empty() && is_own(krate) => {
                [vec!["crate".to_owned()], rest.to_vec()].concat()
            }
            [first, rest @ ..] if first.is_empty() => rest.to_vec(),
            _ => path.to_vec(),
        }
    }

    /// Changes the site to the place where the source file `file` is compiled.
    pub fn look_from(&mut self, file: &Path) {
        if self.crates.site != Site::Text {
            return;
        }
        let site = self.calls_of(file).next();
        self.look(site);
    }

    /// Changes the site to the module of a line of a file, which calls `graph!` in the crate that is compiled.
    pub fn stand_at(&mut self, file: &Path, line: usize) {
        let root = self.tree.roots.get(self.crates.here).copied();
        self.look(self.tree.module_at(self.crates.here, file, line).or(root));
    }

    /// Changes the site, and the paths by which generated code reaches definitions.
    fn look(&mut self, site: Option<ModuleId>) {
        if site == self.site {
            return;
        }
        self.site = site;
        self.paths = self.tree.paths(site);
        let places: Vec<(DefId, SignatureId)> = self.by_def.iter().map(|(def, signature)| (*def, *signature)).collect();
        for (def, signature) in places {
            self.signatures[signature].path = self.paths.get(&def).cloned().unwrap_or_default();
        }
    }

    /// Place of the type that `name` means in the module of the generated code, if that names one explicitly. A second
    /// type of this name cannot be defined there.
    pub fn type_at_site(&self, name: &str) -> Option<(PathBuf, usize)> {
        let site = self.site?;
        let is_type = |def: &DefId| !matches!(self.tree.defs[*def].kind, ItemKind::Constant(_));
        let found = self.tree.named_in(site, name).into_iter().find(is_type)?;
        Some(self.place(found))
    }

    /// Modules that call `graph!` with the source file `file`. The name in the call is relative to the folder of the
    /// Rust file, or to a folder around it, such as that of the package.
    fn calls_of<'a>(&'a self, file: &'a Path) -> impl Iterator<Item = ModuleId> + 'a {
        let own = |module: ModuleId| self.crates.own.contains(&self.tree.modules[module].krate);
        let calls = self.tree.calls.iter().filter(move |(module, _, name)| own(*module) && !name.is_empty());
        let is_meant = move |folder: &Path, name: &str| folder.ancestors().any(|f| is_same(&f.join(name), file));
        calls.filter(move |(_, folder, name)| is_meant(folder, name)).map(|(module, ..)| *module)
    }
}

/// Returns `true` if two paths lead to one file, judged by their text: `src/../a.afg` is `a.afg`, and `b` may be
/// relative.
fn is_same(a: &Path, b: &Path) -> bool {
    use std::path::Component;
    let plain = |path: &Path| {
        path.components().fold(PathBuf::new(), |mut plain, part| {
            match part {
                Component::ParentDir if plain.file_name().is_some() => drop(plain.pop()),
                Component::CurDir => {}
                part => plain.push(part),
            }
            plain
        })
    };
    let (a, b) = (plain(a), plain(b));
    if b.is_absolute() { a == b } else { a.ends_with(&b) }
}
