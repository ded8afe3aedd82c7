use std::{
    collections::BTreeMap,
    fs,
    path::{Path, PathBuf},
    time::SystemTime,
};

/// Files of a program, with their modification times and lengths.
#[derive(Clone, PartialEq, Eq, Default)]
pub struct Files(BTreeMap<PathBuf, (Option<SystemTime>, u64)>);

impl Files {
    /// Source files, Rust files and manifests below these folders. Unreadable files count as missing.
    pub fn below(folders: &[PathBuf]) -> Self {
        let mut files = Self::default();
        folders.iter().for_each(|folder| files.collect(folder));
        files
    }

    /// Adds files, without hidden folders and folders that are marked as caches.
    fn collect(&mut self, folder: &Path) {
        for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
            let (path, name) = (entry.path(), entry.file_name());
            if entry.file_type().is_ok_and(|kind| kind.is_dir()) {
                if !name.as_encoded_bytes().starts_with(b".") && !path.join("CACHEDIR.TAG").exists() {
                    self.collect(&path);
                }
            } else if name == "Cargo.toml" || path.extension().is_some_and(|e| e == "afg" || e == "rs") {
                let Ok(metadata) = fs::metadata(&path) else { continue };
                self.0.insert(path, (metadata.modified().ok(), metadata.len()));
            }
        }
    }
}
