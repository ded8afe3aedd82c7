//! The compiler as a library, for a package with a random source file.

use crate::{
    cargo::{Packages, call_of},
    forms::{difference, forms, items, rearranged},
    judge::Failure,
};
use apex_dsl::{
    catalog::{Catalog, Crates},
    checked::CheckedProgram,
    graph::{Graph, NodeKind},
    passes,
    report::{Diagnostic, Diagnostics, Severity, json, render},
    source::{Sources, World},
};
use apex_host::{Disk, Seen};
use apex_ide::View;
use apex_tests::texts::{Call, Case, Shape};
use proc_macro2::TokenStream;
use rayon::prelude::*;
use std::{
    any::Any,
    panic::{AssertUnwindSafe, catch_unwind},
    path::{Path, PathBuf},
    sync::mpsc,
    thread,
    time::Duration,
};

/// Time limit: far more than a source file takes, also on a busy machine, to detect hangs.
const GUARD: Duration = Duration::from_secs(60);

/// Result of the compiler for a source file.
pub enum Checked {
    /// No errors. Contains the names of its nodes and graphs, which rustc has to mention in its errors.
    Accepted(Vec<String>),
    /// An error with this code.
    Refused(String),
    /// A wrong result.
    Failed(Failure),
}

/// Checker of source files.
pub struct Checker {
    packages: Packages,
}

impl Checker {
    /// A checker with `count` packages.
    pub fn new(count: usize) -> Self {
        Self { packages: Packages::new(count) }
    }

    /// Checks cases on all cores, each in the package of its index.
    pub fn check_all(&self, cases: &[Case]) -> Vec<Checked> {
        cases.par_iter().enumerate().map(|(slot, case)| self.check(slot, case)).collect()
    }

    /// Writes `case` into a package and checks all of its calls of `graph!`.
    fn check(&self, slot: usize, case: &Case) -> Checked {
        let folder = self.packages.write(slot, case);
        let workspace = self.packages.workspace(slot, case.shape);
        let target = call_of(slot, case.shape);
        let seen = Seen::Crate(&target, case.shape == Shape::Both);
        let root = folder.join("src").join(if case.shape == Shape::Both { "main.rs" } else { "lib.rs" });
        let lines = std::fs::read_to_string(&root).unwrap_or_default();
        let calls = lines.lines().enumerate().filter(|(_, line)| line.contains("::apex_macros::graph!"));
        let mut names = vec![];
        for (call, (line, _)) in case.calls.iter().zip(calls) {
            let site = (root.clone(), line + 1);
            let path = folder.join("src").join(format!("{}.afg", call.text));
            let crates = workspace.crates_for(&seen, &path);
            match check(call, &path, crates, site) {
                Checked::Accepted(more) => names.extend(more),
                other => return other,
            }
        }
        Checked::Accepted(names)
    }
}

/// Checks the source file of a call on a thread of its own.
fn check(call: &Call, path: &Path, crates: Crates, site: (PathBuf, usize)) -> Checked {
    let (sender, receiver) = mpsc::channel();
    let (name, path) = (call.text.clone(), path.to_owned());
    let worker = thread::spawn(move || {
        let checked = catch_unwind(AssertUnwindSafe(|| compile(&path, crates, &site)));
        let checked = checked.unwrap_or_else(|panic| Checked::Failed(Failure::Panic(words(panic.as_ref()))));
        let _ = sender.send(checked);
    });
    let checked = receiver.recv_timeout(GUARD);
    match checked {
        Ok(checked) => {
            let _ = worker.join();
            checked
        }
        Err(_) => Checked::Failed(Failure::Hang(name)),
    }
}

fn words(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().map(|s| (*s).to_owned());
    text.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_default()
}

