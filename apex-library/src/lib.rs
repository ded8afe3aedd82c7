//! Nodes of the library, for source files outside of any package: all features, as they were when this crate was built.

use apex_dsl::catalog::{CrateSpec, Crates, Item};
use apex_host::{Disk, Seen, Workspace};
use serde::Deserialize;
use std::{
    collections::{BTreeMap, BTreeSet},
    path::{Path, PathBuf},
    sync::Arc,
};

/// Index that the build script has written.
const INDEX: &str = include_str!(concat!(env!("OUT_DIR"), "/index.json"));
/// Crates that every package for Apex depends on. Their types can be named.
const EXTERNS: [&str; 2] = ["apex_macros", "apex_rt"];

#[derive(Default, Deserialize)]
struct Index {
    crates: Vec<Crate>,
    files: BTreeMap<PathBuf, Arc<[Item]>>,
}

#[derive(Deserialize)]
struct Crate {
    name: String,
    root: PathBuf,
    features: BTreeSet<String>,
    dependencies: BTreeSet<String>,
}

/// Returns the crates that a source file can use, and a file system for them: those of its package, or the library
/// outside of any package.
pub fn crates_of(package: Option<&Workspace>) -> (Crates, Disk) {
    package.map_or_else(lone, |package| (package.crates(&Seen::Package), Disk::new(Some(&package.cache_folder()))))
}

/// Returns the crates that a source file outside of any package can use, and a file system with their items.
pub fn lone() -> (Crates, Disk) {
    // A crate without items stands for the missing package.
    let text = Path::new("text.rs");
    let (crates, disk) = around("text", text);
    (crates, disk.with_items([(text.to_owned(), [].into())]))
}

/// Returns the crates that a source file can use in a package with this root file, which depends on all crates of the
/// library, and a file system with their items.
pub fn around(package: &str, file: &Path) -> (Crates, Disk) {
    // The build script has written the index for this very type: without it there would be no nodes.
    let Index { crates, files } = serde_json::from_str(INDEX).unwrap_or_default();
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap_or(Path::new("")).to_owned();
    let own = Crate {
        name: package.replace('-', "_"),
        root: file.to_owned(),
        features: BTreeSet::new(),
        dependencies: crates.iter().map(|known| known.name.clone()).chain(EXTERNS.map(str::to_owned)).collect(),
    };
    let all: Vec<Crate> = [own].into_iter().chain(crates).collect();
    let files = files.into_iter().map(|(path, items)| (root.join(path), items));
    let disk = Disk::new(None).with_items(files);
    let mut all: Vec<CrateSpec> = all.iter().map(|krate| spec(krate, &all, &root)).collect();
    // It is not in the checkout.
    all[0].root = file.to_owned();
    (Crates { root, all, here: 0, own: vec![0], ..Crates::default() }, disk)
}

/// Crate to scan, with its dependencies among `all`.
fn spec(krate: &Crate, all: &[Crate], root: &Path) -> CrateSpec {
    let at = |name: &String| all.iter().position(|other| other.name == *name);
    CrateSpec {
        name: krate.name.clone(),
        root: root.join(&krate.root),
        features: krate.features.clone(),
        externs: krate.dependencies.iter().filter(|name| at(name).is_none()).cloned().collect(),
        dependencies: krate.dependencies.iter().filter_map(|name| Some((name.clone(), at(name)?))).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use apex_dsl::catalog::Catalog;

    #[test]
    fn the_index_has_the_nodes_of_the_library() {
        let (crates, mut disk) = lone();
        let catalog = Catalog::load(crates, &mut disk);
        let node = |path: &str| {
            let path: Vec<String> = path.split("::").map(str::to_owned).collect();
            assert_eq!(catalog.nodes(&path).len(), 1, "{path:?}");
        };
        ["apex_nodes::flow::Inbox", "apex_nodes::slam::GraphSlam", "apex_sim::LaserScanner"]
            .iter()
            .for_each(|path| node(path));
        assert!(catalog.broken().next().is_none() && catalog.rust_nodes().count() > 150);
        assert!(catalog.is_extern("apex_rt") && catalog.is_crate("crate"));
    }
}
