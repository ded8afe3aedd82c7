//! Calls the compiler as a library, with the nodes in this folder and no others.

use apex_dsl::{
    catalog::{Catalog, CrateSpec, Crates},
    passes,
    report::Diagnostics,
    source::Sources,
};
use apex_host::Disk;
use std::{
    collections::{BTreeMap, BTreeSet},
    path::{Path, PathBuf},
};

/// Source files and diagnostics.
pub struct Compiled {
    pub sources: Sources,
    pub diagnostics: Diagnostics,
}

/// Folder of this test.
pub fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/errors")
}

/// Nodes for the source files: those of `nodes.rs`, and by import those of `library.rs`.
pub fn catalog() -> Catalog {
    let spec = |name: &str, dependencies| CrateSpec {
        name: name.to_owned(),
        root: folder().join(format!("{name}.rs")),
        features: BTreeSet::new(),
        externs: BTreeSet::from(["core".to_owned()]),
        dependencies,
    };
    let dependencies = BTreeMap::from([("library".to_owned(), 1)]);
    let all = vec![spec("nodes", dependencies), spec("library", BTreeMap::new())];
    Catalog::load(Crates { root: folder(), all, here: 0, own: vec![0], ..Crates::default() }, &mut Disk::new(None))
}

/// Runs all passes on `text` as the content of `path`, including code generation.
pub fn compile(path: &Path, text: &str, catalog: &mut Catalog) -> Compiled {
    let mut sources = Sources::default();
    let mut diagnostics = Diagnostics::default();
    let root = sources.add(path, text);
    let checked = passes::check(root, catalog, &mut sources, &mut Disk::new(None), &mut diagnostics);
    let place = |_| proc_macro2::Span::call_site();
    passes::generate(&checked.programs, &checked.texts.machines, catalog, &sources, &place, false, &mut diagnostics);
    Compiled { sources, diagnostics }
}
