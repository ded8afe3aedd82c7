//! Nodes for random graphs, as Rust source in memory.

use apex_dsl::{
    catalog::{Catalog, CrateSpec, Crates, RustFiles},
    source::World,
};
use std::{
    collections::{BTreeMap, BTreeSet},
    path::{Path, PathBuf},
    sync::Arc,
};

/// Nodes with each form of ports, all for tokens `()`.
const NODES: &str = r"
use apex_rt::prelude::*;

pub const NIL: () = ();

#[node]
pub struct Turn;

#[node]
impl Turn {
    #[slot]
    fn s(&mut self, value: &(), l: Event<()>, r: Event<()>) {}

    #[slot]
    fn t(&mut self, value: &(), l: Event<()>) {}
}

#[node]
pub struct Rest;

#[node]
impl Rest {
    #[slot]
    fn s(&mut self, value: &()) {}
}

#[node]
#[deactivates]
pub struct Stop;

#[node]
impl Stop {
    fn process(&mut self, x: Option<&()>, out: &mut Out<()>) {}

    #[slot]
    fn s(&mut self, value: &(), l: Event<()>) {}
}

#[node]
pub struct Mixed;

#[node]
impl Mixed {
    fn process(&mut self, x: Option<&()>, out: &mut Out<()>, l: Event<()>) {}

    #[slot]
    fn s(&mut self, value: &(), l: Event<()>) {}
}

#[node]
pub fn source(out: &mut Out<()>, l: Event<()>) {}

#[node]
pub fn pass(x: &(), out: &mut Out<()>) {}

#[node]
pub fn fork(x: &(), y: &mut Out<()>, z: &mut Out<()>) {}

#[node]
pub fn join(a: &(), b: &(), out: &mut Out<()>) {}

#[node]
pub fn emit(x: &(), l: Event<()>, r: Event<()>) {}
";

/// File of [`NODES`].
const ROOT: &str = "/nodes/lib.rs";

/// A world with one file.
pub struct Memory;

impl World for Memory {
    fn read(&mut self, path: &Path) -> Result<Arc<str>, String> {
        if self.exists(path) { Ok(NODES.into()) } else { Err("there is no such file".to_owned()) }
    }

    fn exists(&mut self, path: &Path) -> bool {
        path == Path::new(ROOT)
    }
}

impl RustFiles for Memory {}

/// The catalog of [`NODES`].
pub fn catalog() -> Catalog {
    let spec = CrateSpec {
        name: "nodes".to_owned(),
        root: PathBuf::from(ROOT),
        features: BTreeSet::new(),
        externs: BTreeSet::from(["core".to_owned()]),
        dependencies: BTreeMap::new(),
    };
    let crates = Crates { root: PathBuf::from("/"), all: vec![spec], here: 0, own: vec![0], ..Crates::default() };
    Catalog::load(crates, &mut Memory)
}
