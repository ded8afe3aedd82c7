//! Packages for tests.

use crate::client::repository;
use std::{fs, path::PathBuf};

/// A package in a folder of its own, which is removed at the end.
pub struct Package(pub PathBuf);

impl Package {
    /// A package with this name and these nodes.
    pub fn new(name: &str, nodes: &str) -> Self {
        let folder = std::env::temp_dir().join(format!("apex-lsp-{}-{name}", std::process::id()));
        fs::create_dir_all(folder.join("src")).unwrap();
        let runtime = repository().join("apex-rt");
        let manifest = format!(
            "[package]\nname = \"robot\"\nversion = \"0.0.0\"\nedition = \"2024\"\n[workspace]\n[dependencies]\napex-rt = {{ path = {runtime:?} }}\n"
        );
        fs::write(folder.join("Cargo.toml"), manifest).unwrap();
        fs::write(folder.join("src/lib.rs"), nodes).unwrap();
        Self(folder)
    }
}

impl Drop for Package {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}
