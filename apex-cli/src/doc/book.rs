//! Contents of the pages, independent of HTML.

use apex_ide::{ParamFacts, PortFacts};
use std::{
    collections::BTreeMap,
    path::{Path, PathBuf},
};

/// Source files and the nodes that they use.
pub struct Book {
    /// Source files, sorted by path.
    pub texts: Vec<Text>,
    /// Rust nodes, sorted by module.
    pub nodes: Vec<Item>,
}

/// Identity of a declaration. That of a source file has line 0 and an empty name.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct Key {
    /// File of the declaration.
    pub file: PathBuf,
    /// Line of the name, counted from 1.
    pub line: usize,
    /// Name of the declaration.
    pub name: String,
}

/// A source file.
pub struct Text {
    /// Identity of the source file.
    pub key: Key,
    /// Path as shown on pages.
    pub path: String,
    /// Documentation.
    pub docs: String,
    /// Graphs, robots and state machines in the order of the source file.
    pub items: Vec<Item>,
    /// Tests in the order of the source file.
    pub tests: Vec<Test>,
}

/// A graph, a robot, a state machine or a Rust node.
pub struct Item {
    /// Identity of the declaration.
    pub key: Key,
    /// `graph`, `robot`, `fsm` or `node`.
    pub word: &'static str,
    /// Source file or Rust module of the declaration.
    pub module: String,
    /// Path for `use` in a source file, for Rust nodes.
    pub import: Option<String>,
    /// File and line, if the path is the same on all machines.
    pub place: Option<String>,
    /// Documentation.
    pub docs: String,
    /// Name, parameters and ports in the syntax of the language, for Rust nodes.
    pub signature: Option<String>,
    /// Parameters.
    pub params: Vec<ParamFacts>,
    /// Ports.
    pub ports: Vec<PortFacts>,
    /// Diagrams.
    pub pictures: Vec<Picture>,
    /// Nodes of a graph.
    pub nodes: Vec<Use>,
    /// States of a state machine.
    pub states: Vec<State>,
    /// Claims of a graph.
    pub claims: Vec<Claim>,
    /// Source code of the declaration, if it is in a source file.
    pub code: Option<String>,
}

/// A diagram.
pub struct Picture {
    /// Title.
    pub title: &'static str,
    /// SVG, or the number of boxes if there are too many.
    pub svg: Result<String, usize>,
}

/// A node of a graph.
pub struct Use {
    /// Name, or `None` for a node that is written in a connection.
    pub name: Option<String>,
    /// Type as written.
    pub ty: String,
    /// Declaration of the type.
    pub of: Option<Key>,
    /// `true` if the node is made in Rust and handed in.
    pub handed_in: bool,
    /// Arguments and modifiers, as written.
    pub given: Vec<String>,
    /// Documentation.
    pub docs: String,
}

/// A state.
pub struct State {
    /// Name with the names of the enclosing states before it.
    pub path: String,
    /// Documentation.
    pub docs: String,
}

/// A claim.
pub struct Claim {
    /// Claim as written.
    pub text: String,
    /// Result of the proof, if the claim was checked.
    pub verdict: Option<&'static str>,
}

/// A test.
pub struct Test {
    /// Name.
    pub name: String,
    /// Tested graph, as written.
    pub graph: String,
    /// Declaration of the tested graph.
    pub of: Option<Key>,
    /// Documentation.
    pub docs: String,
    /// Source code of the test.
    pub code: String,
}

/// Locations of the source files.
pub struct Files {
    /// Folder that contains all of them.
    pub base: PathBuf,
    /// Canonical path of each path under which a file was read.
    pub real: BTreeMap<PathBuf, PathBuf>,
}

impl Files {
    /// Canonical path of a file.
    pub fn real(&self, path: &Path) -> PathBuf {
        self.real.get(path).cloned().unwrap_or_else(|| path.to_owned())
    }

    /// Path as shown on pages: the same on all machines.
    pub fn shown(&self, real: &Path) -> String {
        let path = real.strip_prefix(&self.base).ok().or_else(|| real.file_name().map(Path::new)).unwrap_or(real);
        let parts: Vec<_> = path.components().map(|part| part.as_os_str().to_string_lossy()).collect();
        parts.join("/")
    }
}

impl Book {
    /// All items that have pages.
    pub fn items(&self) -> impl Iterator<Item = &Item> {
        self.texts.iter().flat_map(|text| &text.items).chain(&self.nodes)
    }
}
