//! Source files of a program, and the meaning of the names in each of them.

use super::suggest::{Known, everywhere, unknown};
use crate::{
    catalog::{Catalog, Constant, Signature, SignatureId, Ty},
    machine::{Machine, Machines},
    report::{Diagnostic, nearest},
    source::{FileId, Span},
    syntax::tree::{File, GraphItem, PathExpr, TypeExpr, TypeKind},
};
use std::{
    collections::{BTreeMap, BTreeSet},
    path::PathBuf,
};

/// A graph, by source file and number.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct GraphId {
    /// Index in [`SourceSet::files`].
    pub file: usize,
    /// Index in [`File::graphs`].
    pub graph: usize,
}

/// The source files of a program, with their names.
pub struct SourceSet {
    /// The source files. The first one is the one that was given to the compiler.
    pub files: Vec<(FileId, File)>,
    pub(super) names: Vec<BTreeMap<String, Resolution>>,
    /// The state machines.
    pub machines: Machines,
    /// The catalog nodes of the state machines in each source file.
    pub(super) machine_nodes: Vec<Vec<SignatureId>>,
    pub(super) variants: BTreeMap<GraphId, Variant>,
    pub(super) unreadable: BTreeSet<PathBuf>,
    /// The names in each source file with no meaning or several meanings, which has been reported.
    pub(super) unclear: Vec<BTreeSet<String>>,
}

/// Meaning of a name in a source file.
#[derive(Debug, Clone)]
pub enum Resolution {
    /// A graph.
    Graph(GraphId),
    /// A state machine.
    Machine(SignatureId),
    /// An item of Rust, by its full path.
    Rust(Vec<String>),
}

/// Constructor of an instance.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Constructor {
    /// A nested graph.
    Graph(GraphId),
    /// A node of the catalog.
    Node(SignatureId),
}

impl SourceSet {
    /// Returns `true` if a source file contains statements or items that could not be read.
    pub fn are_broken(&self) -> bool {
        self.files.iter().any(|(_, file)| file.broken)
    }

    /// The numbers of the graphs in source file `file`.
    pub fn graph_ids(&self, file: usize) -> impl Iterator<Item = GraphId> + use<> {
        (0..self.files[file].1.graphs.len()).map(move |graph| GraphId { file, graph })
    }

    /// The graph with this number, with all statements of a variant.
    pub fn graph(&self, id: GraphId) -> &GraphItem {
        self.variants.get(&id).map_or_else(|| self.written(id), |variant| &variant.item)
    }

    /// The graph with this number as written: a variant without the statements of its base.
    pub fn written(&self, id: GraphId) -> &GraphItem {
        &self.files[id.file].1.graphs[id.graph]
    }

    /// The variant with this number, if the graph is one.
    pub fn variant(&self, id: GraphId) -> Option<&Variant> {
        self.variants.get(&id)
    }

    /// The names that source file `file` declares and imports, except those inside its graphs.
    pub fn names(&self, file: usize) -> &BTreeMap<String, Resolution> {
        &self.names[file]
    }

    /// The state machine with the name `name` in source file `file`.
    pub fn machine_named(&self, file: usize, name: &str) -> Option<&Machine> {
        match self.names(file).get(name)? {
            Resolution::Machine(signature) => self.machines.get(signature),
            _ => None,
        }
    }

    /// The source file of a state machine, and its number there.
    pub fn machine(&self, signature: SignatureId) -> Option<(usize, usize)> {
        // The machines of one source file have consecutive numbers.
        let find = |machines: &Vec<SignatureId>| machines.binary_search(&signature).ok();
        self.machine_nodes.iter().enumerate().find_map(|(file, machines)| Some((file, find(machines)?)))
    }

    /// The number of a source file.
    pub fn file_id(&self, file: usize) -> FileId {
        self.files[file].0
    }

    /// Index of the source file in which a path or type is written. Names have their meaning there.
    pub fn file_of(&self, span: Span) -> usize {
        self.files.iter().position(|(id, _)| *id == span.file).unwrap_or(0)
    }

    /// A path with its first segment replaced by its import.
    pub fn full_path(&self, path: &PathExpr) -> Vec<String> {
        let file = self.file_of(path.span);
        let words: Vec<String> = path.segments.iter().map(|s| s.text.clone()).collect();
        match words.first().and_then(|first| self.names[file].get(first)) {
            Some(Resolution::Rust(full)) => full.iter().chain(&words[1..]).cloned().collect(),
            _ => words,
        }
    }

