//! Graph + analysis → Rust. The text that comes out is meant to be read (`apex expand`).

mod activity;
mod bugs;
mod call;
mod cells;
mod claims;
mod clusters;
mod condition;
mod deliver;
mod dispatch;
mod distinct;
mod each;
mod fire;
mod info;
mod interrupt;
mod labels;
mod listing;
mod machine;
mod memory;
mod names;
mod numbered;
mod ops;
mod parallel;
mod params;
mod program;
mod rates;
mod record;
mod results;
mod rows;
mod sets;
mod slots;
mod stamps;
mod state;
mod stop;
mod test;
mod text;
mod threads;
mod timers;
mod told_states;
mod types;
mod witness;

pub use listing::listing;
pub use memory::{Piece, memory};
pub use text::{module_name, text};

use crate::{
    catalog::Catalog,
    checked::CheckedProgram,
    claims::Decided,
    graph::{ConnectionId, Graph, NodeId},
    report::Diagnostics,
    source::{Sources, Span},
    threads::{Cell, Part},
};
use activity::{Lowered, ProgramView};
use bugs::Bugs;
use names::Names;
use proc_macro2::TokenStream;
use quote::quote;
use std::collections::BTreeSet;

/// Generates programs.
#[derive(Clone, Copy)]
pub struct Generator<'a> {
    catalog: &'a Catalog,
    sources: &'a Sources,
    names: &'a Names,
    /// Faults of the compiler itself.
    bugs: &'a Bugs,
    /// Position of a span of the source file in the code that calls `graph!`.
    place: &'a dyn Fn(Span) -> proc_macro2::Span,
    /// The graph around the body of an `each`, and the node that the body belongs to.
    outer: Option<(&'a Graph, NodeId, &'a Generator<'a>)>,
    /// The graph of all thread groups, and which of its parts this is.
    part: Option<(&'a Graph, &'a Part)>,
    /// The thread groups, if there are several.
    parts: &'a [Part],
    /// Cells between the parts.
    cells: &'a [Cell],
    /// Decisions about the claims; `None` in a part of a program and in the body of an `each`.
    claims: Option<&'a Decided>,
    /// Recorded channels, if the program can be recorded; `None` in the body of an `each`.
    channels: Option<&'a record::Channels>,
}

/// The program of a graph, with the test that it is made for, if there is one; `recordable` if a run of it can be
/// recorded.
fn program(
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
    let channels = record::Channels::new(graph, &program.analysis, catalog, parts);
    let channels = recordable.then_some(&channels);
    let claims = program.split.is_none().then_some(&program.claims);
    let generator = Generator {
        catalog,
        sources,
        names: &names,
        bugs: &bugs,
        place,
        outer: None,
        part: None,
        parts,
        cells,
        claims,
        channels,
    };
    let code = match &program.split {
        Some(split) => generator.threads(graph, &program.analysis, split, &mut used),
        None => generator.program(graph, &program.analysis),
    };
    let formats = channels.map(record::Channels::formats);
    let recorded = generator.recorded_tokens(graph);
    let code = quote! { #code #formats #recorded };
    let code = match &program.script {
        Some(script) => generator.test(graph, script, code),
        None => code,
    };
    bugs.report(diagnostics);
    code
}

/// Calls `visit` for the program, or for each of its thread groups.
fn each_part(
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
    let generator = Generator {
        catalog,
        sources,
        names: &names,
        bugs: &bugs,
        place: &place,
        outer: None,
        part: None,
        parts: &[],
        cells: &[],
        claims: program.split.is_none().then_some(&program.claims),
        channels: None,
    };
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

impl<'a> Generator<'a> {
    /// The generator for the body of the `each` node `node` of `graph`.
    fn inside(&'a self, graph: &'a Graph, node: NodeId) -> Generator<'a> {
        let names = self.names.inner.get(&node).unwrap_or(self.names);
        Generator { names, outer: Some((graph, node, self)), part: None, claims: None, channels: None, ..*self }
    }

    /// For types: the generator of the graph of all thread groups. A type may depend on a node of another group.
    fn of_all(&self) -> Self {
        Self { part: None, ..*self }
    }

    /// The number of a node in the table of all nodes.
    fn index(&self, node: NodeId) -> usize {
        self.names.numbers[node]
    }

    /// The number of a connection in the table of all connections, unless it leads to another thread group.
    fn connection(&self, connection: ConnectionId) -> Option<usize> {
        match self.part {
            Some((_, part)) => part.connections[connection].map(ConnectionId::index),
            None => Some(connection.index()),
        }
    }
}
