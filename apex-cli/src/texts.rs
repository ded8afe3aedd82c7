//! Source files that a command line names.

use std::{
    fs, io,
    path::{Path, PathBuf},
};

/// The file itself, or the source files below a folder.
pub fn named(path: &Path) -> Result<Vec<PathBuf>, String> {
    if !path.is_dir() {
        return Ok(vec![path.to_owned()]);
    }
    let mut found = vec![];
    collect(path, &mut found).map_err(|(folder, e)| format!("cannot read `{}`: {e}", folder.display()))?;
    if found.is_empty() {
        return Err(format!("there is no `.afg` file in `{}`", path.display()));
    }
    Ok(found)
}

/// Adds the source files below `folder` in order, without hidden folders and folders that are marked as caches.
fn collect(folder: &Path, found: &mut Vec<PathBuf>) -> Result<(), (PathBuf, io::Error)> {
    let at = |e| (folder.to_owned(), e);
    let entries: io::Result<Vec<_>> = fs::read_dir(folder).and_then(Iterator::collect);
    let mut entries = entries.map_err(at)?;
    entries.sort_by_key(fs::DirEntry::file_name);
    for entry in entries {
        let path = entry.path();
        let is_hidden = entry.file_name().as_encoded_bytes().starts_with(b".");
        if entry.file_type().map_err(at)?.is_dir() {
            if !is_hidden && !path.join("CACHEDIR.TAG").exists() {
                collect(&path, found)?;
            }
        } else if path.extension().is_some_and(|e| e == "afg") && path.is_file() {
            found.push(path);
        }
    }
    Ok(())
}
