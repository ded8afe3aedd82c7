//! Which texts belong to a program, and what the names in each of them mean.

use crate::{
    catalog::{Catalog, DefId, SignatureId, Ty, Type},
    machine,
    report::{Diagnostic, Diagnostics, nearest},
    source::{FileId, Sources, Span, World},
    syntax::{
        self,
        tree::{File, GraphItem, Ident, PathExpr, PortItem, TypeExpr, TypeKind},
    },
};
use std::{
    collections::{BTreeMap, BTreeSet},
    path::PathBuf,
};

use super::value::Scope;

/// More texts than one program is made of.
const MAX_FILES: usize = 256;

/// A graph, by text and number.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct GraphId {
    /// Index in [`Texts::files`].
    pub file: usize,
    /// Index in [`File::graphs`].
    pub graph: usize,
}

/// The texts of a program with their names.
pub struct Texts {
    /// The texts; the first is the one that was asked for.
    pub files: Vec<(FileId, File)>,
    names: Vec<BTreeMap<String, Meaning>>,
    /// The state machines of each text, as nodes of the catalog.
    machines: Vec<Vec<SignatureId>>,
    unreadable: BTreeSet<PathBuf>,
}

/// What a name in a text means.
#[derive(Debug, Clone)]
pub enum Meaning {
    /// A graph.
    Graph(GraphId),
    /// A state machine.
    Machine(SignatureId),
    /// Something in Rust, by its full path.
    Rust(Vec<String>),
}

/// What an instance is made of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Made {
    /// A nested graph.
    Graph(GraphId),
    /// A node of the catalog.
    Node(SignatureId),
}

impl Texts {
    /// Parses `root` and all texts that it imports from.
    pub fn load(
        root: FileId,
        catalog: &mut Catalog,
        sources: &mut Sources,
        world: &mut dyn World,
        diagnostics: &mut Diagnostics,
    ) -> Self {
        let mut texts = Self { files: vec![], names: vec![], machines: vec![], unreadable: BTreeSet::new() };
        let tree = syntax::parse(root, &sources.get(root).text.clone(), diagnostics);
        texts.files.push((root, tree));
        let mut at = 0;
        while at < texts.files.len() {
            texts.imports(at, catalog, sources, world, diagnostics);
            at += 1;
        }
        // A machine has a number before anybody can name it, and is known only after its types can be named.
        for file in 0..texts.files.len() {
            let count = texts.files[file].1.machines.len();
            let first = catalog.reserve_machines(count);
            texts.machines.push((first..first + count).collect());
        }
        for file in 0..texts.files.len() {
            let names = texts.names_of(file, catalog, sources, diagnostics);
            texts.names.push(names);
        }
        for file in 0..texts.files.len() {
            texts.resolve_machines(file, catalog, sources, diagnostics);
        }
        texts
    }

    fn resolve_machines(&self, file: usize, catalog: &mut Catalog, sources: &Sources, diagnostics: &mut Diagnostics) {
        let (file_id, tree) = &self.files[file];
        for (item, &signature) in tree.machines.iter().zip(&self.machines[file]) {
            let rust_path = |path: &PathExpr| self.rust_path(file, path);
            let scope = Scope { params: &BTreeMap::new(), rust_path: &rust_path };
            let ty = |port: &PortItem| match &port.ty {
                Some(ty) => catalog.type_in_text(&self.ty(file, ty), &[]),
                None => Type::unit(),
            };
            if let Some(machine) = machine::resolve(item, &ty, &scope, diagnostics) {
                let place = (sources.get(*file_id).path.clone(), sources.line_column(*file_id, item.name.span.start).0);
                catalog.add_machine(signature, machine, place);
            }
        }
    }

