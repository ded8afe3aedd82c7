//! Order in which slots take the tokens that a step sends. If it is known at compile time, the program needs no queue.
//!
//! The queue is simulated for each kind of step, as if all tokens that it may send were sent. With `a.e -> [b.s, c.s]`
//! and `b.f -> d.s`, the order is `b.s`, `c.s`, `d.s`. If `b` does not trigger `f`, the other two keep their order. So
//! the code of `a` tests and calls the three slots one after another. If the order of two tokens depends on the
//! presence of a third, the program has a queue.

use super::{
    analysis::Analysis,
    asynchronous::{Asynchronous, Delivery, events, moves_activity},
    links::Links,
};
use crate::graph::{ConnectionId, Flow, Graph, NodeId, NodeKind, PortId};
use std::collections::{BTreeSet, VecDeque};

/// Largest number of slots that may follow one step. For more, a queue takes less code.
const MAX_ORDERED: usize = 64;

/// Largest number of slots in a program without a queue, although several tokens may be in flight.
const MOST_ORDERED: usize = 128;

/// Returns `true` if slot tokens need no queue, although several of them may be in flight.
pub fn is_ordered(graph: &Graph, analysis: &Analysis) -> bool {
    let asynchronous = &analysis.asynchronous;
    let resets = graph.nodes.ids().any(|node| moves_activity(graph, node));
    let is_ordered = |sends: &Vec<ConnectionId>| ordered(graph, &analysis.links, asynchronous, sends).is_some();
    asynchronous.delivery == Delivery::Queued
        && asynchronous.slots.len() <= MOST_ORDERED
        && !asynchronous.endless
        && !resets
        && !asynchronous.slots.iter().any(|c| asynchronous.may_block[*c])
        && all_alone(graph, asynchronous)
        && steps(graph, analysis).iter().all(is_ordered)
}

/// Returns `true` if tokens that go to slots go nowhere else, so that the last slot can take them away.
fn all_alone(graph: &Graph, asynchronous: &Asynchronous) -> bool {
    let sent: BTreeSet<PortId> = asynchronous.slots.iter().map(|c| graph.connections[*c].from).collect();
    graph.connections.iter_enumerated().all(|(i, c)| asynchronous.is_slot(i) || !sent.contains(&c.from))
}

/// Connections that each kind of step may send on, in the order in which tokens are emitted.
pub fn steps(graph: &Graph, analysis: &Analysis) -> Vec<Vec<ConnectionId>> {
    let firings = analysis.clusters.iter().map(|c| c.sends.clone());
    let alone = |node: &NodeId| {
        let n = &graph.nodes[*node];
        let is_timed = n.modifiers.timeout.is_some() || n.ports.iter().any(|port| port.comes_with_time);
        matches!(n.kind, NodeKind::Boundary(_) | NodeKind::Receiver(_)) || is_timed
    };
    let nodes = graph.nodes.ids().filter(alone).map(|node| analysis.links.sends[node].clone());
    firings.chain(nodes).chain([at_start(graph, analysis)]).collect()
}

/// Connections that the start of a program may send on, in the order in which tokens are emitted.
pub fn at_start(graph: &Graph, analysis: &Analysis) -> Vec<ConnectionId> {
    let starts = |c: &ConnectionId| {
        let from = graph.connections[*c].from;
        let node = &graph.nodes[from.node];
        matches!(node.kind, NodeKind::Start) || node.starts_active && graph.port(from).tells_of_activity()
    };
    analysis.links.sends.iter().flatten().copied().filter(starts).collect()
}

/// Slot tokens that follow a step which may have sent on `sends`, in the order in which they are taken. The first token
/// whose slot can be called is taken first; the others keep their places. `None` if the order depends on which tokens
/// were really sent.
pub fn ordered(
    graph: &Graph,
    links: &Links,
    asynchronous: &Asynchronous,
    sends: &[ConnectionId],
) -> Option<Vec<ConnectionId>> {
    let mut queue: VecDeque<ConnectionId> = sends.iter().copied().filter(|c| asynchronous.is_slot(*c)).collect();
    let mut order = vec![];
    while !queue.is_empty() {
        let taken = queue.remove(next(graph, links, &queue)?)?;
        order.push(taken);
        let follow = asynchronous.caused_slots(taken);
        let from = graph.connections[taken].from;
        // Code without a queue calls the slots of one port in the order of its connections, and the last one takes the
        // token away. A token may not be sent again before it was taken.
        let overtakes = queue.iter().any(|c| *c < taken && graph.connections[*c].from == from);
        if overtakes || order.len() > MAX_ORDERED || follow.clone().any(|c| queue.contains(&c)) {
            return None;
        }
        queue.extend(follow);
    }
    Some(order)
}

/// Position in the queue of the token that is taken next, whichever others are absent. A slot waits until the events of
/// its node are taken (R5). If the first token waits, the second must be the one that it waits for. `None` if the
/// position is not certain.
fn next(graph: &Graph, links: &Links, queue: &VecDeque<ConnectionId>) -> Option<usize> {
    let waits_for = |c: ConnectionId| {
        let events: Vec<ConnectionId> = events(graph, links, graph.connections[c].to.node).collect();
        let may_block = events.iter().any(|c| graph.flow(&graph.connections[*c]) != Flow::ToSlot);
        let leaves = matches!(graph.nodes[graph.connections[c].to.node].kind, NodeKind::Boundary(_));
        (!may_block && !leaves).then_some(events)
    };
    let held_back = |events: &[ConnectionId]| queue.iter().any(|c| events.contains(c));
    let first = waits_for(queue[0])?;
    if !held_back(&first) {
        return Some(0);
    }
    let second = *queue.get(1)?;
    (first.contains(&second) && !held_back(&waits_for(second)?)).then_some(1)
}
