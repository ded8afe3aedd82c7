//! In which order the tokens that a step sends to slots are taken: where that can be told before the program runs, it needs
//! no queue.

use super::{Analysis, Asynchronous, Links, asynchronous::events};
use crate::graph::{End, Flow, Graph, NodeKind};
use std::collections::{BTreeSet, VecDeque};

/// How slot tokens are kept in their order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Delivery {
    /// In a queue.
    Queued,
    /// Never more than one is under way, though perhaps in a circle.
    Single,
    /// Each step is followed by the slots that its tokens can come to, in an order that the text decides.
    Ordered,
}

/// Most slots that may follow one step, before a queue takes less code.
const MAX_ORDERED: usize = 64;

/// Whether the order of slots needs no queue, although several of them may be under way.
pub fn is_ordered(graph: &Graph, analysis: &Analysis) -> bool {
    let asynchronous = &analysis.asynchronous;
    let resets = graph.nodes.iter().any(|n| matches!(n.kind, NodeKind::Reset));
    let is_ordered = |sends: &Vec<usize>| ordered(graph, &analysis.links, asynchronous, sends).is_some();
    asynchronous.delivery == Delivery::Queued
        && !asynchronous.is_tabled
        && !asynchronous.endless
        && !resets
        && !asynchronous.slots.iter().any(|c| asynchronous.stays[*c])
        && all_alone(graph, asynchronous)
        && steps(graph, analysis).iter().all(is_ordered)
}

/// Whether what is sent to slots is sent to nothing else, so that the last slot can take it away.
fn all_alone(graph: &Graph, asynchronous: &Asynchronous) -> bool {
    let sent: BTreeSet<End> = asynchronous.slots.iter().map(|c| graph.connections[*c].from).collect();
    graph.connections.iter().enumerate().all(|(i, c)| asynchronous.is_slot(i) || !sent.contains(&c.from))
}

/// The connections that each kind of step may send on, in the order in which they are emitted.
fn steps(graph: &Graph, analysis: &Analysis) -> Vec<Vec<usize>> {
    let firings = analysis.clusters.iter().map(|c| c.sends.clone());
    let alone = |node: &usize| {
        let n = &graph.nodes[*node];
        matches!(n.kind, NodeKind::Boundary(_) | NodeKind::Receiver(_)) || n.modifiers.timeout.is_some()
    };
    let nodes = (0..graph.nodes.len()).filter(alone).map(|node| analysis.links.sends[node].clone());
    firings.chain(nodes).chain([at_start(graph, analysis)]).collect()
}

/// The connections that the start of a program may send on, in the order in which they are emitted.
pub fn at_start(graph: &Graph, analysis: &Analysis) -> Vec<usize> {
    let starts = |c: &usize| {
        let from = graph.connections[*c].from;
        let node = &graph.nodes[from.node];
        matches!(node.kind, NodeKind::Start) || node.starts_active && graph.port(from).tells_of_activity()
    };
    analysis.links.sends.iter().flatten().copied().filter(starts).collect()
}

/// The slot tokens that follow when a step may have sent on `sends`, in the order in which they are taken (execution
/// semantics, section 4), whichever of them were really sent; `None` if it depends on that.
pub fn ordered(graph: &Graph, links: &Links, asynchronous: &Asynchronous, sends: &[usize]) -> Option<Vec<usize>> {
    let mut queue: VecDeque<usize> = sends.iter().copied().filter(|c| asynchronous.is_slot(*c)).collect();
    let mut order = vec![];
    while !queue.is_empty() {
        let taken = queue.remove(next(graph, links, &queue)?)?;
        order.push(taken);
        let follow = asynchronous.caused_slots(taken);
        let from = graph.connections[taken].from;
        let overtakes = queue.iter().any(|c| *c < taken && graph.connections[*c].from == from);
        if overtakes || order.len() > MAX_ORDERED || follow.clone().any(|c| queue.contains(&c)) {
            return None;
        }
        queue.extend(follow);
    }
    Some(order)
}

/// The place in the queue of the token that is taken next, wherever others of them are missing. A slot waits for its node's
/// events to be taken (R5): while the first token does, the second must be what it waits for.
fn next(graph: &Graph, links: &Links, queue: &VecDeque<usize>) -> Option<usize> {
    let waits_for = |c: usize| {
        let events: Vec<usize> = events(graph, links, graph.connections[c].to.node).collect();
        let stays = events.iter().any(|c| graph.flow(&graph.connections[*c]) != Flow::ToSlot);
        let leaves = matches!(graph.nodes[graph.connections[c].to.node].kind, NodeKind::Boundary(_));
        (!stays && !leaves).then_some(events)
    };
    let held_back = |events: &[usize]| queue.iter().any(|c| events.contains(c));
    let first = waits_for(queue[0])?;
    if !held_back(&first) {
        return Some(0);
    }
    let second = *queue.get(1)?;
    (first.contains(&second) && !held_back(&waits_for(second)?)).then_some(1)
}