    /// Reads the sibling texts that text `at` imports from.
    fn imports(
        &mut self,
        at: usize,
        catalog: &Catalog,
        sources: &mut Sources,
        world: &mut dyn World,
        diagnostics: &mut Diagnostics,
    ) {
        let folder = sources.get(self.files[at].0).path.parent().map(std::path::Path::to_owned).unwrap_or_default();
        let modules: Vec<Ident> = self.files[at]
            .1
            .uses
            .iter()
            .filter(|u| u.path.len() == 2 && !catalog.is_crate(&u.path[0].text))
            .map(|u| u.path[0].clone())
            .collect();
        for module in modules {
            let path = folder.join(format!("{}.afg", module.text));
            if sources.find(&path).is_some() || !world.exists(&path) {
                continue;
            }
            if self.files.len() >= MAX_FILES {
                diagnostics.push(Diagnostic::error(
                    "too-large",
                    module.span,
                    format!("a program has at most {MAX_FILES} texts"),
                ));
                return;
            }
            match world.read(&path) {
                Ok(text) => {
                    let file = sources.add(path, text.clone());
                    self.files.push((file, syntax::parse(file, &text, diagnostics)));
                }
                Err(reason) => {
                    let message = format!("cannot read `{}.afg`: {reason}", module.text);
                    diagnostics.push(Diagnostic::error("unreadable", module.span, message));
                    self.unreadable.insert(path);
                }
            }
        }
    }

    fn names_of(
        &self,
        file: usize,
        catalog: &Catalog,
        sources: &Sources,
        diagnostics: &mut Diagnostics,
    ) -> BTreeMap<String, Meaning> {
        let mut names: BTreeMap<String, Meaning> = BTreeMap::new();
        let mut places: BTreeMap<String, &Ident> = BTreeMap::new();
        let tree = &self.files[file].1;
        let imports = tree
            .uses
            .iter()
            .filter_map(|u| Some((&u.name, self.import(file, &u.path, catalog, sources, diagnostics)?)));
        let imports: Vec<(&Ident, Meaning)> = imports.collect();
        let graphs =
            tree.graphs.iter().enumerate().map(|(graph, item)| (&item.name, Meaning::Graph(GraphId { file, graph })));
        let machines = tree.machines.iter().zip(&self.machines[file]);
        let machines = machines.map(|(item, signature)| (&item.name, Meaning::Machine(*signature)));
        for (name, meaning) in imports.into_iter().chain(graphs).chain(machines) {
            if let Some(first) = places.insert(name.text.clone(), name) {
                let message = format!("`{}` is already defined here", name.text);
                diagnostics.push(
                    Diagnostic::error("duplicate-name", name.span, message).also(first.span, "first defined here"),
                );
            }
            names.insert(name.text.clone(), meaning);
        }
        names
    }

    fn import(
        &self,
        file: usize,
        path: &[Ident],
        catalog: &Catalog,
        sources: &Sources,
        diagnostics: &mut Diagnostics,
    ) -> Option<Meaning> {
        let words: Vec<String> = path.iter().map(|s| s.text.clone()).collect();
        let (first, last) = (path.first()?, path.last()?);
        if catalog.is_crate(&first.text) {
            if catalog.nodes(&words).is_empty() && catalog.types(&words).is_empty() {
                diagnostics.push(unknown_import(&words, last, catalog));
                return None;
            }
            return Some(Meaning::Rust(words));
        }
        if catalog.is_extern(&first.text) {
            return Some(Meaning::Rust(words));
        }
        let sibling = sources.get(self.files[file].0).path.parent().map(|p| p.join(format!("{}.afg", first.text)))?;
        if self.unreadable.contains(&sibling) {
            return None;
        }
        let found = self.files.iter().position(|(id, _)| sources.get(*id).path == sibling).filter(|_| path.len() == 2);
        let Some(other) = found else {
            let message = format!("there is no crate and no text `{}`", first.text);
            let diagnostic = Diagnostic::error("unknown-import", first.span, message)
                .note(format!("an import names a crate that depends on `apex-rt`, `crate` for this package, or a text beside this one (`{}.afg`)", first.text));
            diagnostics.push(diagnostic);
            return None;
        };
        let machines = &self.files[other].1.machines;
        if let Some(machine) = machines.iter().position(|m| m.name.text == last.text) {
            return Some(Meaning::Machine(self.machines[other][machine]));
        }
        let graphs = &self.files[other].1.graphs;
        let graph = graphs.iter().position(|g| g.name.text == last.text);
        if graph.is_none() && !self.files[other].1.broken {
            let message = format!("`{}.afg` has no graph `{}`", first.text, last.text);
            diagnostics.push(suggest(
                Diagnostic::error("unknown-import", last.span, message),
                last,
                graphs.iter().map(|g| g.name.text.as_str()),
            ));
        }
        Some(Meaning::Graph(GraphId { file: other, graph: graph? }))
    }