fn compile(path: &Path, crates: Crates, (file, line): &(PathBuf, usize)) -> Checked {
    let mut disk = Disk::new(None);
    let mut catalog = Catalog::load(crates, &mut disk);
    catalog.stand_at(file, *line);
    let Ok(text) = disk.read(path) else { return Checked::Refused("file".to_owned()) };
    let written = Compiled::new(path, &text, &mut catalog, &mut disk);
    for diagnostic in written.diagnostics.sorted() {
        render(diagnostic, &written.sources, false);
        json(diagnostic, &written.sources);
    }
    if let Some(error) = written.error() {
        let verdict = refused(error, &written.sources);
        let form = accepted_form(&written, path, &text, &mut catalog, &mut disk);
        return form.filter(|_| matches!(verdict, Checked::Refused(_))).unwrap_or(verdict);
    }
    let programs = &written.checked.programs;
    if let Some(failed) = programs.iter().find_map(|program| unspelled(program, &catalog)) {
        return failed;
    }
    let names = programs.iter().flat_map(|program| node_names(&program.graph)).collect();
    for form in forms(&written.view(&catalog), &text) {
        let other = Compiled::new(path, &form.text, &mut catalog, &mut disk);
        let difference = match other.error() {
            Some(error) => Some(format!("refused: {}", error.message)),
            None => difference(&items(&written.code), &items(&other.code)),
        };
        if let Some(what) = difference {
            let what = format!("{} text\n{what}\n{}", form.kind, form.text);
            return Checked::Failed(Failure::Form(form.kind, what));
        }
    }
    Checked::Accepted(names)
}

/// A form of a refused text that is not refused, although the text can be read.
fn accepted_form(
    written: &Compiled,
    path: &Path,
    text: &str,
    catalog: &mut Catalog,
    disk: &mut Disk,
) -> Option<Checked> {
    let is_readable = written.checked.texts.files.first().is_some_and(|(_, file)| !file.broken);
    let forms = if is_readable { rearranged(&written.view(catalog), text) } else { vec![] };
    forms.into_iter().find_map(|form| {
        let other = Compiled::new(path, &form.text, catalog, disk);
        let what = format!("{} text is accepted\n{}", form.kind, form.text);
        other.error().is_none().then_some(Checked::Failed(Failure::Form(form.kind, what)))
    })
}

/// Results of the compiler for a text.
struct Compiled {
    sources: Sources,
    diagnostics: Diagnostics,
    checked: passes::Checked,
    code: TokenStream,
}

impl Compiled {
    fn new(path: &Path, text: &str, catalog: &mut Catalog, disk: &mut Disk) -> Self {
        let (mut sources, mut diagnostics) = (Sources::default(), Diagnostics::default());
        let root = sources.add(path, text.to_owned());
        let checked = passes::check(root, catalog, &mut sources, disk, &mut diagnostics);
        let (place, machines) = (|_| proc_macro2::Span::call_site(), &checked.texts.machines);
        let code = passes::generate(&checked.programs, machines, catalog, &sources, &place, true, &mut diagnostics);
        Self { sources, diagnostics, checked, code }
    }

    fn error(&self) -> Option<&Diagnostic> {
        self.diagnostics.sorted().into_iter().find(|d| d.severity == Severity::Error)
    }

    fn view<'a>(&'a self, catalog: &'a Catalog) -> View<'a> {
        View { texts: &self.checked.texts, links: &self.checked.links, sources: &self.sources, catalog }
    }
}

/// Checks that the first error of a rejected source file is in it.
fn refused(error: &Diagnostic, sources: &Sources) -> Checked {
    let span = error.primary.span;
    let source = sources.get(span.file);
    let (start, end) = (span.start as usize, span.end as usize);
    let is_text = source.path.extension().is_some_and(|e| e == "afg");
    let inside = start <= end && source.text.get(start..end).is_some();
    // Only an empty source file has no place to point at.
    let points = source.text.trim().is_empty() || end > start || start > 0;
    match is_text && inside && points && !error.message.is_empty() {
        true => {
            if std::env::var_os("APEX_TEXTS_WHY").is_some() {
                println!("{}", render(error, sources, false));
            }
            Checked::Refused(error.code.to_owned())
        }
        false => Checked::Failed(Failure::Outside(format!("{}: {}", error.code, error.message))),
    }
}

/// Fails for a node without a path, which would be missing in the program.
fn unspelled(program: &CheckedProgram, catalog: &Catalog) -> Option<Checked> {
    let lost = program.graph.nodes.iter().find(|node| match &node.kind {
        NodeKind::Library(library) => catalog.signatures[library.signature].path.is_empty(),
        _ => false,
    })?;
    Some(Checked::Failed(Failure::Unspelled(lost.name.clone())))
}

fn node_names(graph: &Graph) -> Vec<String> {
    graph.nodes.iter().map(|n| n.name.clone()).chain([graph.name.clone()]).filter(|n| !n.is_empty()).collect()
}
