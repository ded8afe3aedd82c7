//! Checks of the types in source files: each is examined once, however often the graph around it is used.

use super::{names::SourceSet, suggest::suggest, value::declared_unit};
use crate::{
    catalog::{Catalog, DURATION, PRIMITIVES, STD, TIME, Type, is_path, library},
    report::{Diagnostic, Diagnostics},
    source::Span,
    syntax::tree::{Endpoint, GraphItem, Ident, Instance, NodeBody, PathExpr, TypeExpr, TypeKind},
};
use std::collections::BTreeSet;

/// Reports types in all source files that do not exist, that generated code cannot name, or that have a wrong number of
/// arguments.
pub fn check(texts: &SourceSet, catalog: &Catalog, diagnostics: &mut Diagnostics) {
    for file in 0..texts.files.len() {
        let tree = &texts.files[file].1;
        let mut missing = BTreeSet::new();
        for id in texts.graph_ids(file) {
            let generics: Vec<&str> = texts.graph(id).generics.iter().map(|g| g.text.as_str()).collect();
            let mut checker = Checker { texts, catalog, file, generics, missing: &mut missing, diagnostics };
            checker.graph(texts.written(id));
        }
        let mut checker = Checker { texts, catalog, file, generics: vec![], missing: &mut missing, diagnostics };
        let ports = tree.machines.iter().flat_map(|machine| &machine.ports);
        ports.filter_map(|port| port.ty.as_ref()).for_each(|ty| checker.token(ty));
        let replaced = tree.tests.iter().flat_map(|test| &test.replaced);
        replaced.for_each(|(_, instance)| checker.instance(instance));
    }
}

/// Error about a wrong number of type arguments for `path`.
pub fn wrong_count(path: &PathExpr, takes: usize, given: usize, span: Span) -> Diagnostic {
    let takes = match takes {
        0 => "no type arguments".to_owned(),
        1 => "one type argument".to_owned(),
        _ => format!("{takes} type arguments"),
    };
    Diagnostic::error("type-arguments", span, format!("`{}` takes {takes}, not {given}", path.text()))
}

/// The part of a type that has no size. Behind a pointer (`Box<[T]>`) it needs none.
fn unsized_part(ty: &TypeExpr) -> Option<Span> {
    match &ty.kind {
        TypeKind::Array(_, None) => Some(ty.span),
        TypeKind::Array(element, Some(_)) => unsized_part(element),
        TypeKind::Tuple(parts) => parts.iter().find_map(unsized_part),
        TypeKind::Path(..) | TypeKind::Const(_) | TypeKind::Measured(..) => None,
    }
}

struct Checker<'a> {
    texts: &'a SourceSet,
    catalog: &'a Catalog,
    file: usize,
    generics: Vec<&'a str>,
    /// Unknown types that have been reported.
    missing: &'a mut BTreeSet<String>,
    diagnostics: &'a mut Diagnostics,
}

