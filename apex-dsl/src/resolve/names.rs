//! Source files of a program, and the meaning of the names in each of them.

use crate::{
    catalog::{Catalog, Constant, DefId, Signature, SignatureId, Ty, Type},
    machine::{Machine, Machines},
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

use super::{
    unknown::{Known, everywhere, unknown},
    value::{RustNames, Scope},
    variants::{self, Variant},
};

/// Largest number of source files of a program.
const MAX_FILES: usize = 256;

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
    names: Vec<BTreeMap<String, Resolution>>,
    /// The state machines.
    pub machines: Machines,
    /// The catalog nodes of the state machines in each source file.
    machine_nodes: Vec<Vec<SignatureId>>,
    variants: BTreeMap<GraphId, Variant>,
    unreadable: BTreeSet<PathBuf>,
    /// The names in each source file with no meaning or several meanings, which has been reported.
    unclear: Vec<BTreeSet<String>>,
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
    /// Parses `root` and all source files that it imports.
    pub fn load(
        root: FileId,
        catalog: &mut Catalog,
        sources: &mut Sources,
        world: &mut dyn World,
        diagnostics: &mut Diagnostics,
    ) -> Self {
        let (files, names, machine_nodes, unclear) = (vec![], vec![], vec![], vec![]);
        let (machines, variants, unreadable) = (Machines::new(), BTreeMap::new(), BTreeSet::new());
        let mut texts = Self { files, names, machines, machine_nodes, variants, unreadable, unclear };
        texts.parse(root, &sources.get(root).text.clone(), diagnostics);
        let mut at = 0;
        while at < texts.files.len() {
            texts.imports(at, catalog, sources, world, diagnostics);
            at += 1;
        }
        // Machines get their numbers before names are resolved. Their contents follow later, because they use names of
        // types.
        for file in 0..texts.files.len() {
            let count = texts.files[file].1.machines.len();
            texts.machine_nodes.push(catalog.reserve_machines(count));
        }
        for file in 0..texts.files.len() {
            let (names, unclear) = texts.names_of(file, catalog, sources, diagnostics);
            texts.names.push(names);
            texts.unclear.push(unclear);
        }
        for file in 0..texts.files.len() {
            texts.resolve_machines(file, catalog, sources, diagnostics);
        }
        texts.variants = variants::variants(&texts, catalog, diagnostics);
        texts
    }

    fn parse(&mut self, file: FileId, text: &str, diagnostics: &mut Diagnostics) {
        let tree = syntax::parse(file, text, diagnostics);
        diagnostics.add_items(tree.extents());
        self.files.push((file, tree));
    }

    fn resolve_machines(
        &mut self,
        file: usize,
        catalog: &mut Catalog,
        sources: &Sources,
        diagnostics: &mut Diagnostics,
    ) {
        let mut machines = vec![];
        let (file_id, tree) = &self.files[file];
        for (item, &signature) in tree.machines.iter().zip(&self.machine_nodes[file]) {
            let scope = Scope { params: &BTreeMap::new(), rust: RustNames { texts: self, catalog } };
            let ty = |port: &PortItem| match &port.ty {
                Some(ty) => catalog.type_in_text(&self.ty(ty), &[]),
                None => Type::unit(),
            };
            if let Some(machine) = super::machine::resolve(item, &ty, &scope, diagnostics) {
                let place = (sources.get(*file_id).path.clone(), sources.line_column(*file_id, item.name.span.start).0);
                // Machines of two source files may have the same name.
                let number = if file == 0 { String::new() } else { file.to_string() };
                let module = format!("fsm{number}_{}", machine.name);
                let machine = Machine { module, is_own: file == 0, ..machine };
                catalog.add_machine(signature, machine.signature(place));
                machines.push((signature, machine));
            }
        }
        self.machines.extend(machines);
    }

    /// Reads the sibling files that source file `at` imports.
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
                    format!("a program has at most {MAX_FILES} source files"),
                ));
                return;
            }
            match world.read(&path) {
                Ok(text) => {
                    let file = sources.add(path, text.clone());
                    self.parse(file, &text, diagnostics);
                }
                Err(reason) => {
                    let message = format!("cannot read `{}.afg`: {reason}", module.text);
                    diagnostics.push(Diagnostic::error("unreadable", module.span, message));
                    self.unreadable.insert(path);
                }
            }
        }
    }

    /// The names that source file `file` declares and imports, and the unclear ones among them.
    fn names_of(
        &self,
        file: usize,
        catalog: &Catalog,
        sources: &Sources,
        diagnostics: &mut Diagnostics,
    ) -> (BTreeMap<String, Resolution>, BTreeSet<String>) {
        let mut names: BTreeMap<String, Resolution> = BTreeMap::new();
        let mut unclear = BTreeSet::new();
        let mut places: BTreeMap<String, &Ident> = BTreeMap::new();
        let tree = &self.files[file].1;
        let mut imports: Vec<(&Ident, Resolution)> = vec![];
        for u in &tree.uses {
            match self.import(file, &u.path, catalog, sources) {
                Ok(meaning) => imports.push((&u.name, meaning)),
                Err(error) => {
                    unclear.insert(u.name.text.clone());
                    // If the import is misspelt, the name is presumably correct where it is used, or the other way
                    // round.
                    let meant = error.iter().flat_map(|error| &error.fixes).map(|fix| fix.replacement.clone());
                    unclear.extend(meant);
                    error.into_iter().for_each(|error| diagnostics.push(*error));
                }
            }
        }
        let graphs = tree
            .graphs
            .iter()
            .enumerate()
            .map(|(graph, item)| (&item.name, Resolution::Graph(GraphId { file, graph })));
        let machines = tree.machines.iter().zip(&self.machine_nodes[file]);
        let machines = machines.map(|(item, signature)| (&item.name, Resolution::Machine(*signature)));
        for (name, meaning) in imports.into_iter().chain(graphs).chain(machines) {
            if let Some(first) = places.insert(name.text.clone(), name) {
                let message = format!("`{}` is already defined here", name.text);
                diagnostics.push(
                    Diagnostic::error("duplicate-name", name.span, message).also(first.span, "first defined here"),
                );
                unclear.insert(name.text.clone());
            }
            names.insert(name.text.clone(), meaning);
        }
        (names, unclear)
    }

    /// Meaning of an import. The error is `None` if its cause is reported elsewhere.
    fn import(
        &self,
        file: usize,
        path: &[Ident],
        catalog: &Catalog,
        sources: &Sources,
    ) -> Result<Resolution, Option<Box<Diagnostic>>> {
        let words: Vec<String> = path.iter().map(|s| s.text.clone()).collect();
        let (Some(first), Some(last)) = (path.first(), path.last()) else { return Err(None) };
        if catalog.is_crate(&first.text) {
            let is_constant = || matches!(catalog.constant(&words), Constant::Known(..) | Constant::Hidden(_));
            // An item that is marked `#[node]` but is not a node is reported where it is used.
            let is_there =
                !catalog.nodes(&words).is_empty() || !catalog.types(&words).is_empty() || catalog.is_refused(&words);
            if !is_there && !is_constant() {
                let error = unknown_import(&words, last, catalog);
                let is_there = |other: &usize| first.text == "crate" && self.item(*other, last).is_some();
                return Err(Some(Box::new(match (0..self.files.len()).find(is_there) {
                    Some(own) if own == file => error.note("the graphs of this file need no import"),
                    Some(other) => {
                        let stem = sources.get(self.files[other].0).path.file_stem().unwrap_or_default();
                        let import = format!("use {}::{};", stem.to_string_lossy(), last.text);
                        error.note(format!("a graph is imported by its file: `{import}`"))
                    }
                    None => error,
                })));
            }
            return Ok(Resolution::Rust(words));
        }
        if catalog.is_extern(&first.text) {
            return Ok(Resolution::Rust(words));
        }
        let folder = sources.get(self.files[file].0).path.parent().map(std::path::Path::to_owned).unwrap_or_default();
        let sibling = folder.join(format!("{}.afg", first.text));
        if self.unreadable.contains(&sibling) {
            return Err(None);
        }
        let found = self.files.iter().position(|(id, _)| sources.get(*id).path == sibling).filter(|_| path.len() == 2);
        let Some(other) = found else { return Err(Some(Box::new(unknown_crate(first, catalog)))) };
        self.import_item(other, first, last)
    }

    /// The graph or state machine `name` of source file `file`.
    fn item(&self, file: usize, name: &Ident) -> Option<Resolution> {
        let tree = &self.files[file].1;
        if let Some(machine) = tree.machines.iter().position(|m| m.name.text == name.text) {
            return Some(Resolution::Machine(self.machine_nodes[file][machine]));
        }
        let graph = tree.graphs.iter().position(|g| g.name.text == name.text)?;
        Some(Resolution::Graph(GraphId { file, graph }))
    }

    /// The graph or state machine `name` of source file `other`, which is imported as `module`.
    fn import_item(&self, other: usize, module: &Ident, name: &Ident) -> Result<Resolution, Option<Box<Diagnostic>>> {
        if let Some(item) = self.item(other, name) {
            return Ok(item);
        }
        let tree = &self.files[other].1;
        if tree.broken {
            return Err(None);
        }
        let message = format!("`{}.afg` has no graph `{}`", module.text, name.text);
        let known = tree.graphs.iter().map(|g| &g.name).chain(tree.machines.iter().map(|m| &m.name));
        let error = Diagnostic::error("unknown-import", name.span, message);
        Err(Some(Box::new(suggest(error, name, known.map(|name| name.text.as_str())))))
    }

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

