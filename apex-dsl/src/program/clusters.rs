//! Lowering of clusters: what happens when one fires.

use super::{BlockId, Lowering, Op, Ops, Plan, Storage};
use crate::{
    analyse::{Block, ClusterId, Guard, Run, Step, handles_absence, is_mandatory},
    graph::{NodeId, NodeKind, PortId},
    syntax::tree::PortKind,
};

impl Lowering<'_> {
    /// Operations of a cluster of a program, or of the body of an `each`.
    pub fn ops_of(&self, cluster: ClusterId, plan: &Plan) -> Vec<Op> {
        match self.lower.graph.is_body {
            true => self.inside(cluster, plan),
            false => self.cluster(cluster, plan),
        }
    }

    /// Operations of a cluster of a program. The timers of its sources advance with it, and the silences of its inputs
    /// begin again. Events are emptied before and sent when all is done.
    fn cluster(&self, cluster: ClusterId, plan: &Plan) -> Ops {
        let c = &self.lower.analysis.clusters[cluster];
        let timers = c.own_guards.iter().filter_map(|guard| match self.lower.analysis.guards[*guard] {
            Guard::Timer(node) => self.wiring.timer(node),
            _ => None,
        });
        let mut ops: Ops = timers.map(Op::Advance).collect();
        let silences: Vec<usize> = c.own_guards.iter().filter_map(|guard| self.wiring.silence(*guard)).collect();
        if !silences.is_empty() {
            ops.push(Op::Hear(silences));
        }
        ops.extend(self.stamp(cluster));
        ops.extend(c.nodes.iter().flat_map(|node| self.clear_events(*node)));
        ops.extend(self.inside(cluster, plan));
        let order = c.schedule();
        // A node that was skipped because of ⊥ took its tokens all the same (A1).
        ops.extend(order.iter().filter_map(|node| self.take_activity(*node)));
        ops.extend(order.iter().flat_map(|node| self.emit(*node, true)));
        ops
    }

    /// Operations of a cluster without those that surround them in a program: tokens that wait are taken, nodes fire,
    /// and tokens for other clusters are left.
    fn inside(&self, cluster: ClusterId, plan: &Plan) -> Ops {
        let c = &self.lower.analysis.clusters[cluster];
        let mut ops: Ops = c.nodes.iter().flat_map(|node| self.read_first(*node, plan)).collect();
        ops.extend(self.block(&c.block, plan, &mut 0));
        ops.extend(c.nodes.iter().flat_map(|node| self.left(*node, cluster, plan)));
        ops
    }

    /// A firing of a cluster is as old as the oldest token that it takes.
    fn stamp(&self, cluster: ClusterId) -> Option<Op> {
        let analysis = self.lower.analysis;
        if !analysis.stamps.clusters.contains(&cluster) {
            return None;
        }
        let c = &analysis.clusters[cluster];
        let upstream = c.upstream.iter().copied().collect();
        let stamps = c.own_guards.iter().filter_map(|guard| match analysis.guards[*guard] {
            Guard::Token(connection) => self.lower.stamp(connection),
            _ => None,
        });
        let leaves = self.lower.leaves_stamp(cluster).then_some(cluster);
        Some(Op::Stamp { upstream, stamps: stamps.collect(), leaves })
    }

    /// Tokens that wait in the program are taken when the cluster starts.
    fn read_first(&self, node: NodeId, plan: &Plan) -> Ops {
        let graph = self.lower.graph;
        let sends = graph.nodes[node].ports.iter().position(|p| p.kind == PortKind::Output);
        let Some(port) = sends.filter(|_| !plan.is_multirate) else { return vec![] };
        let take = Op::Take(PortId { node, port });
        match graph.nodes[node].kind {
            NodeKind::Delay(_) => {
                let pass = if self.lower.is_active(node) { self.pass(node) } else { vec![] };
                [take].into_iter().chain(pass).collect()
            }
            NodeKind::Boundary(_) if !graph.is_body => vec![take],
            _ => vec![],
        }
    }

    /// Tokens for other clusters are left in the program when the cluster ends.
    fn left(&self, node: NodeId, cluster: ClusterId, plan: &Plan) -> Ops {
        let (graph, links) = (self.lower.graph, self.lower.links);
        let to_others = links.out_of[node]
            .iter()
            .map(|c| &graph.connections[*c])
            .filter(|c| self.lower.analysis.cluster_of[c.to.node] != cluster)
            .map(|c| c.from);
        let asynchronous = links.sends[node].iter().map(|c| graph.connections[*c].from);
        let outputs = asynchronous.filter(|end| graph.port(*end).kind == PortKind::Output);
        let mut ends: Vec<PortId> = to_others.chain(outputs).collect();
        ends.sort_unstable();
        ends.dedup();
        let stores = ends.into_iter().filter(|end| plan.storage(*end) != Storage::Buffer).map(Op::Store);
        let holds = plan.is_multirate && graph.nodes[node].is_delay();
        stores.chain(holds.then_some(Op::HoldIteration(node))).collect()
    }

    fn block(&self, block: &Block, plan: &Plan, next: &mut usize) -> Ops {
        let id = BlockId::from(*next);
        *next += 1;
        let mut ops: Ops = plan.hoisted_to(id).into_iter().map(Op::Declare).collect();
        if plan.is_multirate {
            ops.push(self.iteration(block, plan));
            return ops;
        }
        for step in &block.steps {
            match step {
                Step::Fire(node) => ops.extend(self.step(*node, plan)),
                Step::Block(inner) => {
                    let block = BlockId::from(*next);
                    let tokens = plan.tests[block].clone();
                    ops.push(Op::Block { block, tokens, body: self.block(inner, plan, next) });
                }
                Step::Repeat(_) => {}
            }
        }
        ops
    }

    /// All firings of an iteration.
    fn iteration(&self, block: &Block, plan: &Plan) -> Op {
        let runs = block.steps.iter().filter_map(|step| match step {
            Step::Repeat(run) => Some(*run),
            Step::Fire(_) | Step::Block(_) => None,
        });
        let runs: Vec<Run> = runs.collect();
        let firings = runs.iter().map(|run| (run.node, self.firing(run.node, plan))).collect();
        Op::Iteration { runs, firings }
    }

    /// One firing of a node in an iteration, if its tokens are there.
    fn firing(&self, node: NodeId, plan: &Plan) -> Ops {
        let (graph, catalog) = (self.lower.graph, self.lower.catalog);
        match &graph.nodes[node].kind {
            NodeKind::Delay(_) if plan.is_used(PortId { node, port: 1 }) => return vec![Op::TakeDelayed(node)],
            NodeKind::Delay(_) => return vec![],
            NodeKind::Boundary(PortKind::Input) if !graph.is_body => return vec![Op::Take(PortId { node, port: 0 })],
            _ => {}
        }
        let body = self.step(node, plan);
        let tests = !handles_absence(graph, catalog, node)
            && matches!(graph.nodes[node].kind, NodeKind::Library(_) | NodeKind::Each(_));
        let inputs = (0..graph.nodes[node].ports.len()).map(|port| PortId { node, port });
        let inputs = inputs.filter(|to| tests && graph.port(*to).kind == PortKind::Input && is_mandatory(graph, *to));
        let inputs: Vec<PortId> = inputs.filter(|to| self.lower.incoming(*to).is_some()).collect();
        if inputs.is_empty() { body } else { vec![Op::IfArrived { inputs, body }] }
    }

    /// A node fires: its tokens' activity counts before, and its own goes with what it sends.
    fn step(&self, node: NodeId, plan: &Plan) -> Ops {
        let graph = self.lower.graph;
        let mut ops: Ops = self.take_activity(node).into_iter().collect();
        ops.push(Op::Fire { node, fire: self.fire(node, plan) });
        if graph.nodes[node].is_delay() && self.lower.is_active(node) {
            ops.push(Op::HoldActivity(node));
        }
        ops.extend(self.heard(node, plan));
        let ends = (0..graph.nodes[node].ports.len()).map(|port| PortId { node, port });
        let used = ends.filter(|end| graph.port(*end).kind == PortKind::Output && plan.is_used(*end));
        ops.extend(used.map(Op::Observe));
        // A delay has sent its token before it takes one.
        if !graph.nodes[node].is_delay() {
            ops.extend(self.pass(node));
        }
        ops
    }

    fn pass(&self, node: NodeId) -> Ops {
        let is_output = |end: PortId| self.lower.graph.port(end).kind == PortKind::Output;
        self.pass_activity(node, &|end| is_output(end) || self.lower.is_sent_event(end))
    }

    /// A source whose silence is watched has sent something.
    fn heard(&self, node: NodeId, plan: &Plan) -> Option<Op> {
        let watch = self.watch_silence(node)?;
        let graph = self.lower.graph;
        let ends = (0..graph.nodes[node].ports.len()).map(|port| PortId { node, port });
        let tokens = ends.filter(|end| match graph.port(*end).kind {
            PortKind::Output => plan.is_used(*end),
            PortKind::Event => graph.port(*end).standard.is_none() && self.lower.is_sent_event(*end),
            _ => false,
        });
        Some(Op::IfSent { tokens: tokens.collect(), then: vec![watch] })
    }
}
