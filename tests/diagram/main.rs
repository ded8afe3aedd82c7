//! Diagrams of graphs: their contents, their layout, and the pictures of the documentation.

mod dot;
mod figures;
mod layout;
mod model;
mod svg;

use apex_diagram::{Item, diagram};
use apex_dsl::{
    catalog::Catalog,
    graph::Graph,
    machine::Machines,
    passes,
    report::{Diagnostics, render},
    source::Sources,
};
use apex_host::{Disk, Seen, Workspace};
use std::path::{Path, PathBuf};

/// The nodes that source files can use, and the state machines of the last one.
struct Drawer(Catalog, Machines);

impl Drawer {
    /// Uses the nodes of this package.
    fn new() -> Self {
        Self::of(&root().join("tests"))
    }

    /// Uses the nodes of the package in this folder.
    fn of(folder: &Path) -> Self {
        let workspace = Workspace::load(folder).expect("cargo knows the package");
        let mut disk = Disk::new(Some(&workspace.cache_folder()));
        let catalog = Catalog::load(workspace.crates(&Seen::Package), &mut disk);
        disk.save();
        Self(catalog, Machines::new())
    }

    /// Graphs of a source file in this folder.
    fn graphs(&mut self, folder: &Path, text: &str) -> Result<Vec<Graph>, String> {
        let mut sources = Sources::default();
        let file = sources.add(folder.join("text.afg"), text);
        let mut diagnostics = Diagnostics::default();
        let checked = passes::check(file, &mut self.0, &mut sources, &mut Disk::new(None), &mut diagnostics);
        if diagnostics.has_errors() {
            return Err(diagnostics.sorted().into_iter().map(|d| render(d, &sources, false)).collect());
        }
        self.1 = checked.texts.machines;
        Ok(checked.programs.into_iter().filter(|p| !p.is_test()).map(|p| p.graph).collect())
    }

    /// Diagram of the only graph of a source file.
    fn one(&mut self, text: &str) -> Item {
        let graphs = self.graphs(&root().join("tests"), text).unwrap_or_else(|errors| panic!("{errors}"));
        assert_eq!(graphs.len(), 1, "one graph is expected");
        diagram(&graphs[0], &self.1, &self.0)
    }
}

/// Folder of the workspace.
fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// Diagrams of random graphs of all kinds, some with nested graphs, activity and events.
fn random(count: usize) -> Vec<(String, Item)> {
    let mut drawer = Drawer::new();
    let mut texts: Vec<String> =
        (0..count as u64).map(|seed| apex_tests::oracle::generate(seed, true).text("Random")).collect();
    texts.push(apex_tests::text(&apex_tests::cases(apex_tests::SEED, count / 4)));
    let mut pictures = vec![];
    for text in &texts {
        // Some random graphs are not legal.
        for graph in drawer.graphs(&root().join("tests"), text).unwrap_or_default() {
            pictures.push((text.clone(), diagram(&graph, &drawer.1, &drawer.0)));
        }
    }
    assert!(pictures.len() > count * 3 / 4, "only {} graphs of {count} are legal", pictures.len());
    assert!(pictures.iter().any(|(_, item)| item.count() > 40), "all graphs are small");
    pictures
}
