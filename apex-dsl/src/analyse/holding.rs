//! Conditions that hold a source back. A source may fire again only when all nodes downstream have finished (R4), and
//! each of these waits for the tokens of all others that send to it.
//!
//! Two sources without a period may share a cluster only if the same conditions hold them back, after the same number
//! of firings. Otherwise one would wait for the conditions of the other: with `a -> [x, z.p]` and `b -> z.q`, where `x`
//! waits for room for its event, `a` is held back at once. `b` may fire once more: its token waits at `z` then.

use super::{
    Links,
    clusters::{Guard, tokens},
};
use crate::{
    graph::{Connection, ConnectionId, Crossing, Flow, Graph, NodeId},
    index::IdVec,
};
use std::collections::{BTreeMap, BTreeSet, VecDeque};

/// Condition for which a source cannot fire again.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum HeldBack {
    /// A guard does not hold.
    Guard(usize),
    /// A token that this node has sent stays on its connection.
    Sender(NodeId),
}

/// Conditions that hold a source back, and after how many firings.
pub type Holding = BTreeMap<HeldBack, usize>;

/// Ways of the synchronous tokens of a graph, between *stops*: nodes, which have their own numbers, and boundaries of
/// nested graphs, where tokens wait for one another.
pub struct Ways {
    down: Vec<Vec<usize>>,
    up: Vec<Vec<usize>>,
    /// For the token of each event, the stop where it comes in.
    entries: BTreeMap<usize, usize>,
}

impl Ways {
    /// The ways of the tokens to inputs.
    pub fn new(graph: &Graph, links: &Links, guards: &[Guard]) -> Self {
        let mut sides: BTreeMap<Crossing, usize> = BTreeMap::new();
        let count = graph.nodes.len();
        let mut ways = Self { down: vec![vec![]; count], up: vec![vec![]; count], entries: BTreeMap::new() };
        let tokens: BTreeMap<ConnectionId, usize> = tokens(guards).collect();
        for &connection in links.inputs.iter().flatten() {
            let Connection { from, to, crossings, .. } = &graph.connections[connection];
            let mut stops = vec![];
            // The node of an event fires on its own.
            if graph.flow(&graph.connections[connection]) != Flow::ToInput {
                stops.push(from.node.index());
            }
            for side in crossings {
                let next = count + sides.len();
                stops.push(*sides.entry(*side).or_insert(next));
            }
            stops.push(to.node.index());
            ways.down.resize(count + sides.len(), vec![]);
            ways.up.resize(count + sides.len(), vec![]);
            for pair in stops.windows(2) {
                ways.down[pair[0]].push(pair[1]);
                ways.up[pair[1]].push(pair[0]);
            }
            if let Some(guard) = tokens.get(&connection) {
                ways.entries.insert(*guard, stops[0]);
            }
        }
        ways
    }

    /// Conditions that hold a source back. `own` holds the guards of each node itself, `pulled` those with which nodes
    /// fire because their consumers do, and `stays` the nodes whose tokens may stay on their connections.
    pub fn holding(
        &self,
        source: NodeId,
        guards: &[Guard],
        own: &IdVec<NodeId, Vec<usize>>,
        pulled: &BTreeMap<NodeId, BTreeSet<usize>>,
        stays: &[NodeId],
    ) -> Holding {
        let [down, up] = self.lags(source.index());
        let least = |down: Option<usize>, up: Option<usize>| down.into_iter().chain(up).min();
        // The firing that is awaited upstream waits for what the one before it has sent.
        let stays = stays.iter().map(|node| {
            let (down, up) = (down[node.index()], up[node.index()].map(|lag| lag + 1));
            (HeldBack::Sender(*node), least(down, up))
        });
        let own = own.iter_enumerated().flat_map(|(node, own)| own.iter().map(move |guard| (node, guard)));
        let own = own.map(|(node, guard)| (self.entries.get(guard).copied().unwrap_or(node.index()), guard));
        let pulled = pulled.iter().flat_map(|(node, set)| set.iter().map(|guard| (node.index(), guard)));
        let paced = own.chain(pulled).filter(|(_, guard)| guards[**guard] != Guard::React);
        let paced = paced.map(|(stop, guard)| (HeldBack::Guard(*guard), least(down[stop], up[stop])));
        let mut holding = Holding::new();
        for (what, lag) in paced.chain(stays) {
            if let Some(lag) = lag {
                let least = holding.entry(what).or_insert(lag);
                *least = lag.min(*least);
            }
        }
        holding
    }

    /// For each stop, after how many firings of a source the source waits for it. What is downstream has to finish.
    /// That waits for what is upstream of it, and each node there has to finish its previous firing first. Returns
    /// those of the stops that are reached downstream, and then upstream.
    fn lags(&self, source: usize) -> [Vec<Option<usize>>; 2] {
        let mut least = [vec![None; self.down.len()], vec![None; self.down.len()]];
        let mut ends = VecDeque::from([(source, false, 0)]);
        while let Some((stop, is_up, lag)) = ends.pop_front() {
            let known: &mut Option<usize> = &mut least[usize::from(is_up)][stop];
            if known.is_some_and(|known| known <= lag) {
                continue;
            }
            *known = Some(lag);
            self.up[stop].iter().for_each(|up| ends.push_front((*up, true, lag)));
            for down in self.down[stop].iter().copied() {
                match is_up {
                    true => ends.push_back((down, false, lag + 1)),
                    false => ends.push_front((down, false, lag)),
                }
            }
        }
        least
    }
}
