//! Nodes without a pace of their own whose tokens others take at theirs: they fire with them, so that what they send is
//! not older than it has to be.

use super::clusters::{Guard, View};
use crate::graph::{NodeId, NodeKind};
use std::collections::BTreeSet;

/// Nodes that depend on nothing that sets a pace, with those between them, and who takes what they send.
#[derive(Debug)]
pub struct Pulled {
    /// They fire together.
    pub nodes: BTreeSet<NodeId>,
    /// Who takes their tokens; all of these have guards.
    pub takers: BTreeSet<NodeId>,
}

impl Pulled {
    /// The guards of the taker that depends on the least: all others depend on these, too. `None` if there is none, or if it
    /// has no pace: room for its events is there all the time.
    pub fn guards(&self, guards: &[Guard], accumulated: &[BTreeSet<usize>]) -> Option<BTreeSet<usize>> {
        let sets = || self.takers.iter().map(|taker| &accumulated[*taker]);
        let least = sets().min_by_key(|set| set.len())?;
        let has_pace = least.iter().any(|guard| !matches!(guards[*guard], Guard::Events(_)));
        (has_pace && sets().all(|set| least.is_subset(set))).then(|| least.clone())
    }
}

/// What could fire with its takers, if `above` are the guards that each node depends on: nobody else may notice when it does.
pub fn pulled(view: &View<'_>, above: &[BTreeSet<usize>]) -> Vec<Pulled> {
    let is_free = |node: &NodeId| above[*node].is_empty() && view.fires(*node);
    let mut seen: BTreeSet<NodeId> = BTreeSet::new();
    let mut found = vec![];
    for node in (0..view.graph.nodes.len()).filter(is_free) {
        if !seen.contains(&node) {
            let together = together(view, node, &is_free);
            seen.extend(&together.nodes);
            if !together.takers.is_empty() && together.nodes.iter().all(|n| is_unnoticed(view, *n)) {
                found.push(together);
            }
        }
    }
    found
}

/// All free nodes that hang together with `node`.
fn together(view: &View<'_>, node: NodeId, is_free: &impl Fn(&NodeId) -> bool) -> Pulled {
    let mut group = Pulled { nodes: BTreeSet::new(), takers: BTreeSet::new() };
    let mut ends = vec![node];
    while let Some(node) = ends.pop() {
        if !group.nodes.insert(node) {
            continue;
        }
        let from = view.links.into[node].iter().map(|c| view.graph.connections[*c].from.node);
        ends.extend(from);
        for &c in &view.links.out_of[node] {
            let to = view.graph.connections[c].to.node;
            if is_free(&to) {
                ends.push(to);
            } else if view.fires(to) {
                group.takers.insert(to);
            }
        }
    }
    group
}

/// Whether only who takes its tokens can tell when a node fires.
fn is_unnoticed(view: &View<'_>, node: NodeId) -> bool {
    let is_library = matches!(view.graph.nodes[node].kind, NodeKind::Library(_));
    is_library && view.links.sends[node].is_empty() && !view.links.out_of[node].is_empty()
}
