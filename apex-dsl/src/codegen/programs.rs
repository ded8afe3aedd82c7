//! The code of a program, and of each of its thread groups.

use super::{
    bugs::Bugs,
    channels::Channels,
    generator::Generator,
    names::Names,
    view::{Lowered, ProgramView},
};
use crate::{
    catalog::Catalog,
    checked::CheckedProgram,
    report::Diagnostics,
    source::{Sources, Span},
    threads::Part,
};
use proc_macro2::TokenStream;
use quote::quote;
use std::collections::BTreeSet;

/// The program of a graph, with the tests that it is made for; `recordable` if a run of it can be recorded.
pub fn program(
    program: &CheckedProgram,
    catalog: &Catalog,
    sources: &Sources,
    place: &dyn Fn(Span) -> proc_macro2::Span,
    recordable: bool,
    diagnostics: &mut Diagnostics,
) -> TokenStream {
    let graph = &program.graph;
    let bugs = Bugs::new(graph.span);
    let mut used = BTreeSet::new();
    let names = Names::new(graph, catalog, &mut used);
    let cells = program.split.as_ref().map_or(&[][..], |split| &split.cells);
    let parts = program.split.as_ref().map_or(&[][..], |split| &split.parts);
    let channels = Channels::new(graph, &program.analysis, catalog, parts);
    let channels = recordable.then_some(&channels);
    let claims = program.split.is_none().then_some(&program.claims);
    let plain = Generator::new(catalog, sources, &names, &bugs, place);
    let generator = Generator { parts, cells, claims, channels, ..plain };
    let code = match &program.split {
        Some(split) => generator.threads(graph, &program.analysis, split, &mut used),
        None => generator.program(graph, &program.analysis),
    };
    let formats = channels.map(Channels::formats);
    let recorded = generator.recorded_tokens(graph);
    let code = quote! { #code #formats #recorded };
    let code = if program.is_test() { generator.tests(graph, &program.scripts, code) } else { code };
    bugs.report(diagnostics);
    code
}

/// Calls `visit` for the program, or for each of its thread groups.
pub fn each_part(
    program: &CheckedProgram,
    catalog: &Catalog,
    sources: &Sources,
    visit: &mut dyn FnMut(&Generator<'_>, ProgramView<'_>, Option<&Part>),
) {
    let graph = &program.graph;
    let mut used = BTreeSet::new();
    let names = Names::new(graph, catalog, &mut used);
    let bugs = Bugs::new(graph.span);
    let place = |_| proc_macro2::Span::call_site();
    let claims = program.split.is_none().then_some(&program.claims);
    let generator = Generator { claims, ..Generator::new(catalog, sources, &names, &bugs, &place) };
    let Some(split) = &program.split else {
        let lowered = Lowered::new(&generator, graph, &program.analysis);
        return visit(&generator, ProgramView::new(graph, &program.analysis, &lowered), None);
    };
    for (part, number) in split.parts.iter().zip(names.beyond..) {
        let names = names.of_part(part, number, &mut used);
        let generator = Generator { names: &names, part: Some((graph, part)), cells: &split.cells, ..generator };
        let lowered = Lowered::new(&generator, &part.graph, &part.analysis);
        visit(&generator, ProgramView::new(&part.graph, &part.analysis, &lowered), Some(part));
    }
}
