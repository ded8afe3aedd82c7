//! Schedule of a cluster: the order of its nodes, in nested blocks. Nodes with the same clock share a block, and so the
//! test for ⊥.
//!
//! The order must put producers before consumers, and should open few blocks. With `gate -> a -> b` and an independent
//! `c`, where `gate` may send ⊥, the schedule is `gate`, `c`, `if gate.out { a, b }`. The order `gate`, `a`, `c`, `b`
//! would be as valid, but needs two tests.
//!
//! This is list scheduling with a stack of open blocks. A node whose producers have all fired goes to the deepest open
//! block whose clock its own implies. Each block first fires the ready nodes with its own clock. Then it opens an inner
//! block for the first ready node that needs more tokens.

use super::{
    analysis::Analysis,
    clocks::{Clock, implied},
    cluster::{Block, ClusterId, Step},
    links::Links,
};
use crate::graph::{Graph, NodeId, PortId};
use std::collections::{BTreeMap, BTreeSet};

/// Largest number of nested blocks, with the outermost. Deeper ones are opened further out, with more tests.
const MAX_DEPTH: usize = 12;

/// An open block.
struct Level {
    /// Tokens that are present in the block.
    clock: Clock,
    /// Tokens that these imply.
    implied: BTreeSet<PortId>,
    /// Ready nodes whose clock is exactly that of the level.
    here: BTreeSet<(usize, NodeId)>,
    /// Ready nodes that need more tokens.
    inner: BTreeMap<(usize, NodeId), Clock>,
}

struct Scheduler<'a> {
    graph: &'a Graph,
    links: &'a Links,
    analysis: &'a Analysis,
    cluster: ClusterId,
    waits: BTreeMap<NodeId, usize>,
    rank: BTreeMap<NodeId, usize>,
    levels: Vec<Level>,
}

/// Schedule of a cluster.
pub fn schedule(graph: &Graph, links: &Links, analysis: &Analysis, cluster: ClusterId) -> Block {
    let nodes = &analysis.clusters[cluster].nodes;
    let rank: BTreeMap<NodeId, usize> = nodes.iter().enumerate().map(|(rank, node)| (*node, rank)).collect();
    let mut waits: BTreeMap<NodeId, usize> = nodes.iter().map(|n| (*n, 0)).collect();
    for &node in nodes {
        for next in links.followers(graph, node) {
            if let Some(count) = waits.get_mut(&next) {
                *count += 1;
            }
        }
    }
    let root = Level { clock: Clock::new(), implied: BTreeSet::new(), here: BTreeSet::new(), inner: BTreeMap::new() };
    let mut scheduler = Scheduler { graph, links, analysis, cluster, waits, rank, levels: vec![root] };
    let free: Vec<NodeId> = scheduler.waits.iter().filter(|(_, w)| **w == 0).map(|(n, _)| *n).collect();
    free.into_iter().for_each(|n| scheduler.place(n));
    scheduler.block(vec![])
}

impl Scheduler<'_> {
    /// Adds a node whose producers have all fired to the deepest open level whose clock its own implies.
    fn place(&mut self, node: NodeId) {
        let clock = &self.analysis.clocks[node];
        let key = (self.rank[&node], node);
        let known: BTreeSet<PortId> = implied(&self.analysis.clocks, &self.analysis.cluster_of, self.cluster, clock)
            .into_iter()
            .chain(clock.iter().copied())
            .collect();
        // A node with the clock of a level needs no further block, so the limit of the depth does not apply.
        let deepest = (0..self.levels.len()).rev().find(|level| {
            let level_clock = &self.levels[*level].clock;
            level_clock == clock || (level + 1 < MAX_DEPTH && level_clock.is_subset(&known))
        });
        let level = &mut self.levels[deepest.unwrap_or(0)];
        if level.clock == *clock {
            level.here.insert(key);
        } else {
            level.inner.insert(key, clock.clone());
        }
    }

    fn block(&mut self, opens: Vec<PortId>) -> Block {
        let mut block = Block { opens, steps: vec![] };
        loop {
            let depth = self.levels.len() - 1;
            if let Some((_, node)) = self.levels[depth].here.pop_first() {
                block.steps.push(Step::Fire(node));
                self.fired(node);
            } else if let Some((key, clock)) = self.levels[depth].inner.pop_first() {
                block.steps.push(Step::Block(self.open(key, clock)));
            } else {
                return block;
            }
        }
    }

    fn fired(&mut self, node: NodeId) {
        let next: Vec<NodeId> = self.links.followers(self.graph, node).collect();
        for next in next {
            let Some(waits) = self.waits.get_mut(&next) else { continue };
            *waits -= 1;
            if *waits == 0 {
                self.place(next);
            }
        }
    }

    /// Fills a block for `clock`. The ready nodes of the current level with the same clock move into it.
    fn open(&mut self, key: (usize, NodeId), clock: Clock) -> Block {
        let depth = self.levels.len() - 1;
        let outer = &self.levels[depth];
        // The blocks around have tested the other tokens.
        let opens: Vec<PortId> =
            clock.iter().filter(|t| !outer.clock.contains(t) && !outer.implied.contains(t)).copied().collect();
        let implied = implied(&self.analysis.clocks, &self.analysis.cluster_of, self.cluster, &clock);
        let same: Vec<(usize, NodeId)> = outer.inner.iter().filter(|(_, c)| **c == clock).map(|(k, _)| *k).collect();
        let mut here = BTreeSet::from([key]);
        for key in same {
            self.levels[depth].inner.remove(&key);
            here.insert(key);
        }
        self.levels.push(Level { clock, implied, here, inner: BTreeMap::new() });
        let block = self.block(opens);
        self.levels.pop();
        block
    }
}