    /// Returns `true` if the meaning of a path is unclear, which has been reported.
    pub fn is_unclear(&self, path: &PathExpr) -> bool {
        let file = self.file_of(path.span);
        path.segments.first().is_some_and(|first| self.unclear[file].contains(&first.text))
    }

    /// The constructor that the path of an instance names. The error is `None` if the reason has been reported.
    pub fn made(&self, path: &PathExpr, catalog: &Catalog) -> Result<Constructor, Option<Box<Diagnostic>>> {
        if self.is_unclear(path) {
            return Err(None);
        }
        let file = self.file_of(path.span);
        if let [name] = path.segments.as_slice() {
            match self.names[file].get(&name.text) {
                Some(Resolution::Graph(id)) => return Ok(Constructor::Graph(*id)),
                Some(Resolution::Machine(id)) => return Ok(Constructor::Node(*id)),
                _ => {}
            }
        }
        let full = self.full_path(path);
        match catalog.nodes(&full).as_slice() {
            [one] if catalog.signatures[*one].path.is_empty() => {
                Err(Some(Box::new(hidden_node(path, &catalog.signatures[*one]))))
            }
            [one] => Ok(Constructor::Node(*one)),
            [] => Err(Some(Box::new(self.unknown_node(file, path, &full, catalog)))),
            several => {
                let message = format!("`{}` is the name of several nodes", path.text());
                let error =
                    several.iter().fold(Diagnostic::error("ambiguous-node", path.span, message), |error, id| {
                        let signature = &catalog.signatures[*id];
                        error.note(format!(
                            "`{}`, declared at {}:{}",
                            catalog.written(&signature.path).join("::"),
                            signature.file.display(),
                            signature.line
                        ))
                    });
                Err(Some(Box::new(error.note("import the one that is meant: `use path::Name;`"))))
            }
        }
    }

    fn unknown_node(&self, file: usize, path: &PathExpr, full: &[String], catalog: &Catalog) -> Diagnostic {
        let Some(last) = path.segments.last() else {
            return Diagnostic::error("unknown-node", path.span, "a node or graph is missing here");
        };
        if let Some((reason, file, line)) = catalog.refused(&last.text) {
            let message = format!("`{}` is marked `#[node]`, but is not a node", path.text());
            let error = Diagnostic::error("unknown-node", path.span, message);
            return error.note(format!("declared at {}:{line}: {reason}", file.display()));
        }
        let message = format!("there is no node or graph `{}`", path.text());
        let uses = self.uses_of(file, path);
        // An unknown name is reported once, however often it is used.
        let mut error = everywhere("unknown-node", message.clone(), path.span, &uses);
        if !catalog.types(full).is_empty() {
            return error.note(format!("`{}` is a type, but not marked `#[node]`", path.text()));
        }
        let in_text = self.names[file].keys().map(String::as_str);
        let own = catalog
            .signatures
            .iter()
            .filter(|s| catalog.written(&s.path).first().is_some_and(|p| p == "crate"))
            .map(|s| s.name.as_str());
        let elsewhere: Vec<&_> = catalog.signatures.iter().filter(|s| s.name == last.text).collect();
        if !elsewhere.is_empty() {
            return elsewhere.iter().take(4).fold(error, |error, signature| {
                if signature.path.is_empty() {
                    let place = format!("{}:{}", signature.file.display(), signature.line);
                    return error.note(format!(
                        "the node at {place} is not accessible from here: it needs `pub` and a `pub use`"
                    ));
                }
                let import = catalog.written(&signature.path).join("::");
                let import = import.trim_start_matches("::");
                let at = self.files[file].1.imports_at.unwrap_or_default();
                let (title, at) = (format!("import `{import}`"), Span::new(self.files[file].0, at, at));
                let text = format!("use {import};\n");
                if elsewhere.len() == 1 { error.fix(title, at, text) } else { error.guess(title, at, text) }
            });
        }
        let used = self.paths(file).filter_map(|path| path.segments.first()).map(|name| name.text.as_str()).collect();
        // A graph does not contain itself.
        let around = self.files[file].1.graphs.iter().find(|graph| graph.extent.contains(path.span));
        let in_text = in_text.filter(|name| around.is_none_or(|graph| graph.name.text != *name));
        let known = in_text.map(|name| self.known(file, name, &used)).chain(own.map(Known::elsewhere));
        let known: Vec<Known<'_>> = known.collect();
        if let Some(misspelt) = unknown("unknown-node", message, last, &uses, &known) {
            error = misspelt;
        } else {
            let all = catalog.signatures.iter().map(|s| s.name.as_str());
            if let Some(near) = nearest(&last.text, all) {
                error = error.note(format!("there is a node with a similar name, `{near}`, that is not imported here"));
            } else {
                error =
                    error.note(format!("`apex nodes {}` searches all nodes for the word", last.text.to_lowercase()));
            }
        }
        error = catalog.broken().fold(error, Diagnostic::note);
        for hidden in catalog.hidden() {
            error = error.note(format!(
                "a macro in {} generates nodes that the compiler cannot see; write `#[node]` outside of macros",
                hidden.display()
            ));
        }
        error
    }

