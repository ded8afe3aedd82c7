//! Consequences of slots and events for the schedule: connections that may stay occupied, and tokens that can circulate
//! without end.
//!
//! The dispatcher delivers slot tokens before it tests clusters. Most of them are gone then, and their connections need
//! neither a bit nor a guard. A token remains only if its slot cannot be called, because an event of the slot's node is
//! not free (R5). With `button.pressed -> lamp.toggle`, `lamp.changed -> log.line` and `log` without events, both
//! connections are free whenever clusters are tested. If `changed` led to an input, it could be occupied, and so could
//! `pressed`.

use super::{firing::by_process, links::Links, live::live};
use crate::{
    catalog::{ArgSig, Catalog},
    graph::{ConnectionId, Flow, Graph, NodeId, NodeKind, PortId, Standard},
    index::IdVec,
    syntax::tree::PortKind,
};
use std::collections::{BTreeMap, BTreeSet};

/// Largest number of clusters, slots or timeouts that are inlined. More are called by number, because the compile time
/// of rustc grows with the square of the size of a function.
pub const MANY: usize = 32;

/// Largest number of calls of slots in code without a queue: each step is followed by all slots that it may reach.
const MOST_UNQUEUED: usize = 512;

/// The asynchronous part of a graph.
#[derive(Debug)]
pub struct Asynchronous {
    /// For each connection of any kind, `true` if it can ever carry a token.
    pub live: IdVec<ConnectionId, bool>,
    /// Connections to slots that can carry tokens, in the order of the source file. The number of a slot token is its
    /// position in this list.
    pub slots: Vec<ConnectionId>,
    /// For each connection, `true` if it may hold a token when clusters are tested: it leads to an input, out of the
    /// program, or to a slot that can itself be held back.
    pub may_block: IdVec<ConnectionId, bool>,
    /// For each connection, `true` if it has a bit for "free" at run time: it may stay occupied, a slot of its node
    /// might be called again before the token is taken (R5), or it holds back the nodes that feed its sender (R4).
    pub has_occupancy_bit: IdVec<ConnectionId, bool>,
    /// `true` if tokens may circulate without end while time does not advance.
    pub endless: bool,
    /// Storage of the order of slot tokens.
    pub delivery: Delivery,
    /// For each connection, the connections on which its token may cause other tokens.
    causes: IdVec<ConnectionId, Vec<ConnectionId>>,
}

impl Asynchronous {
    /// Analyses the asynchronous connections of `graph`. Removes the ones that never carry a token from `links`.
    pub fn new(graph: &Graph, catalog: &Catalog, links: &mut Links, regions: &IdVec<NodeId, usize>) -> Self {
        // The effect of a token is a firing of the node at the end of its connection, or a call of its slot.
        let mut causes: IdVec<ConnectionId, Vec<ConnectionId>> =
            graph.connections.ids().map(|index| caused(graph, catalog, links, index)).collect();
        let live = live(graph, catalog, links, &causes);
        links.sends.iter_mut().for_each(|sends| sends.retain(|c| live[*c]));
        causes.iter_mut().zip(&live).filter(|(_, live)| !**live).for_each(|(causes, _)| causes.clear());
        let links = &*links;
        let to_slot = |c: &ConnectionId| live[*c] && graph.flow(&graph.connections[*c]) == Flow::ToSlot;
        let slots: Vec<ConnectionId> = graph.connections.ids().filter(to_slot).collect();
        let single =
            count_calls(&slots, &causes) <= MOST_UNQUEUED && is_single(graph, catalog, links, &slots, &causes, regions);
        let mut may_block = may_block(graph, links, &slots, &live);
        if single {
            slots.iter().for_each(|c| may_block[*c] = false);
        }
        let mut has_occupancy_bit = may_block.clone();
        if !single {
            let called: BTreeSet<NodeId> = slots.iter().map(|c| graph.connections[*c].to.node).collect();
            called.iter().flat_map(|node| events(graph, links, *node)).for_each(|c| has_occupancy_bit[c] = true);
            // A region has finished only when the slots behind its outputs have taken their tokens (R4), and an event
            // that leads to the region is free only then (R7). Else a slot that waits for it could overtake them.
            if may_block.contains(&true) {
                let from_output = |c: &&ConnectionId| graph.port(graph.connections[**c].from).kind == PortKind::Output;
                slots.iter().filter(from_output).for_each(|c| has_occupancy_bit[*c] = true);
            }
        }
        for node in graph.nodes.ids().filter(|node| moves_activity(graph, *node)) {
            sent_with_activity(graph, node).into_iter().for_each(|c| has_occupancy_bit[c] = true);
        }
        let delivery = if single { Delivery::Single } else { Delivery::Queued };
        Self { live, slots, may_block, has_occupancy_bit, endless: has_circle(&causes), delivery, causes }
    }

