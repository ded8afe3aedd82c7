//! The order inside a cluster, with shared tests: nodes that fire on the same clock stand in one block.

use super::{Analysis, Clock, Links, clocks::implied};
use crate::graph::{End, Graph, NodeId};
use std::collections::{BTreeMap, BTreeSet};

/// Blocks nest at most this deep; deeper ones test from the outermost level again.
const MAX_DEPTH: usize = 12;

/// Things that are done if certain tokens are present.
#[derive(Debug, Default, Clone)]
pub struct Block {
    /// The tokens that must be present, besides those of the blocks around.
    pub opens: Vec<End>,
    /// What is done, in order.
    pub steps: Vec<Step>,
}

/// One thing that is done.
#[derive(Debug, Clone)]
pub enum Step {
    /// A node fires.
    Fire(NodeId),
    /// Things that are done only if more tokens are present.
    Block(Block),
}

struct Level {
    clock: Clock,
    implied: BTreeSet<End>,
    /// Nodes whose clock is exactly that of the level.
    here: BTreeSet<(usize, NodeId)>,
    /// Nodes that need more.
    inner: BTreeMap<(usize, NodeId), Clock>,
}

struct Scheduler<'a> {
    graph: &'a Graph,
    links: &'a Links,
    analysis: &'a Analysis,
    cluster: usize,
    waits: BTreeMap<NodeId, usize>,
    rank: BTreeMap<NodeId, usize>,
    levels: Vec<Level>,
}

/// What a firing of a cluster does.
pub fn schedule(graph: &Graph, links: &Links, analysis: &Analysis, cluster: usize) -> Block {
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
    /// A node waits for nothing any more: it goes to the deepest open level whose clock its own implies.
    fn place(&mut self, node: NodeId) {
        let clock = &self.analysis.clocks[node];
        let key = (self.rank[&node], node);
        let known: BTreeSet<End> = implied(&self.analysis.clocks, &self.analysis.cluster_of, self.cluster, clock)
            .into_iter()
            .chain(clock.iter().copied())
            .collect();
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

    fn block(&mut self, opens: Vec<End>) -> Block {
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

    /// Opens a block for `clock` and moves everything into it that waits on this level and fits.
    fn open(&mut self, key: (usize, NodeId), clock: Clock) -> Block {
        let depth = self.levels.len() - 1;
        let outer = &self.levels[depth];
        let opens: Vec<End> =
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
