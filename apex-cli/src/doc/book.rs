//! What the pages say, without a word of HTML.

use apex_dsl::ide::{ParamFacts, PortFacts};
use std::{
    collections::BTreeMap,
    path::{Path, PathBuf},
};

/// Texts and the nodes that they use.
pub struct Book {
    /// The texts, by their paths.
    pub texts: Vec<Text>,
    /// The nodes in Rust, by their modules.
    pub nodes: Vec<Item>,
}

/// What tells a declaration from all others. A text has no line and no name.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct Key {
    /// Its file.
    pub file: PathBuf,
    /// The line of its name, from 1.
    pub line: usize,
    /// Its name.
    pub name: String,
}

/// A text.
pub struct Text {
    /// What it is.
    pub key: Key,
    /// Its path, as pages show it.
    pub path: String,
    /// Documentation.
    pub docs: String,
    /// Graphs, robots and state machines, in its order.
    pub items: Vec<Item>,
    /// Tests, in its order.
    pub tests: Vec<Test>,
}

/// A graph, a robot, a state machine or a node in Rust.
pub struct Item {
    /// What it is.
    pub key: Key,
    /// `graph`, `robot`, `fsm` or `node`.
    pub word: &'static str,
    /// The text or the module that it stands in.
    pub module: String,
    /// The path by which texts import it, if it is in Rust.
    pub import: Option<String>,
    /// File and line, if others than the author know the file by that name.
    pub place: Option<String>,
    /// Documentation.
    pub docs: String,
    /// Name, parameters and ports as a text would declare them, if it is in Rust.
    pub signature: Option<String>,
    /// Its parameters.
    pub params: Vec<ParamFacts>,
    /// Its ports.
    pub ports: Vec<PortFacts>,
    /// Pictures of it.
    pub pictures: Vec<Picture>,
    /// The nodes of a graph.
    pub nodes: Vec<Use>,
    /// The states of a machine.
    pub states: Vec<State>,
    /// What a graph claims.
    pub claims: Vec<Claim>,
    /// All of it in the text.
    pub code: Option<String>,
}

/// A picture.
pub struct Picture {
    /// What it shows.
    pub title: &'static str,
    /// SVG, or the number of boxes that are too many.
    pub svg: Result<String, usize>,
}

/// A node of a graph.
pub struct Use {
    /// Its name; none if it is written in place.
    pub name: Option<String>,
    /// What it is made of, as written.
    pub ty: String,
    /// What that is.
    pub of: Option<Key>,
    /// It is made in Rust and handed in.
    pub handed_in: bool,
    /// Arguments and modifiers, as written.
    pub given: Vec<String>,
    /// Documentation.
    pub docs: String,
}

/// A state.
pub struct State {
    /// Its name behind those of the states around it.
    pub path: String,
    /// Documentation.
    pub docs: String,
}

/// A claim.
pub struct Claim {
    /// As written.
    pub text: String,
    /// What is known about it.
    pub verdict: Option<&'static str>,
}

/// A test.
pub struct Test {
    /// Its name.
    pub name: String,
    /// The graph that is tested, as written.
    pub graph: String,
    /// What that is.
    pub of: Option<Key>,
    /// Documentation.
    pub docs: String,
    /// All of it in the text.
    pub code: String,
}

/// Where the texts are.
pub struct Files {
    /// The folder that all of them are in.
    pub base: PathBuf,
    /// From the paths under which they were read to those that tell them apart.
    pub real: BTreeMap<PathBuf, PathBuf>,
}

impl Files {
    /// The path that tells a file from all others.
    pub fn real(&self, path: &Path) -> PathBuf {
        self.real.get(path).cloned().unwrap_or_else(|| path.to_owned())
    }

    /// A path as pages show it: the same on all machines.
    pub fn shown(&self, real: &Path) -> String {
        let path = real.strip_prefix(&self.base).ok().or_else(|| real.file_name().map(Path::new)).unwrap_or(real);
        let parts: Vec<_> = path.components().map(|part| part.as_os_str().to_string_lossy()).collect();
        parts.join("/")
    }
}

impl Book {
    /// All items with pages of their own.
    pub fn items(&self) -> impl Iterator<Item = &Item> {
        self.texts.iter().flat_map(|text| &text.items).chain(&self.nodes)
    }
}
