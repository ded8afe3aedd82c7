//! The crates that are scanned, and the place from which a graph refers to them.

use super::{cfg::Conditions, items::Item, read::read as read_items};
use crate::source::World;
use std::{
    collections::{BTreeMap, BTreeSet},
    path::{Path, PathBuf},
    sync::Arc,
};

/// A crate to scan.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CrateSpec {
    /// Name by which code refers to the crate.
    pub name: String,
    /// Root file.
    pub root: PathBuf,
    /// Enabled features.
    pub features: BTreeSet<String>,
    /// Names of its dependencies that are not scanned.
    pub externs: BTreeSet<String>,
    /// Dependencies among the scanned crates: name in its code → index.
    pub dependencies: BTreeMap<String, usize>,
}

/// Crates to scan, and the place from which the graph refers to them.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Crates {
    /// Folder to which the names of files are relative.
    pub root: PathBuf,
    /// All crates to scan.
    pub all: Vec<CrateSpec>,
    /// The crate that the generated code becomes part of.
    pub here: usize,
    /// Crates of the package, `here` first: `crate::` in a source file refers to one of them.
    pub own: Vec<usize>,
    /// Place of the generated code.
    pub site: Site,
    /// Conditions of the compilation, as reported by rustc.
    pub conditions: Conditions,
}

/// A world with Rust files.
pub trait RustFiles: World {
    /// The items of a Rust file. A world may cache them between runs.
    ///
    /// # Errors
    /// As [`World::read`].
    fn items(&mut self, path: &Path) -> Result<Arc<[Item]>, String> {
        self.read(path).map(|text| read_items(&text).into())
    }
}

/// Place of the generated code.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub enum Site {
    /// The crate that is compiled: its root module, unless [`Catalog::stand_at`] determines a module.
    #[default]
    Crate,
    /// The module in which the package calls `graph!` with the checked source file. Without such a call, a program that
    /// is made for the source file (`apex run`, `apex test`), which can reach only public items of libraries.
    Text,
}