/// Adds the nearest of `candidates` as a fix for `word`.
pub fn suggest<'a>(error: Diagnostic, word: &Ident, candidates: impl Iterator<Item = &'a str>) -> Diagnostic {
    match nearest(&word.text, candidates) {
        Some(near) => error.guess(format!("did you mean `{near}`?"), word.span, near),
        None => error,
    }
}

/// Error about an import whose first segment is neither a crate nor a source file.
fn unknown_crate(first: &Ident, catalog: &Catalog) -> Diagnostic {
    let message = format!("there is no crate or source file `{}`", first.text);
    let name = &first.text;
    let note = format!(
        "an import names a crate on which the package depends (`cargo add {name}`), `crate` for this package, or a \
         source file in the same folder (`{name}.afg`)"
    );
    suggest(
        Diagnostic::error("unknown-import", first.span, message).note(note),
        first,
        catalog.crate_names().into_iter(),
    )
}

fn unknown_import(words: &[String], last: &Ident, catalog: &Catalog) -> Diagnostic {
    let parent = &words[..words.len() - 1];
    let message = format!("`{}` has no node or type `{}`", parent.join("::"), last.text);
    let mut error =
        suggest(Diagnostic::error("unknown-import", last.span, message), last, catalog.names_in(parent).into_iter());
    let elsewhere: Vec<DefId> = catalog.find(&last.text);
    for def in elsewhere.into_iter().filter_map(|def| catalog.path(def)).take(3) {
        error = error.note(format!("there is `{}`", catalog.written(def).join("::")));
    }
    let names: Vec<&str> = words.iter().map(String::as_str).collect();
    error = catalog.left_out(&names[1..]).into_iter().fold(error, Diagnostic::note);
    catalog.broken().fold(error, Diagnostic::note)
}
