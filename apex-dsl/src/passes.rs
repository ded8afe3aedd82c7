//! The passes in order: the table of contents of the compiler.

use crate::{
    analyse,
    catalog::Catalog,
    check,
    claims::{self, Decided},
    codegen,
    graph::Graph,
    machine::Machines,
    program::Program,
    report::Diagnostics,
    resolve::{self, Link, Texts},
    source::{FileId, Sources, Span, World},
    threads,
};
use proc_macro2::TokenStream;

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
) -> Checked {
    check_all(root, catalog, sources, world, claims::MAX_STATES, diagnostics)
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
    catalog.look_from(&sources.get(root).path);
    let resolved = resolve::resolve(root, catalog, sources, world, diagnostics);
    let (mut programs, mut parts) = (vec![], resolved.nested);
    let graphs = resolved.graphs.into_iter().map(|graph| (graph, None));
    let tests = resolved.tests.into_iter().map(|(graph, script)| (graph, Some(script)));
    for (graph, script) in graphs.chain(tests) {
        check::check(&graph, catalog, diagnostics);
        if let Some(analysis) = analyse::analyse(&graph, catalog, diagnostics) {
            check::check_rates(&graph, &analysis, diagnostics);
            threads::check(&graph, &analysis, diagnostics);
            if graph.is_open {
                parts.push(graph);
            } else {
                programs.push(Program { graph, analysis, claims: Decided::default(), split: None, script });
            }
        }
    }
    // In a text with errors connections may be missing, so that claims would fail for no reason.
    if !diagnostics.has_errors() {
        for program in &mut programs {
            program.claims = claims::decide(&program.graph, catalog, states, diagnostics);
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

/// Rust for `programs` and `machines`; nothing if `diagnostics` has errors then. `place` says where a piece of the text stands in
/// the code that called `graph!`; `recordable` if the runtime that it will call can record.
pub fn generate(
    programs: &[Program],
    machines: &Machines,
    catalog: &Catalog,
    sources: &Sources,
    place: &dyn Fn(Span) -> proc_macro2::Span,
    recordable: bool,
    diagnostics: &mut Diagnostics,
) -> TokenStream {
    if diagnostics.has_errors() {
        return TokenStream::new();
    }
    codegen::text(programs, machines, catalog, sources, place, recordable)
}
