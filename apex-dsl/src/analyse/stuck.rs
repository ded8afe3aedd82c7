//! Slot tokens that wait for one another forever: a node is not called before its events were taken (R5), so a cycle of
//! events to slots stands still as soon as a token waits at each of its nodes.
//!
//! One step of the program (a firing, a token from outside, a timeout) is followed until its slot tokens are gone, for
//! each event that a slot may trigger. Whether it does trigger it is not known: what is found is possible, not certain.

use super::{
    analysis::Analysis,
    asynchronous::{Delivery, events, has_circle},
    delivery::steps,
    links::Links,
};
use crate::{
    catalog::{ArgSig, Catalog},
    graph::{ConnectionId, Graph, NodeId, NodeKind},
    syntax::tree::PortKind,
};
use std::collections::{BTreeMap, BTreeSet};

/// Largest number of tokens in all queues that are visited.
const MAX_TOKENS: usize = 200_000;

/// A run to tokens that wait for one another.
#[derive(Debug)]
pub struct Stuck {
    /// The connections whose tokens are taken before, in order.
    pub run: Vec<ConnectionId>,
    /// Each waiting token, and the token that has to be taken before it.
    pub waits: Vec<(ConnectionId, ConnectionId)>,
}

/// Result of a search.
enum Found {
    Nothing,
    Stuck(Stuck),
    /// Nothing among as many queues as are visited.
    TooMany,
}

struct Visited {
    queue: Vec<ConnectionId>,
    /// The queue before, and the token that was taken from it.
    before: Option<(usize, ConnectionId)>,
}

/// Searches for a shortest run to tokens that wait for one another. Slots that ask whether their node is active are
/// taken to send nothing in it.
pub fn find(graph: &Graph, analysis: &Analysis, catalog: &Catalog) -> Option<Stuck> {
    match search(graph, analysis, &|token| asks_for_activity(graph, analysis, catalog, token)) {
        Found::Stuck(stuck) => Some(stuck),
        Found::Nothing | Found::TooMany => None,
    }
}

/// Returns `true` if tokens certainly never wait for one another, whatever their slots ask.
pub fn is_live(graph: &Graph, analysis: &Analysis) -> bool {
    // Threads take their steps at the same time.
    let meets = graph.has_several_groups() && is_cyclic(graph, &analysis.links);
    !meets && !is_possible(graph, analysis)
}

/// Returns `true` if tokens may wait for one another, whatever their slots ask.
pub fn is_possible(graph: &Graph, analysis: &Analysis) -> bool {
    !matches!(search(graph, analysis, &|_| false), Found::Nothing)
}

/// For each slot token, those that have to be taken before its slot can be called.
pub fn blockers(graph: &Graph, analysis: &Analysis) -> Vec<Vec<ConnectionId>> {
    let asynchronous = &analysis.asynchronous;
    let blockers = |connection: &ConnectionId| {
        let all = asynchronous.not_yet_taken(graph, &analysis.links, *connection);
        all.into_iter().filter(|other| asynchronous.is_slot(*other)).collect()
    };
    asynchronous.slots.iter().map(blockers).collect()
}

