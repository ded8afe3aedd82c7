//! The code of a cluster, and of operations, in the making.

use super::{generator::Generator, view::ProgramView};
use crate::{
    analyse::{Analysis, ClusterId},
    graph::Graph,
    program::{BlockId, Plan},
};

/// Writes the code of one cluster.
pub struct Emitter<'a> {
    pub generator: &'a Generator<'a>,
    pub view: ProgramView<'a>,
    pub graph: &'a Graph,
    pub analysis: &'a Analysis,
    pub plan: &'a Plan,
    pub cluster: ClusterId,
}

impl<'a> Emitter<'a> {
    /// An emitter for `cluster`.
    pub fn new(generator: &'a Generator<'a>, view: ProgramView<'a>, cluster: ClusterId) -> Self {
        let ProgramView { graph, analysis, .. } = view;
        let plan = &view.program.plans[cluster];
        Self { generator, view, graph, analysis, plan, cluster }
    }
}

/// Writes operations, where the program is taken apart:
/// `let Self { nodes, state, core, inputs, outputs, events } = self`.
#[derive(Clone, Copy)]
pub struct Writer<'a> {
    pub generator: &'a Generator<'a>,
    pub view: ProgramView<'a>,
    /// The cluster whose operations they are, and the block of it.
    pub inside: Option<(&'a Emitter<'a>, BlockId)>,
}
