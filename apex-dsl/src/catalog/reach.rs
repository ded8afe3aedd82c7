//! Where generated code stands, and what it can reach from there.

use super::{Catalog, Crates, DefId, ModuleId, Tree};
use std::path::{Path, PathBuf};

/// Where generated code stands.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub enum Site {
    /// In the crate that is compiled: in its root module, until [`Catalog::stand_at`] says more.
    #[default]
    Crate,
    /// Where the package calls `graph!` with the text that is checked, or, if it does not, in a program of its own that is made for the
    /// text (`apex run`, `apex test`), which sees what is public in libraries.
    Text,
}

/// The module of the site, as far as it is known before a text is.
pub fn site(tree: &Tree, crates: &Crates) -> Option<ModuleId> {
    match &crates.site {
        Site::Crate => tree.roots.get(crates.here).copied(),
        Site::Text => None,
    }
}

impl Catalog {
    /// The path of generated code as a text of the package writes it: its own crates are `crate`.
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

    /// Looks from where the text in `file` is compiled.
    pub fn look_from(&mut self, file: &Path) {
        if self.crates.site != Site::Text {
            return;
        }
        let site = self.calls_of(file).next();
        self.look(site);
    }

    /// Looks from the module that a line of a file belongs to: that of a call of `graph!` in the crate that is compiled.
    pub fn stand_at(&mut self, file: &Path, line: usize) {
        let root = self.tree.roots.get(self.crates.here).copied();
        self.look(self.tree.module_at(self.crates.here, file, line).or(root));
    }

    fn look(&mut self, site: Option<ModuleId>) {
        if site == self.site {
            return;
        }
        self.site = site;
        self.paths = self.tree.paths(site);
        let places: Vec<(DefId, usize)> = self.by_def.iter().map(|(def, signature)| (*def, *signature)).collect();
        for (def, signature) in places {
            self.signatures[signature].path = self.paths.get(&def).cloned().unwrap_or_default();
        }
    }

    /// The modules that call `graph!` with the text in `file`: its name is looked for beside the source file, then in the
    /// folder of the package, which is around it.
    fn calls_of<'a>(&'a self, file: &'a Path) -> impl Iterator<Item = ModuleId> + 'a {
        let own = |module: ModuleId| self.crates.own.contains(&self.tree.modules[module].krate);
        let calls = self.tree.calls.iter().filter(move |(module, _, name)| own(*module) && !name.is_empty());
        let is_meant = move |folder: &Path, name: &str| folder.ancestors().any(|f| is_same(&f.join(name), file));
        calls.filter(move |(_, folder, name)| is_meant(folder, name)).map(|(module, ..)| *module)
    }
}

/// Whether two paths lead to one file, as far as their words say: `src/../a.afg` is `a.afg`, and one may be relative.
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
