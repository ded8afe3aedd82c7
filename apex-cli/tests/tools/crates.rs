//! Crates of which the types of tokens are, in programs that are made for a source file.

use crate::{
    TARGET, builds,
    common::{Folder, apex, lock, stderr},
};
use std::{fs, path::Path};

/// Nodes whose tokens are of a type of a crate that knows nothing of Apex. They need a feature.
const PARTS: &str = "\
#![cfg(feature = \"extra\")]
use apex_rt::prelude::*;
use kinds::Level;
/// A level.
#[node]
pub fn level() -> Level {
    Level(7)
}
/// Keeps a token.
#[node]
pub struct Keep<T> {
    kept: Option<T>,
}
#[node]
impl<T: Clone> Keep<T> {
    fn process(&mut self, token: &T) -> T {
        self.kept.insert(token.clone()).clone()
    }
}
/// Prints a level.
#[node]
pub fn done(level: &Level) -> u8 {
    println!(\"level {}\", level.0);
    level.0
}
";

const TEXT: &str = "\
use parts::{Keep, done, level};

robot Once {
    node level = level() every 10ms;
    node keep  = Keep();
    node done  = done();
    level -> keep -> done -> exit;
}
";

/// Makes a workspace: crates with a type and with nodes, and a package that only has the file `file`.
fn workspace(folder: &Folder, file: &str) {
    let checkout = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let package = |name: &str| format!("[package]\nname = \"{name}\"\nversion = \"0.0.0\"\nedition = \"2024\"\n");
    let runtime = format!("apex-rt = {{ path = {:?} }}\n", checkout.join("apex-rt"));
    let (kinds, parts, own) = (format!("{}-kinds", folder.name()), format!("{}-parts", folder.name()), folder.name());
    let files = [
        (
            "Cargo.toml",
            format!(
                "{}[workspace]\nmembers = [\"kinds\", \"parts\"]\n[workspace.dependencies]\n\
                 kinds = {{ package = \"{kinds}\", path = \"kinds\" }}\n\
                 [dependencies]\n{runtime}apex-macros = {{ path = {:?} }}\nkinds.workspace = true\n\
                 {parts} = {{ path = \"parts\", features = [\"extra\"] }}\n",
                package(own),
                checkout.join("apex-macros"),
            ),
        ),
        (file, "//! Only texts.\n#![allow(unused)]\nfn main() {}\n".to_owned()),
        ("kinds/Cargo.toml", package(&kinds)),
        ("kinds/src/lib.rs", "#[derive(Debug, Clone)]\npub struct Level(pub u8);\n".to_owned()),
        (
            "parts/Cargo.toml",
            format!("{}[features]\nextra = []\n[dependencies]\n{runtime}kinds.workspace = true\n", package(&parts)),
        ),
        ("parts/src/lib.rs", PARTS.to_owned()),
        ("once.afg", TEXT.replace("parts", &parts.replace('-', "_"))),
    ];
    for (path, text) in files {
        fs::create_dir_all(folder.0.join(path).parent().unwrap()).unwrap();
        folder.file(path, text);
    }
    lock(&folder.0);
}

/// The library of a package selects the features of its crates; a package with a binary has none.
#[test]
fn the_types_of_tokens_may_be_of_any_crate_of_the_package() {
    let _guard = builds();
    for (name, file) in [("of-library", "src/lib.rs"), ("of-binary", "src/main.rs")] {
        let folder = Folder::new(name);
        workspace(&folder, file);
        let mut command = apex();
        command.args(["run", "--robot", "Once"]).arg(folder.0.join("once.afg")).env("CARGO_TARGET_DIR", TARGET);
        let output = command.output().unwrap();
        assert_eq!(String::from_utf8_lossy(&output.stdout), "level 7\n", "{file}: {}", stderr(&output));
        assert_eq!(output.status.code(), Some(0), "{file}");
    }
}
