//! Reading the source files of a program, and what each of them declares and imports.

use super::{
    machine,
    names::{GraphId, Resolution, SourceSet},
    scope::{RustNames, Scope},
    suggest::suggest,
    variants,
};
use crate::{
    catalog::{Catalog, Constant, DefId, Type},
    machine::{Machine, Machines},
    report::{Diagnostic, Diagnostics},
    source::{FileId, Sources, World},
    syntax::{
        self,
        tree::{Ident, PortItem},
    },
};
use std::collections::{BTreeMap, BTreeSet};

/// Largest number of source files of a program.
const MAX_FILES: usize = 256;

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
            if let Some(machine) = machine::resolve(item, &ty, &scope, diagnostics) {
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
