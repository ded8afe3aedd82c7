//! What slots, events and hybrid connections mean for the schedule: which connections may stay occupied, and
//! whether tokens can go round for ever.

use super::Links;
use crate::{
    catalog::{ArgSig, Catalog},
    graph::{Flow, Graph, NodeId, NodeKind, Standard},
    syntax::tree::PortKind,
};
use std::collections::BTreeMap;

/// The asynchronous part of a graph.
#[derive(Debug)]
pub struct Asynchronous {
    /// The connections to slots, in the order of the text: slot tokens are told apart by their place in it.
    pub slots: Vec<usize>,
    /// For each connection whether it may hold a token at a time when clusters are looked at (execution semantics,
    /// section 3): it leads to an input, out of the program, or to a slot that can itself be held back.
    pub stays: Vec<bool>,
    /// Whether tokens may go round for ever while the time stands still.
    pub endless: bool,
}

impl Asynchronous {
    /// Looks at all asynchronous connections of `graph`.
    pub fn new(graph: &Graph, catalog: &Catalog, links: &Links) -> Self {
        let flows: Vec<Flow> = graph.connections.iter().map(|c| graph.flow(c)).collect();
        let slots = (0..flows.len()).filter(|c| flows[*c] == Flow::ToSlot).collect();
        let stays = stays(graph, links, &flows);
        Self { slots, stays, endless: is_endless(graph, catalog, links) }
    }

    /// The number of the slot token on `connection`.
    pub fn slot(&self, connection: usize) -> usize {
        self.slots.partition_point(|c| *c < connection)
    }

    /// The connections of a node's events that may stay occupied: while one does, the node cannot run (R1, R5).
    pub fn holding_back<'a>(
        &'a self,
        graph: &'a Graph,
        links: &'a Links,
        node: NodeId,
    ) -> impl Iterator<Item = usize> + 'a {
        events(graph, links, node).filter(|c| self.stays[*c])
    }
}

/// The connections of a node's events.
fn events<'a>(graph: &'a Graph, links: &'a Links, node: NodeId) -> impl Iterator<Item = usize> + 'a {
    links.sends[node].iter().copied().filter(|c| graph.port(graph.connections[*c].from).kind == PortKind::Event)
}

/// A node whose events all lead to slots that are served at once is served at once itself. That is found from the
/// ends of chains of events upwards; what lies on a circle is never found.
fn stays(graph: &Graph, links: &Links, flows: &[Flow]) -> Vec<bool> {
    let takers: Vec<NodeId> = (0..graph.nodes.len()).collect();
    let mut waits: Vec<usize> = takers.iter().map(|n| events(graph, links, *n).count()).collect();
    let mut into: BTreeMap<NodeId, Vec<usize>> = BTreeMap::new();
    for (index, c) in graph.connections.iter().enumerate().filter(|(i, _)| flows[*i] == Flow::ToSlot) {
        into.entry(c.to.node).or_default().push(index);
    }
    let leaves_program = |node: NodeId| matches!(graph.nodes[node].kind, NodeKind::Boundary(_));
    let mut stays: Vec<bool> = flows.iter().map(|flow| *flow != Flow::Synchronous).collect();
    let mut served: Vec<NodeId> = takers.into_iter().filter(|n| waits[*n] == 0 && !leaves_program(*n)).collect();
    while let Some(node) = served.pop() {
        for &index in into.get(&node).into_iter().flatten() {
            stays[index] = false;
            let from = graph.connections[index].from;
            if graph.port(from).kind == PortKind::Event {
                waits[from.node] -= 1;
                if waits[from.node] == 0 {
                    served.push(from.node);
                }
            }
        }
    }
    stays
}

/// Whether a token can cause another one on the connection that it came on, in the same instant.
fn is_endless(graph: &Graph, catalog: &Catalog, links: &Links) -> bool {
    // A vertex is what a token on a connection causes: a firing of its node, or a call of its slot.
    let causes: Vec<Vec<usize>> =
        (0..graph.connections.len()).map(|index| caused(graph, catalog, links, index)).collect();
    let mut waits = vec![0usize; causes.len()];
    causes.iter().flatten().for_each(|c| waits[*c] += 1);
    let mut free: Vec<usize> = (0..causes.len()).filter(|c| waits[*c] == 0).collect();
    let mut seen = 0;
    while let Some(index) = free.pop() {
        seen += 1;
        for &next in &causes[index] {
            waits[next] -= 1;
            if waits[next] == 0 {
                free.push(next);
            }
        }
    }
    seen < causes.len()
}

/// The connections on which a token may be sent because of one on `connection`.
fn caused(graph: &Graph, catalog: &Catalog, links: &Links, connection: usize) -> Vec<usize> {
    let to = graph.connections[connection].to;
    let node = &graph.nodes[to.node];
    let by_process = graph.port(to).kind == PortKind::Input;
    let sends = |port: usize| match (&node.kind, node.ports[port].kind, node.ports[port].standard) {
        // What a delay sends is of the next iteration.
        (NodeKind::Delay(_), ..) => false,
        (_, _, Some(Standard::Timeout)) => false,
        (_, _, Some(Standard::Processed | Standard::Late)) => by_process,
        (_, _, Some(_)) => true,
        (_, PortKind::Output, _) => by_process,
        (NodeKind::Library(library), ..) => {
            let signature = &catalog.signatures[library.signature];
            let args = if by_process {
                signature.process.as_deref()
            } else {
                signature.slots.iter().find(|s| s.port == to.port).map(|s| s.args.as_slice())
            };
            args.unwrap_or_default().contains(&ArgSig::Port(port))
        }
        _ => true,
    };
    links.sends[to.node]
        .iter()
        .chain(&links.out_of[to.node])
        .copied()
        .filter(|c| sends(graph.connections[*c].from.port))
        .collect()
}
