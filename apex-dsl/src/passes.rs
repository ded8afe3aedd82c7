//! The passes in order: the table of contents of the compiler.

use crate::{
    analyse::{self, Analysis},
    catalog::Catalog,
    check, claims, codegen,
    graph::Graph,
    report::Diagnostics,
    resolve::{self, Link, Texts},
    script::Script,
    source::{FileId, Sources, Span, World},
    threads::{self, Split},
};
use proc_macro2::TokenStream;

/// A graph that stood all checks, with what is known about it.
pub struct Program {
    /// The graph.
    pub graph: Graph,
    /// What is known about it before it runs.
    pub analysis: Analysis,
    /// If it runs on several threads: what runs on which.
    pub split: Option<Split>,
    /// If it is made for a test: what the test does with it.
    pub script: Option<Script>,
}

/// What is known about a text after all checks.
pub struct Checked {
    /// The text and those that it imports.
    pub texts: Texts,
    /// Its connections, as written.
    pub links: Vec<Link>,
    /// The programs in it, as far as they are whole.
    pub programs: Vec<Program>,
    /// The graphs in it that are no programs: used in other ones, or with parameters without a value.
    pub parts: Vec<Graph>,
}

/// Checks the text `root` and everything it imports. Programs are given as far as they are whole.
pub fn check(
    root: FileId,
    catalog: &mut Catalog,
    sources: &mut Sources,
    world: &mut dyn World,
    diagnostics: &mut Diagnostics,
) -> Vec<Program> {
    check_all(root, catalog, sources, world, claims::MAX_STATES, diagnostics).programs
}

/// As [`check`], for tools that show the text too. To decide claims, at most `states` states are looked at.
pub fn check_all(
    root: FileId,
    catalog: &mut Catalog,
    sources: &mut Sources,
    world: &mut dyn World,
    states: usize,
    diagnostics: &mut Diagnostics,
) -> Checked {
    catalog.forget_machines();
    let resolved = resolve::resolve(root, catalog, sources, world, diagnostics);
    let (mut programs, mut parts) = (vec![], resolved.nested);
    let graphs = resolved.graphs.into_iter().map(|graph| (graph, None));
    let tests = resolved.tests.into_iter().map(|(graph, script)| (graph, Some(script)));
    for (mut graph, script) in graphs.chain(tests) {
        check::check(&mut graph, catalog, diagnostics);
        if let Some(analysis) = analyse::analyse(&graph, catalog, diagnostics) {
            codegen::check_rates(&graph, &analysis, diagnostics);
            threads::check(&graph, &analysis, diagnostics);
            if graph.is_open {
                parts.push(graph);
            } else {
                programs.push(Program { graph, analysis, split: None, script });
            }
        }
    }
    if resolved.broken {
        resolve::Resolved::retain_certain(&resolved.texts, diagnostics);
    }
    // In a text with errors connections may be missing, so that claims would fail for no reason.
    if !diagnostics.has_errors() {
        for Program { graph, analysis, .. } in &mut programs {
            analysis.claims = claims::decide(graph, catalog, states, diagnostics);
        }
    }
    if !diagnostics.has_errors() {
        for program in &mut programs {
            program.split = threads::split(&program.graph, &program.analysis, catalog);
        }
    }
    Checked { texts: resolved.texts, links: resolved.links, programs, parts }
}

/// What each of `programs` consists of in memory; nothing if `diagnostics` has errors then.
pub fn memory<'a>(
    programs: impl Iterator<Item = &'a Program>,
    catalog: &Catalog,
    sources: &Sources,
    diagnostics: &mut Diagnostics,
) -> Vec<Vec<codegen::Piece>> {
    if diagnostics.has_errors() { vec![] } else { programs.map(|p| codegen::memory(p, catalog, sources)).collect() }
}

/// Rust for `programs`; nothing if `diagnostics` has errors then. `place` says where a piece of the text stands in
/// the code that called `graph!`; `recordable` if the runtime that it will call can record.
pub fn generate(
    programs: &[Program],
    catalog: &Catalog,
    sources: &Sources,
    place: &dyn Fn(Span) -> proc_macro2::Span,
    recordable: bool,
    diagnostics: &mut Diagnostics,
) -> TokenStream {
    if diagnostics.has_errors() {
        return TokenStream::new();
    }
    let machines = codegen::machines(catalog);
    let programs = programs.iter().map(|p| codegen::generate(p, catalog, sources, place, recordable));
    std::iter::once(machines).chain(programs).collect()
}
