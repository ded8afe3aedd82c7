//! Conditions that hold a source back. A source may fire again only when all nodes downstream have finished (R4), and
//! each of these waits for the tokens of all others that send to it.
//!
//! Two sources without a period may share a cluster only if the same conditions hold them back, after the same number
//! of firings. Otherwise one would wait for the conditions of the other: with `a -> [x, z.p]` and `b -> z.q`, where `x`
//! waits for room for its event, `a` is held back at once. `b` may fire once more: its token waits at `z` then.

use super::{
    cluster::{Guard, tokens},
    links::Links,
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
    /// For each stop, the conditions that hold back what is there.
    held: Vec<Vec<HeldBack>>,
}

impl Ways {
    /// The ways of the tokens to inputs. `own` holds the guards of each node itself, `stays` the nodes whose tokens may
    /// stay on their connections.
    pub fn new(
        graph: &Graph,
        links: &Links,
        guards: &[Guard],
        own: &IdVec<NodeId, Vec<usize>>,
        stays: impl Iterator<Item = NodeId>,
    ) -> Self {
        let mut ways = Self { down: vec![], up: vec![], held: vec![] };
        ways.add_stops(graph.nodes.len());
        // For the token of each event, the stop where it comes in.
        let mut entries: BTreeMap<usize, usize> = BTreeMap::new();
        let mut sides: BTreeMap<Crossing, usize> = BTreeMap::new();
        let tokens: BTreeMap<ConnectionId, usize> = tokens(guards).collect();
        for &connection in links.inputs.iter().flatten() {
            let Connection { from, to, crossings, .. } = &graph.connections[connection];
            let mut stops = vec![];
            // The node of an event fires on its own.
            if graph.flow(&graph.connections[connection]) != Flow::ToInput {
                stops.push(from.node.index());
            }
            stops.extend(crossings.iter().map(|side| *sides.entry(*side).or_insert_with(|| ways.add_stops(1))));
            stops.push(to.node.index());
            for pair in stops.windows(2) {
                ways.down[pair[0]].push(pair[1]);
                ways.up[pair[1]].push(pair[0]);
            }
            entries.extend(tokens.get(&connection).map(|guard| (*guard, stops[0])));
        }
        for (node, own) in own.iter_enumerated() {
            for guard in own {
                let stop = entries.get(guard).copied().unwrap_or(node.index());
                ways.held[stop].push(HeldBack::Guard(*guard));
            }
        }
        stays.for_each(|node| ways.held[node.index()].push(HeldBack::Sender(node)));
        ways
    }

    /// Adds stops, and returns the number of the first one.
    fn add_stops(&mut self, count: usize) -> usize {
        let first = self.held.len();
        self.down.resize(first + count, vec![]);
        self.up.resize(first + count, vec![]);
        self.held.resize(first + count, vec![]);
        first
    }

    /// Conditions that hold a source back. `pulled` holds the guards with which nodes fire because their consumers do.
    pub fn holding(&self, source: NodeId, pulled: &BTreeMap<NodeId, BTreeSet<usize>>) -> Holding {
        let mut holding = Holding::new();
        for ((stop, is_up), lag) in self.lags(source.index()) {
            let pulled = pulled.get(&NodeId::from(stop)).into_iter().flatten();
            for what in self.held[stop].iter().copied().chain(pulled.map(|guard| HeldBack::Guard(*guard))) {
                // The firing that is awaited upstream waits for what the one before it has sent.
                let lag = lag + usize::from(is_up && matches!(what, HeldBack::Sender(_)));
                let least = holding.entry(what).or_insert(lag);
                *least = lag.min(*least);
            }
        }
        holding
    }

    /// Numbers of firings after which a source waits for the stops that are reached downstream (`false`), and then
    /// upstream (`true`). A node downstream has to finish; it waits for the nodes upstream of it, and each of these has
    /// to finish its previous firing first.
    fn lags(&self, source: usize) -> BTreeMap<(usize, bool), usize> {
        let mut lags: BTreeMap<(usize, bool), usize> = BTreeMap::new();
        let mut ends = VecDeque::from([(source, false, 0)]);
        while let Some((stop, is_up, lag)) = ends.pop_front() {
            if lags.get(&(stop, is_up)).is_some_and(|known| *known <= lag) {
                continue;
            }
            lags.insert((stop, is_up), lag);
            self.up[stop].iter().for_each(|up| ends.push_front((*up, true, lag)));
            for down in self.down[stop].iter().copied() {
                match is_up {
                    true => ends.push_back((down, false, lag + 1)),
                    false => ends.push_front((down, false, lag)),
                }
            }
        }
        lags
    }
}