    /// Whether one of them has statements or items that could not be read.
    pub fn are_broken(&self) -> bool {
        self.files.iter().any(|(_, file)| file.broken)
    }

    /// The graph with this number.
    pub fn graph(&self, id: GraphId) -> &GraphItem {
        &self.files[id.file].1.graphs[id.graph]
    }

    /// The names that text `file` declares and imports, but for those in its graphs.
    pub fn names(&self, file: usize) -> &BTreeMap<String, Meaning> {
        &self.names[file]
    }

    /// The text and the number in it of a state machine.
    pub fn machine(&self, signature: SignatureId) -> Option<(usize, usize)> {
        let find = |machines: &Vec<SignatureId>| machines.iter().position(|m| *m == signature);
        self.machines.iter().enumerate().find_map(|(file, machines)| Some((file, find(machines)?)))
    }

    /// The number of a text.
    pub fn file_id(&self, file: usize) -> FileId {
        self.files[file].0
    }

    /// A path in text `file` with what its first word was imported as.
    pub fn full_path(&self, file: usize, path: &PathExpr) -> Vec<String> {
        let words: Vec<String> = path.segments.iter().map(|s| s.text.clone()).collect();
        match words.first().and_then(|first| self.names[file].get(first)) {
            Some(Meaning::Rust(full)) => full.iter().chain(&words[1..]).cloned().collect(),
            _ => words,
        }
    }

    /// What stands behind the path of an instance.
    pub fn made(&self, file: usize, path: &PathExpr, catalog: &Catalog) -> Result<Made, Box<Diagnostic>> {
        if let [name] = path.segments.as_slice() {
            match self.names[file].get(&name.text) {
                Some(Meaning::Graph(id)) => return Ok(Made::Graph(*id)),
                Some(Meaning::Machine(id)) => return Ok(Made::Node(*id)),
                _ => {}
            }
        }
        let full = self.full_path(file, path);
        match catalog.nodes(&full).as_slice() {
            [one] => Ok(Made::Node(*one)),
            [] => Err(Box::new(self.unknown_node(file, path, &full, catalog))),
            several => {
                let message = format!("`{}` is the name of several nodes", path.text());
                let error =
                    several.iter().fold(Diagnostic::error("ambiguous-node", path.span, message), |error, id| {
                        let signature = &catalog.signatures[*id];
                        error.note(format!(
                            "`{}`, declared at {}:{}",
                            signature.path.join("::"),
                            signature.file.display(),
                            signature.line
                        ))
                    });
                Err(Box::new(error.note("import the one that is meant: `use path::Name;`")))
            }
        }
    }

