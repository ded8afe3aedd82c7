//! Connections of each node, and the loops that they make.

use super::precedence::{Precedence, components, stations};
use crate::{
    graph::{ConnectionId, Flow, Graph, NodeId},
    index::IdVec,
};
use std::collections::{BTreeMap, BTreeSet};

/// Loops of a graph that lead through delays.
#[derive(Debug, Default)]
pub struct Loops {
    /// Delays on loops. They send tokens of an earlier iteration.
    pub delays: BTreeSet<NodeId>,
    /// Additional edges of the order graph. An iteration of a loop begins when tokens enter the loop, so each node that
    /// sends into a loop precedes all consumers of the delays on this loop.
    pub begun_by: BTreeMap<NodeId, Vec<NodeId>>,
}

impl Loops {
    /// Loops of `graph`.
    /// Its synchronous connections are `out_of` each node.
    fn new(graph: &Graph, out_of: &IdVec<NodeId, Vec<ConnectionId>>) -> Self {
        let mut delays = graph.nodes.ids().filter(|node| graph.nodes[*node].is_delay()).peekable();
        if delays.peek().is_none() {
            return Self::default();
        }
        let edges = Precedence::of(graph, out_of.iter().flatten().copied()).edges;
        let part = components(&edges);
        // A delay is on a loop if it sends to its own strongly connected component.
        let is_on_loop =
            |delay: &NodeId| edges[delay.index()].iter().any(|(next, _)| part[*next] == part[delay.index()]);
        let delays: BTreeSet<NodeId> = delays.filter(is_on_loop).collect();
        let mut behind: BTreeMap<usize, BTreeSet<NodeId>> = BTreeMap::new();
        for delay in &delays {
            let sent = out_of[*delay].iter().map(|c| graph.connections[*c].to.node);
            behind.entry(part[delay.index()]).or_default().extend(sent);
        }
        let mut begun_by = BTreeMap::new();
        for (node, out) in out_of.iter_enumerated() {
            // A token also enters a loop at a boundary that the loop leads through.
            let stations = out.iter().flat_map(|c| stations(graph, &graph.connections[*c]));
            let entered: BTreeSet<usize> = stations.map(|s| part[s]).filter(|p| *p != part[node.index()]).collect();
            let begun: BTreeSet<NodeId> = entered.iter().filter_map(|p| behind.get(p)).flatten().copied().collect();
            if !begun.is_empty() {
                begun_by.insert(node, begun.into_iter().collect());
            }
        }
        Self { delays, begun_by }
    }
}

/// Connections of each node, by number.
#[derive(Debug)]
pub struct Links {
    /// Synchronous connections into each node.
    pub into: IdVec<NodeId, Vec<ConnectionId>>,
    /// Synchronous connections out of each node.
    pub out_of: IdVec<NodeId, Vec<ConnectionId>>,
    /// All connections into the inputs of each node.
    pub inputs: IdVec<NodeId, Vec<ConnectionId>>,
    /// Asynchronous connections out of each node that can carry tokens, in the order of its ports, then of the source
    /// file.
    pub sends: IdVec<NodeId, Vec<ConnectionId>>,
    /// Loops with delays.
    pub loops: Loops,
}

impl Links {
    /// Connections of `graph`.
    pub fn new(graph: &Graph) -> Self {
        let none = IdVec::from_elem(vec![], graph.nodes.len());
        let (mut into, mut out_of, mut inputs, mut sends) = (none.clone(), none.clone(), none.clone(), none);
        for (index, connection) in graph.connections.iter_enumerated() {
            let flow = graph.flow(connection);
            if flow == Flow::Synchronous {
                into[connection.to.node].push(index);
                out_of[connection.from.node].push(index);
            } else {
                sends[connection.from.node].push(index);
            }
            if flow != Flow::ToSlot {
                inputs[connection.to.node].push(index);
            }
        }
        for sends in &mut sends {
            sends.sort_by_key(|c| (graph.connections[*c].from.port, *c));
        }
        let loops = Loops::new(graph, &out_of);
        Self { into, out_of, inputs, sends, loops }
    }

    /// All connections out of `node` that can carry tokens: the asynchronous ones, then the synchronous ones.
    pub fn from(&self, node: NodeId) -> impl Iterator<Item = ConnectionId> + '_ {
        self.sends[node].iter().chain(&self.out_of[node]).copied()
    }

    /// Nodes that take the synchronous tokens of `node` in the same iteration.
    pub fn successors<'a>(&'a self, graph: &'a Graph, node: NodeId) -> impl Iterator<Item = NodeId> + 'a {
        let held_back = self.loops.delays.contains(&node);
        self.out_of[node].iter().filter(move |_| !held_back).map(|c| graph.connections[*c].to.node)
    }

    /// Nodes that have to come after `node` in an iteration.
    pub fn followers<'a>(&'a self, graph: &'a Graph, node: NodeId) -> impl Iterator<Item = NodeId> + 'a {
        let begun = self.loops.begun_by.get(&node);
        self.successors(graph, node).chain(begun.into_iter().flatten().copied())
    }
}
