//! What slots, events and hybrid connections mean for the schedule: which connections may stay occupied, and
//! whether tokens can go round for ever.

use super::{Delivery, Links, live};
use crate::{
    catalog::{ArgSig, Catalog, Signature},
    graph::{End, Flow, Graph, NodeId, NodeKind, Standard},
    syntax::tree::PortKind,
};
use std::collections::{BTreeMap, BTreeSet};

/// From so many clusters, slots or timeouts on, code is called by number: rustc takes a time that grows with the square of the
/// size of a function.
pub const MANY: usize = 32;

/// The asynchronous part of a graph.
#[derive(Debug)]
pub struct Asynchronous {
    /// For each connection, of whatever kind, whether it can ever carry a token.
    pub live: Vec<bool>,
    /// The connections to slots that can carry tokens, in the order of the text: slot tokens are told apart by their place
    /// in it.
    pub slots: Vec<usize>,
    /// For each connection whether it may hold a token at a time when clusters are looked at (execution semantics,
    /// section 3): it leads to an input, out of the program, or to a slot that can itself be held back.
    pub stays: Vec<bool>,
    /// For each connection whether it is known at run time that it holds a token: it may stay occupied, a slot of its
    /// node might be called again before that token was taken (R5), or what feeds its sender is held back by it (R4).
    pub tracked: Vec<bool>,
    /// Whether tokens may go round for ever while the time stands still.
    pub endless: bool,
    /// How slot tokens are kept in their order.
    pub delivery: Delivery,
    /// Slots or timeouts are so many that tables serve them: their tokens are queued.
    pub is_tabled: bool,
    /// For each connection those on which a token may be sent because of one on it.
    causes: Vec<Vec<usize>>,
}

impl Asynchronous {
    /// Looks at all asynchronous connections of `graph`, and takes those out of `links` that never carry a token.
    pub fn new(graph: &Graph, catalog: &Catalog, links: &mut Links, regions: &[usize]) -> Self {
        // A vertex is what a token on a connection causes: a firing of its node, or a call of its slot.
        let mut causes: Vec<Vec<usize>> =
            (0..graph.connections.len()).map(|index| caused(graph, catalog, links, index)).collect();
        let live = live::live(graph, catalog, links, &causes);
        links.sends.iter_mut().for_each(|sends| sends.retain(|c| live[*c]));
        causes.iter_mut().zip(&live).filter(|(_, live)| !**live).for_each(|(causes, _)| causes.clear());
        let links = &*links;
        let to_slot = |c: &usize| live[*c] && graph.flow(&graph.connections[*c]) == Flow::ToSlot;
        let slots: Vec<usize> = (0..graph.connections.len()).filter(to_slot).collect();
        let timeouts = graph.nodes.iter().filter(|node| node.modifiers.timeout.is_some()).count();
        let is_tabled = slots.len().max(timeouts) > MANY;
        let single = !is_tabled && is_single(graph, catalog, links, &slots, &causes, regions);
        let mut stays = stays(graph, links, &slots);
        live.iter().enumerate().filter(|(_, live)| !**live).for_each(|(c, _)| stays[c] = false);
        if single {
            slots.iter().for_each(|c| stays[*c] = false);
        }
        let mut tracked = stays.clone();
        if !single {
            let called: BTreeSet<NodeId> = slots.iter().map(|c| graph.connections[*c].to.node).collect();
            called.iter().flat_map(|node| events(graph, links, *node)).for_each(|c| tracked[c] = true);
            // A slot that is held back must not overtake the one for whose sake its event is not yet free (R4, R7).
            if stays.contains(&true) {
                let from_output = |c: &&usize| graph.port(graph.connections[**c].from).kind == PortKind::Output;
                slots.iter().filter(from_output).for_each(|c| tracked[*c] = true);
            }
        }
        if graph.nodes.iter().any(|n| matches!(n.kind, NodeKind::Reset)) {
            sent_by_reset(graph).for_each(|c| tracked[c] = true);
        }
        let delivery = if single { Delivery::Single } else { Delivery::Queued };
        Self { live, slots, stays, tracked, endless: is_endless(&causes), delivery, is_tabled, causes }
    }

    /// Slots take their tokens in an order that is known: nobody has to look whether they are still there.
    pub fn order(&mut self) {
        self.delivery = Delivery::Ordered;
        self.slots.iter().for_each(|c| self.tracked[*c] = false);
    }

    /// Whether a connection leads to a slot and can carry tokens.
    pub fn is_slot(&self, connection: usize) -> bool {
        self.slots.binary_search(&connection).is_ok()
    }

    /// The connections on which tokens may be sent because of the one on `connection`.
    pub fn causes(&self, connection: usize) -> &[usize] {
        &self.causes[connection]
    }