    fn unknown_node(&self, file: usize, path: &PathExpr, full: &[String], catalog: &Catalog) -> Diagnostic {
        let Some(last) = path.segments.last() else {
            return Diagnostic::error("unknown-node", path.span, "a node or graph is missing here");
        };
        let message = format!("there is no node or graph `{}`", path.text());
        let mut error = Diagnostic::error("unknown-node", path.span, message);
        if !catalog.types(full).is_empty() {
            return error.note(format!("`{}` is a type, but not marked `#[node]`", path.text()));
        }
        let in_text = self.names[file].keys().map(String::as_str);
        let own =
            catalog.signatures.iter().filter(|s| s.path.first().is_some_and(|p| p == "crate")).map(|s| s.name.as_str());
        let elsewhere: Vec<&_> = catalog.signatures.iter().filter(|s| s.name == last.text).collect();
        if !elsewhere.is_empty() {
            return elsewhere.iter().take(4).fold(error, |error, signature| {
                if signature.path.is_empty() {
                    let place = format!("{}:{}", signature.file.display(), signature.line);
                    return error
                        .note(format!("the one at {place} cannot be named here: it needs `pub` and a `pub use`"));
                }
                let import = signature.path.join("::");
                let import = import.trim_start_matches("::");
                let at = self.files[file].1.imports_at.unwrap_or_default();
                let (title, at) = (format!("import `{import}`"), Span::new(self.files[file].0, at, at));
                let text = format!("use {import};\n");
                if elsewhere.len() == 1 { error.fix(title, at, text) } else { error.guess(title, at, text) }
            });
        }
        error = suggest(error, last, in_text.chain(own));
        if error.fixes.is_empty() {
            let all = catalog.signatures.iter().map(|s| s.name.as_str());
            if let Some(near) = nearest(&last.text, all) {
                error = error.note(format!("there is a node with a similar name, `{near}`, that is not imported here"));
            }
        }
        error = catalog.broken().fold(error, Diagnostic::note);
        for hidden in catalog.hidden() {
            error = error.note(format!(
                "a macro in {} makes nodes that the compiler cannot see; write `#[node]` outside of macros",
                hidden.display()
            ));
        }
        error
    }

    /// A type as written in a text, for the catalog, and spelled for generated code.
    pub fn ty(&self, file: usize, ty: &TypeExpr) -> Ty {
        match &ty.kind {
            TypeKind::Path(path, args) => {
                Ty::Path(self.full_path(file, path), args.iter().map(|a| self.ty(file, a)).collect())
            }
            TypeKind::Array(element, len) => Ty::Array(Box::new(self.ty(file, element)), len.clone()),
            TypeKind::Tuple(parts) => Ty::Tuple(parts.iter().map(|p| self.ty(file, p)).collect()),
            TypeKind::Const(number) => Ty::Other(number.clone()),
        }
    }

    /// The path of a constant of Rust.
    pub fn rust_path(&self, file: usize, path: &PathExpr) -> Option<Vec<String>> {
        let known =
            path.segments.first().is_some_and(|s| matches!(self.names[file].get(&s.text), Some(Meaning::Rust(_))));
        (known || path.segments.len() > 1).then(|| self.full_path(file, path))
    }
}

/// Adds the nearest of `candidates` as a fix for `word`.
pub fn suggest<'a>(error: Diagnostic, word: &Ident, candidates: impl Iterator<Item = &'a str>) -> Diagnostic {
    match nearest(&word.text, candidates) {
        Some(near) => error.guess(format!("did you mean `{near}`?"), word.span, near),
        None => error,
    }
}

fn unknown_import(words: &[String], last: &Ident, catalog: &Catalog) -> Diagnostic {
    let parent = &words[..words.len() - 1];
    let message = format!("`{}` has no node or type `{}`", parent.join("::"), last.text);
    let mut error =
        suggest(Diagnostic::error("unknown-import", last.span, message), last, catalog.names_in(parent).into_iter());
    let elsewhere: Vec<DefId> = catalog.find(&last.text);
    for def in elsewhere.into_iter().filter_map(|def| catalog.path(def)).take(3) {
        error = error.note(format!("there is `{}`", def.join("::").trim_start_matches("::")));
    }
    let names: Vec<&str> = words.iter().map(String::as_str).collect();
    error = catalog.left_out(&names[1..]).into_iter().fold(error, Diagnostic::note);
    catalog.broken().fold(error, Diagnostic::note)
}
