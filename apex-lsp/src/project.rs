//! Package of a source file, with the nodes that it can use.

use crate::documents::Document;
use apex_dsl::{catalog::Catalog, source::World};
use apex_host::{Disk, Workspace};
use std::{
    collections::BTreeMap,
    path::{Path, PathBuf},
    sync::Arc,
};

/// A package.
pub struct Project {
    /// Folder to which the paths of Rust files are relative.
    pub root: PathBuf,
    /// Signatures of the nodes.
    pub catalog: Catalog,
    /// File system with a cache of the files that were read.
    pub disk: Disk,
    /// Reason why the nodes are not known.
    pub failure: Option<String>,
}

impl Project {
    /// Reads the package in `folder`. Without a package there are the nodes of the library.
    pub fn load(folder: Option<&Path>) -> Self {
        let (workspace, failure) = match folder.map(Workspace::load).transpose() {
            Ok(workspace) => (workspace, None),
            Err(reason) => (None, Some(reason)),
        };
        let (crates, mut disk) = apex_library::crates_of(workspace.as_ref());
        let root = crates.root.clone();
        let catalog = Catalog::load(crates, &mut disk);
        disk.save();
        Self { root, catalog, disk, failure }
    }
}

/// Folder of the package that a file belongs to.
pub fn package_of(file: &Path) -> Option<PathBuf> {
    file.ancestors().skip(1).find(|folder| folder.join("Cargo.toml").is_file()).map(Path::to_owned)
}

/// File system in which open source files have the text from the editor.
pub struct Overlay<'a> {
    /// File system.
    pub disk: &'a mut Disk,
    /// Open source files.
    pub open: &'a BTreeMap<PathBuf, Document>,
}

impl World for Overlay<'_> {
    fn read(&mut self, path: &Path) -> Result<Arc<str>, String> {
        match self.open.get(path) {
            Some(document) => Ok(document.text.clone()),
            None => self.disk.read(path),
        }
    }

    fn exists(&mut self, path: &Path) -> bool {
        self.open.contains_key(path) || self.disk.exists(path)
    }
}