fn search(graph: &Graph, analysis: &Analysis, is_silent: &dyn Fn(ConnectionId) -> bool) -> Found {
    let asynchronous = &analysis.asynchronous;
    // Without a queue each slot is known to be ready when its token arrives.
    if asynchronous.delivery != Delivery::Queued || !is_cyclic(graph, &analysis.links) {
        return Found::Nothing;
    }
    let blockers = blockers(graph, analysis);
    let blocks = |waiting: &BTreeSet<ConnectionId>, token: ConnectionId| {
        blockers[asynchronous.slot(token)].iter().copied().find(|other| waiting.contains(other))
    };
    let mut known = BTreeSet::new();
    let mut visited: Vec<Visited> = vec![];
    for sends in steps(graph, analysis).into_iter().flat_map(|sends| sent_together(graph, &sends)) {
        let queue: Vec<ConnectionId> = sends.into_iter().filter(|c| asynchronous.is_slot(*c)).collect();
        if !queue.is_empty() && known.insert(queue.clone()) {
            visited.push(Visited { queue, before: None });
        }
    }
    let (mut at, mut tokens) = (0, 0);
    while at < visited.len() && tokens < MAX_TOKENS {
        let queue = visited[at].queue.clone();
        tokens += queue.len();
        let waiting = queue.iter().copied().collect();
        let Some(place) = (0..queue.len()).find(|place| blocks(&waiting, queue[*place]).is_none()) else {
            if queue.is_empty() {
                at += 1;
                continue;
            }
            let waits = queue.iter().filter_map(|token| Some((*token, blocks(&waiting, *token)?))).collect();
            return Found::Stuck(Stuck { run: run(&visited, at), waits });
        };
        let token = queue[place];
        let mut rest = queue;
        rest.remove(place);
        let silent = is_silent(token);
        let caused: Vec<ConnectionId> = asynchronous.caused_slots(token).filter(|_| !silent).collect();
        for sent in by_port(graph, &caused).into_iter().chain([vec![]]) {
            let queue = [rest.as_slice(), &sent].concat();
            if known.insert(queue.clone()) {
                visited.push(Visited { queue, before: Some((at, token)) });
            }
        }
        at += 1;
    }
    if at < visited.len() { Found::TooMany } else { Found::Nothing }
}

/// The tokens that were taken on the way to a queue.
fn run(visited: &[Visited], at: usize) -> Vec<ConnectionId> {
    let ways = std::iter::successors(visited[at].before, |(before, _)| visited[*before].before);
    let mut run: Vec<ConnectionId> = ways.map(|(_, token)| token).collect();
    run.reverse();
    run
}

/// Returns `true` if the slot at the end of a connection may ask whether its node is active. Such nodes are mostly
/// states, of which one is active: the others take the token, and send nothing.
fn asks_for_activity(graph: &Graph, analysis: &Analysis, catalog: &Catalog, connection: ConnectionId) -> bool {
    let to = graph.connections[connection].to;
    let NodeKind::Library(library) = &graph.nodes[to.node].kind else { return false };
    let slots = &catalog.signatures[library.signature].slots;
    let asks = slots.iter().find(|slot| slot.port == to.port).is_some_and(|slot| slot.args.contains(&ArgSig::Ctx));
    asks && analysis.active.contains(&to.node)
}

/// The connections on which tokens may be sent in one step: all outputs with at most one event of a node, and all of
/// `start`.
fn sent_together(graph: &Graph, sends: &[ConnectionId]) -> Vec<Vec<ConnectionId>> {
    let from = |connection: &ConnectionId| graph.connections[*connection].from;
    let is_event = |c: &ConnectionId| {
        graph.port(from(c)).kind == PortKind::Event && !matches!(graph.nodes[from(c).node].kind, NodeKind::Start)
    };
    let (events, always): (Vec<ConnectionId>, Vec<ConnectionId>) = sends.iter().copied().partition(is_event);
    let with_event = by_port(graph, &events).into_iter().map(|event| {
        let mut together = [always.as_slice(), &event].concat();
        together.sort_by_key(|c| sends.iter().position(|sent| sent == c));
        together
    });
    with_event.chain([always.clone()]).collect()
}

/// The connections of each port, whose tokens are sent together.
fn by_port(graph: &Graph, connections: &[ConnectionId]) -> Vec<Vec<ConnectionId>> {
    let mut ports: BTreeMap<_, Vec<ConnectionId>> = BTreeMap::new();
    for connection in connections {
        ports.entry(graph.connections[*connection].from).or_default().push(*connection);
    }
    ports.into_values().collect()
}

/// Returns `true` if events lead from a node to slots of others and back.
fn is_cyclic(graph: &Graph, links: &Links) -> bool {
    let next = |node: NodeId| events(graph, links, node).map(|c| graph.connections[c].to.node).collect();
    has_circle(&graph.nodes.ids().map(next).collect())
}
