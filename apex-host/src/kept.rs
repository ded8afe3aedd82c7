use crate::{
    Disk, Workspace,
    disk::{Stamp, stamp},
};
use apex_dsl::catalog::{Catalog, Crates};
use std::{
    collections::BTreeMap,
    path::{Path, PathBuf},
};

/// Workspace and catalog that a process has loaded, so that a crate with hundreds of graphs is not scanned for each of
/// them. Tools run longer than a compilation: everything is loaded again when a file changes on which it depends.
#[derive(Default)]
pub struct Kept {
    workspace: Option<(PathBuf, Workspace)>,
    catalog: Option<Scanned>,
}

struct Scanned {
    crates: Crates,
    files: BTreeMap<PathBuf, Stamp>,
    catalog: Catalog,
}

impl Kept {
    /// Returns the workspace of the package in `folder`, as [`Workspace::load`] does.
    ///
    /// # Errors
    /// The errors of [`Workspace::load`].
    pub fn workspace(&mut self, folder: &Path) -> Result<&Workspace, String> {
        let kept = self.workspace.take().filter(|(of, workspace)| of == folder && workspace.is_current());
        let current = match kept {
            Some(kept) => kept,
            None => (folder.to_owned(), Workspace::load(folder)?),
        };
        Ok(&self.workspace.insert(current).1)
    }

    /// Returns the catalog of `crates`, whose files are read through `disk`.
    pub fn catalog(&mut self, crates: Crates, disk: &mut Disk) -> &mut Catalog {
        let kept = self.catalog.take().filter(|scanned| scanned.holds_for(&crates));
        let scanned = kept.unwrap_or_else(|| Scanned::new(crates, disk));
        &mut self.catalog.insert(scanned).catalog
    }
}

impl Scanned {
    fn new(crates: Crates, disk: &mut Disk) -> Self {
        disk.take_asked();
        let catalog = Catalog::load(crates.clone(), disk);
        Self { crates, files: disk.take_asked(), catalog }
    }

    fn holds_for(&self, crates: &Crates) -> bool {
        self.crates == *crates && self.files.iter().all(|(path, old)| stamp(path) == *old)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use apex_dsl::catalog::CrateSpec;
    use std::{collections::BTreeSet, env, fs, process};

    fn crates(root: PathBuf) -> Crates {
        let spec = CrateSpec {
            name: "robot".to_owned(),
            root: root.join("lib.rs"),
            features: BTreeSet::new(),
            externs: BTreeSet::new(),
            dependencies: BTreeMap::new(),
        };
        Crates { root, all: vec![spec], here: 0, own: vec![0], ..Crates::default() }
    }

    #[test]
    fn files_are_read_again_only_when_they_change() {
        let folder = env::temp_dir().join(format!("apex-kept-{}", process::id()));
        fs::create_dir_all(folder.join("drive")).unwrap();
        let write = |name: &str, text: &str| fs::write(folder.join(name), text).unwrap();
        write("lib.rs", "#[node] fn one() -> u8 { 1 } mod drive;");
        write("drive/mod.rs", "#[node] pub fn two() -> u8 { 2 }");
        let mut kept = Kept::default();
        // Returns the names of the nodes, and `true` if a file was read for them.
        let mut nodes = || -> (Vec<String>, bool) {
            let mut disk = Disk::new(None);
            let catalog = kept.catalog(crates(folder.clone()), &mut disk);
            let names = catalog.rust_nodes().map(|(_, node)| node.name.clone()).collect();
            (names, disk.has_read_items())
        };
        assert_eq!(nodes(), (vec!["one".to_owned(), "two".to_owned()], true));
        assert_eq!(nodes(), (vec!["one".to_owned(), "two".to_owned()], false));
        // Cargo prefers this file to the one in the folder.
        write("drive.rs", "#[node] pub fn three() -> u8 { 3 }");
        assert_eq!(nodes(), (vec!["one".to_owned(), "three".to_owned()], true));
        write("lib.rs", "#[node] fn four() -> u8 { 4 }");
        assert_eq!(nodes(), (vec!["four".to_owned()], true));
        assert_eq!(nodes(), (vec!["four".to_owned()], false));
        fs::remove_dir_all(&folder).unwrap();
    }
}
