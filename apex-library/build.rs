//! Writes the index of the library: the crates with their features, and the items of their Rust files.

use apex_dsl::catalog::{Item, read_items};
use serde_json::json;
use std::{
    collections::{BTreeMap, BTreeSet},
    env,
    error::Error,
    fs,
    path::{Path, PathBuf},
};
use toml::Table;

/// Crates whose nodes are in the index: name in code, and folder in the checkout.
const CRATES: [(&str, &str); 2] = [("apex_nodes", "nodes"), ("apex_sim", "robots/sim")];

fn main() -> Result<(), Box<dyn Error>> {
    let folder = PathBuf::from(env::var("CARGO_MANIFEST_DIR")?);
    let checkout = folder.parent().ok_or("the crate is in no checkout")?;
    let mut files = BTreeMap::new();
    let mut crates = vec![];
    for (name, folder) in CRATES {
        let manifest = checkout.join(folder).join("Cargo.toml");
        let sources = checkout.join(folder).join("src");
        for watched in [&manifest, &sources] {
            println!("cargo::rerun-if-changed={}", watched.display());
        }
        let manifest: Table = fs::read_to_string(manifest)?.parse()?;
        let names = |key: &str| -> BTreeSet<String> {
            let table = manifest.get(key).and_then(|value| value.as_table());
            table.into_iter().flatten().map(|(name, _)| name.to_owned()).collect()
        };
        let dependencies: BTreeSet<String> = names("dependencies").iter().map(|name| name.replace('-', "_")).collect();
        crates.push(json!({
            "name": name,
            "root": Path::new(folder).join("src/lib.rs"),
            "features": names("features"),
            "dependencies": dependencies,
        }));
        read(&sources, checkout, &mut files)?;
    }
    let index = json!({ "crates": crates, "files": files });
    fs::write(PathBuf::from(env::var("OUT_DIR")?).join("index.json"), index.to_string())?;
    Ok(())
}

/// Adds the items of all Rust files below `folder`. Their paths are relative to the checkout.
fn read(folder: &Path, checkout: &Path, files: &mut BTreeMap<PathBuf, Vec<Item>>) -> Result<(), Box<dyn Error>> {
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() {
            read(&path, checkout, files)?;
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            files.insert(path.strip_prefix(checkout)?.to_owned(), read_items(&fs::read_to_string(&path)?));
        }
    }
    Ok(())
}
