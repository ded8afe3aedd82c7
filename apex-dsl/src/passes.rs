//! The passes in order: the table of contents of the compiler.

use crate::{
    analyse,
    catalog::Catalog,
    check,
    checked::CheckedProgram,
    claims::{self, Decided},
    codegen,
    graph::Graph,
    machine::Machines,
    report::{Diagnostics, Severity},
    resolve::{self, Link, SourceSet},
    source::{FileId, Sources, Span, World},
    threads,
};
use proc_macro2::TokenStream;

/// Results of all checks of a source file.
pub struct Checked {
    /// The source file and all that it imports.
    pub texts: SourceSet,
    /// The connections in it, as written.
    pub links: Vec<Link>,
    /// The programs in it that could be built and analysed.
    pub programs: Vec<CheckedProgram>,
    /// The graphs in it that are not programs: graphs used in other ones, and graphs with parameters without a value.
    pub parts: Vec<Graph>,
}

/// Checks the source file `root` and everything it imports. Programs that cannot be built or analysed are left out.
pub fn check(
    root: FileId,
    catalog: &mut Catalog,
    sources: &mut Sources,
    world: &mut dyn World,
    diagnostics: &mut Diagnostics,
) -> Checked {
    check_all(root, catalog, sources, world, claims::MAX_STATES, diagnostics)
}

/// Variant of [`check`] for tools that also show the source. At most `states` states are visited to decide claims.
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
    let graphs = resolved.graphs.into_iter().map(|graph| (graph, vec![]));
    for (graph, scripts) in graphs.chain(resolved.tests) {
        check::check(&graph, catalog, diagnostics);
        if let Some(analysis) = analyse::analyse(&graph, catalog, diagnostics) {
            check::check_rates(&graph, &analysis, diagnostics);
            threads::check(&graph, &analysis, catalog, diagnostics);
            if graph.is_open {
                parts.push(graph);
            } else {
                programs.push(CheckedProgram { graph, analysis, claims: Decided::default(), split: None, scripts });
            }
        }
    }
    // With errors, connections may be missing, and claims would fail only for that reason.
    if !diagnostics.has_errors() {
        for graph in programs.iter().map(|program| &program.graph).chain(&parts) {
            check::check_lints(graph, catalog, diagnostics);
        }
        if let Some((file, tree)) = resolved.texts.files.first() {
            check::check_unused(*file, tree, sources, diagnostics);
        }
        for program in &programs {
            check::check_periods(&program.graph, &program.analysis, diagnostics);
        }
        for program in &mut programs {
            program.claims = claims::decide(&program.graph, &program.analysis, catalog, states, diagnostics);
        }
    }
    if !diagnostics.has_errors() {
        for program in &mut programs {
            program.split = threads::split(&program.graph, &program.analysis, catalog);
        }
    }
    diagnostics.retain(|message| {
        message.severity == Severity::Error || !sources.is_allowed(message.primary.span, message.code)
    });
    Checked { texts: resolved.texts, links: resolved.links, programs, parts }
}

/// The program between analysis and Rust, as text, for each of `programs` that is not a test.
pub fn listings(programs: &[CheckedProgram], catalog: &Catalog, sources: &Sources) -> Vec<String> {
    let graphs = programs.iter().filter(|program| !program.is_test());
    graphs.map(|program| codegen::listing(program, catalog, sources)).collect()
}

/// Memory that each of `programs` uses, in pieces; empty if `diagnostics` has errors.
pub fn memory<'a>(
    programs: impl Iterator<Item = &'a CheckedProgram>,
    catalog: &Catalog,
    sources: &Sources,
    diagnostics: &mut Diagnostics,
) -> Vec<Vec<codegen::Piece>> {
    if diagnostics.has_errors() { vec![] } else { programs.map(|p| codegen::memory(p, catalog, sources)).collect() }
}

/// Rust code of `programs` and `machines`; empty if `diagnostics` has errors. `place` maps a span of the source to the
/// code that called `graph!`. `recordable` is `true` if the runtime that the code will call can record.
pub fn generate(
    programs: &[CheckedProgram],
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
    codegen::text(programs, machines, catalog, sources, place, recordable, diagnostics)
}
