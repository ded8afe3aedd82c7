//! Presence as clocks: a node fires when certain tokens that may be ⊥ are not. As in synchronous languages the
//! tests are shared and become control flow (clock-directed code generation).

use super::{Links, is_told, may_be_missing};
use crate::{
    catalog::Catalog,
    graph::{End, Graph, NodeId, NodeKind},
};
use std::collections::BTreeSet;

/// The tokens that must be present for a node to fire, without those that others imply.
pub type Clock = BTreeSet<End>;

/// The clock of each node within its cluster.
pub fn clocks(graph: &Graph, catalog: &Catalog, links: &Links, order: &[NodeId], cluster_of: &[usize]) -> Vec<Clock> {
    let mut clocks: Vec<Clock> = vec![Clock::new(); graph.nodes.len()];
    for &node in order {
        let mut clock = Clock::new();
        if !fires_always(graph, catalog, node) {
            for &index in &links.inputs[node] {
                let c = &graph.connections[index];
                if !is_mandatory(graph, c.to) {
                    continue;
                }
                // What another cluster left is always looked at: it may be ⊥.
                let outside = cluster_of[c.from.node] != cluster_of[node] || !graph.is_synchronous(c);
                clock.extend(if outside { Clock::from([c.from]) } else { presence(graph, catalog, &clocks, c.from) });
            }
        }
        if clock.len() > 1 {
            clock = reduce(&clocks, cluster_of, cluster_of[node], clock);
        }
        clocks[node] = clock;
    }
    clocks
}

/// Whether a node does something in every firing of its cluster: it is told of ⊥ (R3), or it is a place that
/// ⊥ is written to as any other token.
fn fires_always(graph: &Graph, catalog: &Catalog, node: NodeId) -> bool {
    matches!(graph.nodes[node].kind, NodeKind::Delay(_) | NodeKind::Boundary(_)) || is_told(graph, catalog, node)
}

/// Whether ⊥ at this input keeps the node from firing.
pub fn is_mandatory(graph: &Graph, input: End) -> bool {
    !graph.port(input).optional
}

/// What must be present for the token at `from` to be present, seen from its own cluster.
pub fn presence(graph: &Graph, catalog: &Catalog, clocks: &[Clock], from: End) -> Clock {
    if may_be_missing(graph, catalog, from) { Clock::from([from]) } else { clocks[from.node].clone() }
}

/// Removes what others imply: a token is present only if its node fired.
fn reduce(clocks: &[Clock], cluster_of: &[usize], cluster: usize, clock: Clock) -> Clock {
    let implied = implied(clocks, cluster_of, cluster, &clock);
    clock.into_iter().filter(|token| !implied.contains(token)).collect()
}

/// Everything that is present if `clock` is, except `clock` itself where nothing else implies it.
pub fn implied(clocks: &[Clock], cluster_of: &[usize], cluster: usize, clock: &Clock) -> BTreeSet<End> {
    let mut implied = BTreeSet::new();
    let mut stack: Vec<End> = clock.iter().copied().collect();
    while let Some(token) = stack.pop() {
        // A token from another cluster says nothing about tokens in this one.
        if cluster_of[token.node] != cluster {
            continue;
        }
        for &below in &clocks[token.node] {
            if implied.insert(below) {
                stack.push(below);
            }
        }
    }
    implied
}