    /// The slot tokens that may be sent because of the token on `connection`, in the order in which they are emitted.
    pub fn caused_slots(&self, connection: usize) -> impl Iterator<Item = usize> + Clone + '_ {
        self.causes[connection].iter().copied().filter(|c| self.is_slot(*c))
    }

    /// The slot tokens that may follow, one after the other, from tokens on `connections`; and whether they can go
    /// round in a circle.
    pub fn following(&self, connections: &[usize]) -> (Vec<usize>, bool) {
        let mut found: Vec<usize> = connections.iter().copied().filter(|c| self.is_slot(*c)).collect();
        let mut circle = false;
        let mut at = 0;
        while at < found.len() {
            for next in self.caused_slots(found[at]) {
                // With one token under way, every connection has one follower: who was seen before comes again.
                match found.contains(&next) {
                    true => circle = true,
                    false => found.push(next),
                }
            }
            at += 1;
        }
        (found, circle)
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

    /// The connections that may be occupied when the slot at the end of `connection` is to be called: those of its
    /// node's events (R5), or of all that `reset` triggers.
    pub fn not_yet_taken(&self, graph: &Graph, links: &Links, connection: usize) -> Vec<usize> {
        let node = graph.connections[connection].to.node;
        let resets = matches!(graph.nodes[node].kind, NodeKind::Reset);
        let all: Vec<usize> =
            if resets { sent_by_reset(graph).collect() } else { events(graph, links, node).collect() };
        // The token that `reset` takes is no longer under way.
        all.into_iter().filter(|c| self.tracked[*c] && !(resets && *c == connection)).collect()
    }
}

/// The connections of a node's events.
pub fn events<'a>(graph: &'a Graph, links: &'a Links, node: NodeId) -> impl Iterator<Item = usize> + 'a {
    links.sends[node].iter().copied().filter(|c| graph.port(graph.connections[*c].from).kind == PortKind::Event)
}

/// The connections on which a reset sends: `start`, and the events of nodes that activity comes and goes.
fn sent_by_reset(graph: &Graph) -> impl Iterator<Item = usize> + '_ {
    let sent =
        |from: End| matches!(graph.nodes[from.node].kind, NodeKind::Start) || graph.port(from).tells_of_activity();
    (0..graph.connections.len()).filter(move |c| sent(graph.connections[*c].from))
}

/// A node whose events all lead to slots that are served at once is served at once itself. That is found from the
/// ends of chains of events upwards; what lies on a circle is never found.
fn stays(graph: &Graph, links: &Links, slots: &[usize]) -> Vec<bool> {
    let takers: Vec<NodeId> = (0..graph.nodes.len()).collect();
    let mut waits: Vec<usize> = takers.iter().map(|n| events(graph, links, *n).count()).collect();
    let mut into: BTreeMap<NodeId, Vec<usize>> = BTreeMap::new();
    for &index in slots {
        into.entry(graph.connections[index].to.node).or_default().push(index);
    }
    let leaves_program = |node: NodeId| matches!(graph.nodes[node].kind, NodeKind::Boundary(_));
    let mut stays: Vec<bool> = graph.connections.iter().map(|c| !graph.is_synchronous(c)).collect();
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

/// Whether each step sends at most one token to a slot, and every slot is ready when its token comes. A step is a
/// firing of a region (which is more than a cluster), a slot, a timeout, a token from outside, or the start.
fn is_single(
    graph: &Graph,
    catalog: &Catalog,
    links: &Links,
    slots: &[usize],
    causes: &[Vec<usize>],
    regions: &[usize],
) -> bool {
    let to_slot = |c: &usize| slots.binary_search(c).is_ok();
    // The slot takes the token away: nobody else may want it.
    let alone = |c: &usize| {
        let from = graph.connections[*c].from;
        links.from(from.node).filter(|other| graph.connections[*other].from == from).count() == 1
    };
    let mut by_region: BTreeMap<usize, usize> = BTreeMap::new();
    let mut at_start = 0;
    for &index in slots {
        let c = &graph.connections[index];
        match &graph.nodes[c.from.node].kind {
            NodeKind::Start => at_start += 1,
            NodeKind::Boundary(PortKind::Slot) | NodeKind::Receiver(_) => {}
            NodeKind::Library(library) if !by_process(&catalog.signatures[library.signature], graph, c.from) => {}
            _ => *by_region.entry(regions[c.from.node]).or_default() += 1,
        }
        let held_back = events(graph, links, c.to.node).any(|c| graph.flow(&graph.connections[c]) == Flow::ToInput);
        let leaves = matches!(graph.nodes[c.to.node].kind, NodeKind::Boundary(_) | NodeKind::Reset);
        let standard = graph.port(c.from).standard.is_some();
        if !alone(&index) || held_back || leaves || standard || causes[index].iter().filter(|c| to_slot(c)).count() > 1
        {
            return false;
        }
    }
    at_start <= 1 && by_region.values().all(|count| *count <= 1)
}

/// Whether `process` may send on a port.
pub fn by_process(signature: &Signature, graph: &Graph, from: End) -> bool {
    let args = signature.process.as_deref().unwrap_or_default();
    graph.port(from).kind == PortKind::Output || args.contains(&ArgSig::Port(from.port))
}

/// Whether a token can cause another one on the connection that it came on, in the same instant.
fn is_endless(causes: &[Vec<usize>]) -> bool {
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
    links.from(to.node).filter(|c| sends(graph.connections[*c].from.port)).collect()
}
