//! A graph, its analysis, its program, and the names in the code of it.

use super::{generator::Generator, labels::Labels};
use crate::{
    analyse::Analysis,
    graph::Graph,
    program::{Lower, Program, Wiring},
};

/// Input of the code generator for a program, or for a part of one.
#[derive(Clone, Copy)]
pub struct ProgramView<'a> {
    pub graph: &'a Graph,
    pub analysis: &'a Analysis,
    /// The asynchronous half; empty in the body of an `each`.
    pub wiring: &'a Wiring,
    /// The program.
    pub program: &'a Program<'a>,
    /// Names of what it consists of.
    pub labels: &'a Labels,
}

/// A program as it was lowered, with the names in its code.
pub struct Lowered<'a> {
    program: Program<'a>,
    labels: Labels,
}

impl<'a> Lowered<'a> {
    /// The program of a graph.
    pub fn new(generator: &Generator<'a>, graph: &'a Graph, analysis: &'a Analysis) -> Self {
        let program = Program::new(Lower::new(graph, analysis, generator.catalog, generator.claims));
        // What is found here would be a wrong program, or none that rustc takes.
        if cfg!(debug_assertions) {
            program.faults().iter().for_each(|fault| drop(generator.bug(graph.span, fault)));
        }
        let labels = Labels::new(generator, graph, analysis, &program.wiring);
        Self { program, labels }
    }
}

impl<'a> ProgramView<'a> {
    /// The view of a graph, its analysis, and its program.
    pub fn new(graph: &'a Graph, analysis: &'a Analysis, lowered: &'a Lowered<'a>) -> Self {
        let Lowered { program, labels } = lowered;
        Self { graph, analysis, wiring: &program.wiring, program, labels }
    }
}