    /// Switches to [`Delivery::Ordered`]. Connections to slots then need no bits.
    pub fn order(&mut self) {
        self.delivery = Delivery::Ordered;
        self.slots.iter().for_each(|c| self.has_occupancy_bit[*c] = false);
    }

    /// Returns `true` if a connection leads to a slot and can carry tokens.
    pub fn is_slot(&self, connection: ConnectionId) -> bool {
        self.slots.binary_search(&connection).is_ok()
    }

    /// Connections on which tokens may be sent because of the token on `connection`.
    pub fn causes(&self, connection: ConnectionId) -> &[ConnectionId] {
        &self.causes[connection]
    }

    /// Slot tokens that may be sent because of the token on `connection`, in the order in which they are emitted.
    pub fn caused_slots(&self, connection: ConnectionId) -> impl Iterator<Item = ConnectionId> + Clone + '_ {
        self.causes[connection].iter().copied().filter(|c| self.is_slot(*c))
    }

    /// Slot tokens that may follow one after another from tokens on `connections`. The flag is `true` if they can
    /// circulate.
    pub fn following(&self, connections: &[ConnectionId]) -> (Vec<ConnectionId>, bool) {
        let mut found: Vec<ConnectionId> = connections.iter().copied().filter(|c| self.is_slot(*c)).collect();
        let mut circle = false;
        let mut at = 0;
        while at < found.len() {
            for next in self.caused_slots(found[at]) {
                // At most one token is in flight, and it causes at most one other. So a token that was found before
                // comes again.
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
    pub fn slot(&self, connection: ConnectionId) -> usize {
        self.slots.partition_point(|c| *c < connection)
    }

    /// Connections of a node's events that may stay occupied. While one of them is, the node cannot run (R1, R5).
    pub fn holding_back<'a>(
        &'a self,
        graph: &'a Graph,
        links: &'a Links,
        node: NodeId,
    ) -> impl Iterator<Item = ConnectionId> + 'a {
        events(graph, links, node).filter(|c| self.may_block[*c])
    }

    /// Connections that may be occupied when the slot at the end of `connection` is due: those of its node's events
    /// (R5), and for `reset` and `cancel` those on which they send for other nodes.
    pub fn not_yet_taken(&self, graph: &Graph, links: &Links, connection: ConnectionId) -> Vec<ConnectionId> {
        let node = graph.connections[connection].to.node;
        let others = sent_with_activity(graph, node);
        let all = events(graph, links, node).chain(others);
        // The token that `reset` takes has left its connection.
        let taken = |c: ConnectionId| moves_activity(graph, node) && c == connection;
        all.filter(|c| self.has_occupancy_bit[*c] && !taken(*c)).collect()
    }
}

/// Connections of a node's events.
pub fn events<'a>(graph: &'a Graph, links: &'a Links, node: NodeId) -> impl Iterator<Item = ConnectionId> + 'a {
    links.sends[node].iter().copied().filter(|c| graph.port(graph.connections[*c].from).kind == PortKind::Event)
}

/// Returns `true` if the slots of a node move the activity of other nodes: `reset`, `cancel` and `resume`.
pub fn moves_activity(graph: &Graph, node: NodeId) -> bool {
    matches!(graph.nodes[node].kind, NodeKind::Reset | NodeKind::Interrupt(_))
}

