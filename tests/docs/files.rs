//! Files of the repository.

use crate::root;
use std::{
    fs,
    path::{Path, PathBuf},
};

/// Folders whose files were not written for this project, or are wrong on purpose.
const SKIPPED: [&str; 3] = ["target", "node_modules", "tests/errors/texts"];

/// Names of all files with this extension, with their paths from the root of the repository, in order.
pub fn names(extension: &str) -> Vec<String> {
    let mut found = vec![];
    collect(&root(), "", extension, &mut found);
    found.sort();
    found
}

/// Adds the names of the files below `folder`, whose path from the root is `path`.
fn collect(folder: &Path, path: &str, extension: &str, found: &mut Vec<String>) {
    let mut entries: Vec<PathBuf> = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    entries.sort();
    for entry in entries {
        let Some(name) = entry.file_name().and_then(|name| name.to_str()) else { continue };
        let below = if path.is_empty() { name.to_owned() } else { format!("{path}/{name}") };
        if name.starts_with('.') || SKIPPED.contains(&name) || SKIPPED.contains(&below.as_str()) {
            continue;
        }
        if entry.is_dir() {
            collect(&entry, &below, extension, found);
        } else if entry.extension().is_some_and(|is| is == extension) {
            found.push(below);
        }
    }
}
