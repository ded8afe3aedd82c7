//! Rust sources for the catalog.

use crate::{
    mutate::{Dice, files, root, split, words},
    worker::Target,
};
use apex_dsl::{
    catalog::{Catalog, CrateSpec, Crates, RustFiles},
    source::World,
};
use std::{
    collections::{BTreeMap, BTreeSet},
    path::{Path, PathBuf},
    sync::Arc,
};

/// Tokens with a meaning for the catalog.
const WORDS: &[&str] = &[
    "#[node]\n",
    "#[cfg(windows)]\n",
    "#[cfg(not(",
    "#[path = \"lib.rs\"] mod a;\n",
    "mod a;",
    "pub use crate::*;",
    "pub use self::",
    "use super::*;",
    "pub mod a {",
    "unsafe ",
    "impl",
    "struct",
    "enum",
    "type",
    "r#type",
    "<const N: usize>",
    "Vec<",
    "Option<",
    "&mut ",
    "[u8; 0]",
    "Event<",
    "#[param(default = ",
    "range = 0..=1)]",
    "#[slot]\n",
    "macro_rules! m {",
    "'static ",
    "dyn ",
    "pub(crate) ",
    "crate::",
    "extern crate core as x;",
    "#![no_std]\n",
    "#[derive(Outputs)]\n",
    "where ",
    "Result<",
    "(",
    ")",
    "{",
    "}",
    ";",
];

struct Sources {
    files: Vec<String>,
}

/// The target with Rust sources.
pub fn catalog() -> Box<dyn Target> {
    let files = ["nodes/src", "tests/src/nodes", "tests/errors", "apex-rt/src"];
    Box::new(Sources { files: files.iter().flat_map(|folder| files_of(folder)).collect() })
}

fn files_of(folder: &str) -> Vec<String> {
    files(&root().join(folder), "rs")
}

/// A file system with a single file under three names.
struct OneFile(Arc<str>);

impl World for OneFile {
    fn read(&mut self, path: &Path) -> Result<Arc<str>, String> {
        if self.exists(path) { Ok(self.0.clone()) } else { Err("there is no such file".to_owned()) }
    }

    fn exists(&mut self, path: &Path) -> bool {
        ["/x/lib.rs", "/x/a.rs", "/x/a/a.rs"].iter().any(|known| path == Path::new(known))
    }
}

impl RustFiles for OneFile {}

impl Target for Sources {
    fn make(&mut self, dice: &mut Dice) -> Vec<u8> {
        let text = dice.of(&self.files).clone();
        let mut text = words(&text, WORDS, dice);
        if dice.below(4) == 0 {
            let other = dice.of(&self.files);
            let (a, b) = (split(&text), split(other));
            text = [&a[..dice.below(a.len())], &b[dice.below(b.len())..]].concat().concat();
        }
        text.into_bytes()
    }

    fn run(&mut self, input: &[u8]) {
        let text: Arc<str> = String::from_utf8_lossy(input).into();
        let spec = CrateSpec {
            name: "x".to_owned(),
            root: PathBuf::from("/x/lib.rs"),
            features: BTreeSet::from(["std".to_owned()]),
            externs: BTreeSet::from(["core".to_owned(), "apex_rt".to_owned()]),
            dependencies: BTreeMap::new(),
        };
        let crates = Crates { root: PathBuf::from("/x"), all: vec![spec], here: 0, own: vec![0], ..Crates::default() };
        let catalog = Catalog::load(crates, &mut OneFile(text));
        for (_, node) in catalog.rust_nodes() {
            assert!(!node.name.is_empty(), "a node without a name");
        }
    }
}