/// Connections on which the slots of a node send for other nodes: those of the events `activated` and `deactivated`,
/// those of state machines that it moves to another state, and for `reset` those of `start`.
fn sent_with_activity(graph: &Graph, node: NodeId) -> Vec<ConnectionId> {
    let nodes: Option<BTreeSet<NodeId>> = match graph.nodes[node].kind {
        NodeKind::Reset => None,
        NodeKind::Interrupt(subject) => Some(graph.nodes_of(subject).into_iter().collect()),
        _ => return vec![],
    };
    let tells = |from: PortId| graph.port(from).tells_of_activity() || graph.port(from).comes_with_moves;
    let sent = |from: PortId| match &nodes {
        None => matches!(graph.nodes[from.node].kind, NodeKind::Start) || tells(from),
        Some(nodes) => tells(from) && nodes.contains(&from.node),
    };
    graph.connections.ids().filter(|c| sent(graph.connections[*c].from)).collect()
}

/// For each connection, `true` if it may stay occupied.
///
/// A slot is served at once if all events that its call may trigger lead to slots that are served at once: those of its
/// node, and for `reset` and `cancel` those of other nodes. The search starts at nodes without events, the ends of
/// chains, and proceeds upstream. It never finds the nodes on a cycle of events.
fn may_block(
    graph: &Graph,
    links: &Links,
    slots: &[ConnectionId],
    live: &IdVec<ConnectionId, bool>,
) -> IdVec<ConnectionId, bool> {
    let consumers = graph.nodes.ids();
    let mut waiting: BTreeMap<ConnectionId, Vec<NodeId>> = BTreeMap::new();
    let mut waits: IdVec<NodeId, usize> = IdVec::from_elem(0, graph.nodes.len());
    for node in consumers.clone() {
        let others = sent_with_activity(graph, node).into_iter().filter(|c| live[*c]);
        for connection in events(graph, links, node).chain(others) {
            waiting.entry(connection).or_default().push(node);
            waits[node] += 1;
        }
    }
    let mut into: BTreeMap<NodeId, Vec<ConnectionId>> = BTreeMap::new();
    for &index in slots {
        into.entry(graph.connections[index].to.node).or_default().push(index);
    }
    let leaves_program = |node: NodeId| matches!(graph.nodes[node].kind, NodeKind::Boundary(_));
    let connections = graph.connections.iter().zip(live);
    let mut may_block: IdVec<ConnectionId, bool> =
        connections.map(|(c, live)| *live && !graph.is_synchronous(c)).collect();
    let mut served: Vec<NodeId> = consumers.filter(|n| waits[*n] == 0 && !leaves_program(*n)).collect();
    while let Some(node) = served.pop() {
        for &index in into.get(&node).into_iter().flatten() {
            may_block[index] = false;
            for &node in waiting.get(&index).into_iter().flatten() {
                waits[node] -= 1;
                if waits[node] == 0 {
                    served.push(node);
                }
            }
        }
    }
    may_block
}

/// Number of calls of slots, if each token that no slot causes is followed by all slots that it may reach.
fn count_calls(slots: &[ConnectionId], causes: &IdVec<ConnectionId, Vec<ConnectionId>>) -> usize {
    let is_slot = |c: &&ConnectionId| slots.binary_search(c).is_ok();
    let caused: BTreeSet<ConnectionId> = slots.iter().flat_map(|c| &causes[*c]).copied().collect();
    let mut calls = 0;
    for first in slots.iter().filter(|c| !caused.contains(c)) {
        let mut reached = BTreeSet::from([*first]);
        let mut left = vec![*first];
        while let Some(slot) = left.pop() {
            left.extend(causes[slot].iter().filter(is_slot).filter(|c| reached.insert(**c)));
        }
        calls += reached.len();
        if calls > MOST_UNQUEUED {
            break;
        }
    }
    calls
}

