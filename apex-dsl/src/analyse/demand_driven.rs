//! Sources without a period that fire together with the consumers of their tokens.
//!
//! Such a source could fire once per reaction. But if its token is joined with the token of a timer, this would be too
//! early: the token would wait, and the value would be older than necessary. So the source, and the nodes between it
//! and the join, get the guards of the join. With `scan -> fit.scan` and `latch -> fit.pose`, where `scan` has a
//! period, `latch` gets the timer of `scan` as its guard. All three nodes form one cluster, and `latch` sends the value
//! that it holds when the scan arrives.
//!
//! Several consumers must agree. With guards {1} and {1, 2}, the source fires under guard 1, and the second consumer
//! waits for guard 2 with the token. With guards {1} and {2} neither is right, and the source fires once per reaction.
//!
//! The tokens at a boundary of a nested graph are taken together, so that the nodes behind it that take other tokens
//! count as consumers, too: a source that waited for an event which one of them sends would wait forever.

use super::{cluster::Guard, view::View};
use crate::{
    graph::{Crossing, NodeId, NodeKind},
    index::IdVec,
};
use std::collections::{BTreeMap, BTreeSet};

/// Connected nodes without any guards upstream, and the nodes that take their tokens.
#[derive(Debug)]
pub struct DemandDriven {
    /// Nodes, which fire together.
    pub nodes: BTreeSet<NodeId>,
    /// Consumers of their tokens outside the group. Each has guards.
    pub consumers: BTreeSet<NodeId>,
}

impl DemandDriven {
    /// Guards of the taker with the fewest, if all other takers have these guards, too. `None` if they have not, or if
    /// these guards are only [`Guard::Events`]: room for events does not determine a time.
    pub fn guards(&self, guards: &[Guard], accumulated: &IdVec<NodeId, BTreeSet<usize>>) -> Option<BTreeSet<usize>> {
        let sets = || self.consumers.iter().map(|consumer| &accumulated[*consumer]);
        let least = sets().min_by_key(|set| set.len())?;
        let has_pace = least.iter().any(|guard| !matches!(guards[*guard], Guard::Events(_)));
        (has_pace && sets().all(|set| least.is_subset(set))).then(|| least.clone())
    }
}

/// Groups of nodes that could fire with their takers, because nothing else observes the time of their firings. `above`
/// holds the guards upstream of each node.
pub fn demand_driven(view: &View<'_>, above: &IdVec<NodeId, BTreeSet<usize>>) -> Vec<DemandDriven> {
    let is_free = |node: &NodeId| above[*node].is_empty() && view.fires(*node);
    let behind = behind(view);
    let mut seen: BTreeSet<NodeId> = BTreeSet::new();
    let mut found = vec![];
    for node in view.graph.nodes.ids().filter(is_free) {
        if !seen.contains(&node) {
            let together = together(view, &behind, node, &is_free);
            seen.extend(&together.nodes);
            if !together.consumers.is_empty() && together.nodes.iter().all(|n| is_unnoticed(view, *n)) {
                found.push(together);
            }
        }
    }
    found
}

/// Nodes that take the tokens of each boundary.
type Behind = BTreeMap<Crossing, BTreeSet<NodeId>>;

fn behind(view: &View<'_>) -> Behind {
    let mut behind = Behind::new();
    for c in view.links.out_of.iter().flatten().map(|c| &view.graph.connections[*c]) {
        for crossing in &c.crossings {
            behind.entry(*crossing).or_default().insert(c.to.node);
        }
    }
    behind
}

/// Group of all free nodes that are connected with `node`.
fn together(view: &View<'_>, behind: &Behind, node: NodeId, is_free: &impl Fn(&NodeId) -> bool) -> DemandDriven {
    let mut group = DemandDriven { nodes: BTreeSet::new(), consumers: BTreeSet::new() };
    let (mut ends, mut crossed) = (vec![node], BTreeSet::new());
    while let Some(node) = ends.pop() {
        if !group.nodes.insert(node) {
            continue;
        }
        // Nodes upstream of a free node are free, too: guards are passed downstream.
        let from = view.links.into[node].iter().map(|c| view.graph.connections[*c].from.node);
        ends.extend(from);
        for c in view.links.out_of[node].iter().map(|c| &view.graph.connections[*c]) {
            let new = c.crossings.iter().filter(|crossing| crossed.insert(**crossing));
            let beside = new.filter_map(|crossing| behind.get(crossing)).flatten().copied();
            for to in beside.chain([c.to.node]) {
                if is_free(&to) {
                    ends.push(to);
                } else if view.fires(to) {
                    group.consumers.insert(to);
                }
            }
        }
    }
    group
}

/// Returns `true` if only the consumers of its synchronous tokens can observe when a node fires.
fn is_unnoticed(view: &View<'_>, node: NodeId) -> bool {
    let is_library = matches!(view.graph.nodes[node].kind, NodeKind::Library(_));
    is_library && view.links.sends[node].is_empty() && !view.links.out_of[node].is_empty()
}
