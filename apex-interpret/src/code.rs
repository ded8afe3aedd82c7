//! A program that is interpreted: its operations, and its state.

use crate::{Library, state::State};
use apex_dsl::{
    analyse::{Analysis, ClusterId},
    catalog::Catalog,
    graph::{Graph, NodeId, NodeKind, PortId},
    index::IdVec,
    program::{ClusterRow, Lower, Ops, Plan, Program, Reaction, Served},
};
use std::collections::BTreeMap;

/// Operations of a program, or of the body of an `each`.
pub struct Code<'a> {
    /// The program.
    pub program: Program<'a>,
    /// Plans of clusters.
    pub plans: IdVec<ClusterId, Plan>,
    /// Operations of clusters.
    pub clusters: IdVec<ClusterId, Ops>,
    /// Operations of slots.
    pub slots: Vec<Served>,
    /// Operations of timeouts.
    pub timeouts: Vec<Ops>,
    /// Operations before the first reaction.
    pub first: Ops,
    /// Operations of `reset`.
    pub reset: Ops,
    /// Operations of `cancel` and `resume`.
    pub interrupts: BTreeMap<PortId, Ops>,
    /// The reaction.
    pub reaction: Reaction,
    /// The clusters that the dispatcher looks at.
    pub rows: Vec<ClusterRow>,
    /// Number of the first node among all nodes, for observers.
    pub base: usize,
    /// Bodies of `each`.
    pub bodies: BTreeMap<NodeId, Code<'a>>,
}

impl<'a> Code<'a> {
    /// Operations of a graph. `count` is the number of nodes before it.
    fn new(graph: &'a Graph, analysis: &'a Analysis, catalog: &'a Catalog, count: &mut usize) -> Self {
        let base = *count;
        *count += graph.nodes.len();
        let program = Program::new(Lower::new(graph, analysis, catalog, None));
        let plan = |cluster| Plan::new(graph, catalog, &analysis.links, analysis, cluster);
        let plans: IdVec<ClusterId, Plan> = analysis.clusters.ids().map(plan).collect();
        let clusters = analysis.clusters.ids().map(|cluster| program.ops_of(cluster, &plans)).collect();
        let mut bodies = BTreeMap::new();
        for (node, n) in graph.nodes.iter_enumerated() {
            if let (NodeKind::Each(each), Some(body)) = (&n.kind, analysis.bodies.get(&node)) {
                bodies.insert(node, Self::new(&each.body, body, catalog, count));
            }
        }
        Self {
            clusters,
            slots: (0..program.wiring.slots.len()).map(|slot| program.served(slot)).collect(),
            timeouts: (0..program.wiring.timeouts.len()).map(|timeout| program.expired(timeout)).collect(),
            first: program.first(),
            reset: program.reset(),
            interrupts: program.interrupts().into_iter().collect(),
            reaction: program.reaction(),
            rows: program.wiring.bits.rows(graph, analysis, &analysis.links),
            base,
            bodies,
            plans,
            program,
        }
    }

    /// Faults of the compiler that show in the program, also in the bodies of its `each`.
    pub fn verify(&self) -> Vec<String> {
        let inner = self.bodies.values().flat_map(Self::verify);
        self.program.verify(&self.plans, &self.clusters).into_iter().chain(inner).collect()
    }

    /// The graph.
    pub fn graph(&self) -> &'a Graph {
        self.program.lower.graph
    }

    /// Number of a node among all nodes, for observers.
    pub fn number(&self, node: NodeId) -> usize {
        self.base + node.index()
    }
}

/// A program with its state.
pub struct Interpreter<'a> {
    pub(crate) code: Code<'a>,
    pub(crate) state: State,
    pub(crate) library: &'a dyn Library,
}

impl<'a> Interpreter<'a> {
    /// The program of a graph before its first reaction.
    ///
    /// # Errors
    /// Returns what the library does not know.
    pub fn new(
        graph: &'a Graph,
        analysis: &'a Analysis,
        catalog: &'a Catalog,
        library: &'a dyn Library,
    ) -> Result<Self, String> {
        let code = Code::new(graph, analysis, catalog, &mut 0);
        if let Some(fault) = code.verify().into_iter().next() {
            return Err(format!("internal error of the compiler: {fault}"));
        }
        let state = State::new(&code, library)?;
        Ok(Self { code, state, library })
    }
}