/// Returns `true` if each step sends at most one token to a slot, and each slot is ready when its token arrives. A step
/// is a firing of a region (all its clusters), a slot call, a timeout, a token from outside, or the start.
fn is_single(
    graph: &Graph,
    catalog: &Catalog,
    links: &Links,
    slots: &[ConnectionId],
    causes: &IdVec<ConnectionId, Vec<ConnectionId>>,
    regions: &IdVec<NodeId, usize>,
) -> bool {
    let to_slot = |c: &ConnectionId| slots.binary_search(c).is_ok();
    // The slot takes the token away, so no other connection may need it.
    let alone = |c: &ConnectionId| {
        let from = graph.connections[*c].from;
        links.from(from.node).filter(|other| graph.connections[*other].from == from).count() == 1
    };
    let mut by_region: BTreeMap<usize, usize> = BTreeMap::new();
    let mut at_start = 0;
    for &index in slots {
        let c = &graph.connections[index];
        match &graph.nodes[c.from.node].kind {
            NodeKind::Start => at_start += 1,
            NodeKind::Boundary(PortKind::Slot) | NodeKind::Receiver(_) | NodeKind::SetBack => {}
            NodeKind::Library(library) if !by_process(&catalog.signatures[library.signature], graph, c.from) => {}
            _ => *by_region.entry(regions[c.from.node]).or_default() += 1,
        }
        // Three cases are excluded: slots that may have to wait, for a region or for a port of the program; `reset` and
        // `cancel`, which may send several tokens; standard events, which come in addition to other tokens.
        let held_back = events(graph, links, c.to.node).any(|c| graph.flow(&graph.connections[c]) == Flow::ToInput);
        let leaves = matches!(graph.nodes[c.to.node].kind, NodeKind::Boundary(_)) || moves_activity(graph, c.to.node);
        let standard = graph.port(c.from).standard.is_some();
        if !alone(&index) || held_back || leaves || standard || causes[index].iter().filter(|c| to_slot(c)).count() > 1
        {
            return false;
        }
    }
    at_start <= 1 && by_region.values().all(|count| *count <= 1)
}

/// Returns `true` if something leads to itself, directly or over others: for tokens and those that they cause, one can
/// circulate while time does not advance.
pub fn has_circle<I: From<usize> + Into<usize> + Copy>(next: &IdVec<I, Vec<I>>) -> bool {
    // A topological sort: what remains is on a circle, or behind one.
    let mut waits = IdVec::<I, usize>::from_elem(0, next.len());
    next.iter().flatten().for_each(|to| waits[*to] += 1);
    let mut free: Vec<I> = next.ids().filter(|from| waits[*from] == 0).collect();
    let mut seen = 0;
    while let Some(from) = free.pop() {
        seen += 1;
        for &to in &next[from] {
            waits[to] -= 1;
            if waits[to] == 0 {
                free.push(to);
            }
        }
    }
    seen < next.len()
}

/// Connections on which a token may be sent because of a token on `connection`.
fn caused(graph: &Graph, catalog: &Catalog, links: &Links, connection: ConnectionId) -> Vec<ConnectionId> {
    let to = graph.connections[connection].to;
    let node = &graph.nodes[to.node];
    let by_process = graph.port(to).kind == PortKind::Input;
    let sends = |port: usize| match (&node.kind, node.ports[port].kind, node.ports[port].standard) {
        // A delay sends its token in a later iteration, and a timeout comes at a later time.
        (NodeKind::Delay(_), ..) => false,
        (NodeKind::Interrupt(_), ..) => Standard::Cancel.is_of_interrupt(to.port),
        (_, _, Some(Standard::Timeout)) => false,
        (_, _, Some(Standard::Processed)) => by_process,
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
    let own = links.from(to.node).filter(|c| sends(graph.connections[*c].from.port));
    own.chain(sent_with_activity(graph, to.node)).collect()
}

/// Storage of the order of slot tokens.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Delivery {
    /// A queue.
    Queued,
    /// None: at most one token is in flight. It may circulate.
    Single,
    /// None: each step is followed by the slots that its tokens can reach, in an order that is known at compile time.
    Ordered,
}