impl Checker<'_> {
    fn graph(&mut self, graph: &GraphItem) {
        for (number, param) in graph.params.iter().enumerate() {
            if let Some(first) = graph.params[..number].iter().find(|other| other.name.text == param.name.text) {
                let message = format!("`{}` is already a parameter of this graph", param.name.text);
                let error = Diagnostic::error("duplicate-name", param.name.span, message);
                self.diagnostics.push(error.also(first.name.span, "first defined here"));
            }
        }
        graph.ports.iter().filter_map(|port| port.ty.as_ref()).for_each(|ty| self.token(ty));
        for frame in graph.ports.iter().filter_map(|port| port.frame.as_ref()).filter(|frame| frame.text.is_empty()) {
            self.diagnostics.push(Diagnostic::error("wrong-frame", frame.span, "a frame needs a name"));
        }
        graph.params.iter().for_each(|param| self.ty(&param.ty));
        for node in &graph.nodes {
            match &node.body {
                NodeBody::Instance(instance) => self.instance(instance),
                // The head of the type is the node itself.
                NodeBody::HandedIn(TypeExpr { kind: TypeKind::Path(_, args), .. }, _) => {
                    args.iter().for_each(|ty| self.argument(ty));
                }
                NodeBody::HandedIn(..) => {}
            }
        }
        graph.chains.iter().flat_map(|chain| &chain.ends).for_each(|end| self.end(end));
    }

    fn end(&mut self, end: &Endpoint) {
        match end {
            Endpoint::Instance(instance) => self.instance(instance),
            Endpoint::List(ends, _) => ends.iter().for_each(|end| self.end(end)),
            Endpoint::Port(..) | Endpoint::All(_) => {}
        }
    }

    fn instance(&mut self, instance: &Instance) {
        instance.types.iter().for_each(|ty| self.argument(ty));
    }

    fn argument(&mut self, ty: &TypeExpr) {
        if !matches!(ty.kind, TypeKind::Const(_)) {
            self.ty(ty);
        }
    }

    /// The type of a port, whose tokens have a size.
    fn token(&mut self, ty: &TypeExpr) {
        match unsized_part(ty) {
            Some(span) => {
                let message = "a token cannot be a list without a number of elements";
                let error = Diagnostic::error("unknown-type", span, message);
                self.diagnostics.push(error.note("write `[T; 8]`, `Vec<T>` or `heapless::Vec<T, 8>`"));
            }
            None => self.ty(ty),
        }
    }

    fn ty(&mut self, ty: &TypeExpr) {
        match &ty.kind {
            TypeKind::Array(element, _) => self.ty(element),
            TypeKind::Tuple(parts) => parts.iter().for_each(|part| self.ty(part)),
            TypeKind::Const(number) => {
                let message = format!("expected a type, but `{number}` is a number");
                self.diagnostics.push(Diagnostic::error("unknown-type", ty.span, message));
            }
            TypeKind::Measured(number, unit) => {
                self.ty(number);
                self.unit(number, unit);
            }
            TypeKind::Path(path, args) => {
                args.iter().for_each(|arg| self.argument(arg));
                self.path(path, args);
            }
        }
    }

    /// The unit of a port. It must exist, and the tokens must be numbers.
    fn unit(&mut self, ty: &TypeExpr, unit: &Ident) {
        if let Err(error) = declared_unit(unit) {
            return self.diagnostics.push(*error);
        }
        let generics: Vec<String> = self.generics.iter().map(|name| (*name).to_owned()).collect();
        let number = self.catalog.type_in_text(&self.texts.ty(ty), &generics);
        if !number.may_be_a_number() || matches!(number, Type::Param(_)) {
            let message = format!("only a number has a unit, but the tokens are of type `{number}`");
            self.diagnostics.push(Diagnostic::error("wrong-unit", unit.span, message));
        }
    }

    fn path(&mut self, path: &PathExpr, args: &[TypeExpr]) {
        let given = args.len();
        if self.texts.is_unclear(path) {
            return;
        }
        let full = self.texts.full_path(path);
        let is_generic = |name: &String| self.generics.contains(&name.as_str());
        if !is_path(&full) {
            return self.unknown(path, &full);
        }
        if let [name] = full.as_slice() {
            let found = self.catalog.types(&full);
            match found.first() {
                Some(def) => return self.definition(*def, path, args),
                None if is_generic(name)
                    || [DURATION, TIME].contains(&name.as_str())
                    || PRIMITIVES.contains(&name.as_str()) =>
                {
                    return self.count(path, given, (0, 0));
                }
                None if STD.contains(&name.as_str()) => {
                    let count = usize::from(name != "String");
                    self.count(path, given, (count, count));
                    return self.no_numbers(args);
                }
                None => return self.unknown(path, &full),
            }
        }
        let Some(first) = full.first() else { return };
        match self.catalog.types(&full).first() {
            Some(def) => self.definition(*def, path, args),
            None if library::is_listed(&full) => match library::type_arguments(&full) {
                Some(count) => {
                    self.count(path, given, count);
                    self.no_numbers(args);
                }
                None => self.unlisted(path),
            },
            // Only rustc knows the contents of a crate that is not scanned, and the items that macros make.
            None if self.catalog.is_extern(first) => {}
            None if self.catalog.is_crate(first) && self.catalog.may_hide(&full[..full.len() - 1]) => {}
            None => self.unknown(path, &full),
        }
    }

    fn definition(&mut self, def: crate::catalog::DefId, path: &PathExpr, args: &[TypeExpr]) {
        if let Some(count) = self.catalog.arguments(def) {
            self.count(path, args.len(), count);
        }
        let is_number = |ty: &TypeExpr| matches!(ty.kind, TypeKind::Const(_));
        for (_, arg) in args.iter().enumerate().filter(|(i, arg)| is_number(arg) && !self.catalog.takes_number(def, *i))
        {
            self.ty(arg);
        }
        if self.catalog.path(def).is_none() {
            let (file, line) = self.catalog.place(def);
            let message = format!("the type `{}` is not accessible from the program", path.text());
            let error = Diagnostic::error("unknown-type", path.span, message);
            let note = format!(
                "declared at {}:{line}; it needs `pub` and a `pub use`, or a place next to the call of `graph!`",
                file.display()
            );
            self.diagnostics.push(error.note(note));
        }
    }

    /// Reports numbers among arguments that have to be types.
    fn no_numbers(&mut self, args: &[TypeExpr]) {
        args.iter().filter(|arg| matches!(arg.kind, TypeKind::Const(_))).for_each(|arg| self.ty(arg));
    }

    fn count(&mut self, path: &PathExpr, given: usize, (least, most): (usize, usize)) {
        if (least..=most).contains(&given) {
            return;
        }
        self.diagnostics.push(wrong_count(path, most, given, path.span));
    }

    /// Reports a type of the standard library or the runtime that is not known here.
    fn unlisted(&mut self, path: &PathExpr) {
        let Some(last) = path.segments.last() else { return };
        let message = format!("the type `{}` cannot be written with its path in a source file", path.text());
        let note = format!("give it a name in Rust, `pub type {} = …;`, and use that", last.text);
        self.diagnostics.push(Diagnostic::error("unknown-type", path.span, message).note(note));
    }

    fn unknown(&mut self, path: &PathExpr, full: &[String]) {
        let Some(last) = path.segments.last() else { return };
        let tree = &self.texts.files[self.file].1;
        let message = format!("there is no type `{}`", path.text());
        let error = Diagnostic::error("unknown-type", path.span, message);
        let elsewhere = self.catalog.find(&last.text).into_iter().filter(|def| self.catalog.is_type(*def));
        let elsewhere: Vec<String> = elsewhere
            .filter_map(|def| self.catalog.path(def))
            .map(|path| self.catalog.written(path).join("::"))
            .collect();
        let at = Span::new(self.texts.file_id(self.file), 0, 0);
        let at = tree.imports_at.map_or(at, |start| Span::new(at.file, start, start));
        let error = match elsewhere.as_slice() {
            [] => suggest(error, last, self.known(full).iter().map(String::as_str)),
            [only] => error.fix(format!("import `{only}`"), at, format!("use {only};\n")),
            several => several
                .iter()
                .take(4)
                .fold(error, |error, import| error.guess(format!("import `{import}`"), at, format!("use {import};\n"))),
        };
        // A misspelt type is reported at each place, an unknown one only once.
        let is_misspelt = elsewhere.is_empty() && !error.fixes.is_empty();
        if !is_misspelt && !self.missing.insert(path.text()) {
            return;
        }
        let note = match full {
            [krate, _, ..] if !self.catalog.knows_crate(krate) => {
                format!("the package depends on no crate `{krate}`: add it with `cargo add {krate}`")
            }
            _ => "a type is built into Rust, imported (`use crate::Name;`), or written with its path".to_owned(),
        };
        self.diagnostics.push(self.catalog.broken().fold(error.note(note), Diagnostic::note));
    }

    /// Names that may have been meant.
    fn known(&self, full: &[String]) -> Vec<String> {
        match full.split_last() {
            Some((_, parent)) if !parent.is_empty() => {
                self.catalog.names_in(parent).into_iter().map(str::to_owned).collect()
            }
            _ => {
                let imported = self.texts.names(self.file).keys().cloned();
                let own = self.catalog.own_types().map(str::to_owned);
                imported.chain(own).chain(PRIMITIVES.iter().chain(&STD).map(|name| (*name).to_owned())).collect()
            }
        }
    }
}