    /// A name of source file `file` that an instance may mean. `used` are the names that instances use.
    fn known<'a>(&'a self, file: usize, name: &'a str, used: &BTreeSet<&str>) -> Known<'a> {
        let tree = &self.files[file].1;
        let declared = match self.names[file].get(name) {
            Some(Resolution::Graph(id)) if id.file == file => Some(self.graph(*id).name.span),
            Some(Resolution::Machine(_)) => tree.machines.iter().find(|m| m.name.text == name).map(|m| m.name.span),
            _ => None,
        };
        Known { name, declared, used: used.contains(name) }
    }

    /// The places in source file `file` where a node or graph is written as `path`.
    fn uses_of(&self, file: usize, path: &PathExpr) -> Vec<Span> {
        let text = path.text();
        let mut uses: Vec<Span> = self.paths(file).filter(|p| p.text() == text).map(|p| p.span).collect();
        if !uses.contains(&path.span) {
            uses.push(path.span);
        }
        uses.sort_unstable();
        uses
    }

    /// The paths of all nodes and graphs that source file `file` uses.
    fn paths(&self, file: usize) -> impl Iterator<Item = &PathExpr> {
        let tree = &self.files[file].1;
        let instances = tree.graphs.iter().flat_map(|graph| graph.instances());
        // A name and a value may be a port.
        let of_instances = instances.filter(|instance| instance.as_given().is_none()).map(|instance| &instance.path);
        let of_variants = tree.graphs.iter().filter_map(|graph| graph.base.as_ref());
        of_instances.chain(of_variants).chain(tree.tests.iter().map(|test| &test.graph))
    }

    /// A type as written, for the catalog and for generated code.
    pub fn ty(&self, ty: &TypeExpr) -> Ty {
        match &ty.kind {
            TypeKind::Path(path, args) => Ty::Path(self.full_path(path), args.iter().map(|a| self.ty(a)).collect()),
            TypeKind::Array(element, len) => Ty::Array(Box::new(self.ty(element)), len.clone()),
            TypeKind::Tuple(parts) => Ty::Tuple(parts.iter().map(|p| self.ty(p)).collect()),
            TypeKind::Measured(number, unit) => Ty::Measured(Box::new(self.ty(number)), unit.text.clone()),
            TypeKind::Const(number) => Ty::Other(number.clone()),
        }
    }

    /// The names that the source file of a place declares and imports.
    pub fn imported(&self, at: Span) -> impl Iterator<Item = &str> {
        self.names[self.file_of(at)].keys().map(String::as_str)
    }

    /// The constant of Rust that a path names; `None` for a name of the source file itself.
    pub fn constant(&self, path: &PathExpr, catalog: &Catalog) -> Option<Constant> {
        let file = self.file_of(path.span);
        let known =
            path.segments.first().is_some_and(|s| matches!(self.names[file].get(&s.text), Some(Resolution::Rust(_))));
        (known || path.segments.len() > 1).then(|| catalog.constant(&self.full_path(path)))
    }
}

/// Error about a node that generated code cannot name.
fn hidden_node(path: &PathExpr, signature: &Signature) -> Diagnostic {
    let message = format!("the node `{}` is not accessible from the program", path.text());
    let (file, line) = (signature.file.display(), signature.line);
    Diagnostic::error("unknown-node", path.span, message)
        .note(format!("declared at {file}:{line}; it needs `pub`, and so do the modules around it, or a `pub use`"))
}

/// A variant of a graph.
#[derive(Debug)]
pub struct Variant {
    /// The graph that it is a variant of; `None` if there is none, which has been reported.
    pub base: Option<GraphId>,
    /// All of its statements: those of the base, then its own. Each keeps its place, which may be in another source
    /// file, where its names have their meaning.
    pub item: GraphItem,
    /// The nodes of the base that are exchanged, with the places of their names in the variant.
    pub exchanged: BTreeMap<String, Span>,
}
