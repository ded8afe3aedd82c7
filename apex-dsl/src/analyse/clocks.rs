//! Clocks: the tokens that must be present (not ⊥) for a node to fire.
//!
//! If each node tested its own inputs, a ⊥ would cost one branch per node. As in synchronous languages, nodes with the
//! same clock share one test (clock-directed code generation). With `gate -> f -> g`, where only `gate` may send ⊥, `f`
//! and `g` both have the clock {`gate.out`}: one `if` skips both. If `f` may send ⊥, too, the clock of `g` is
//! {`f.out`}. It need not contain `gate.out`, because `f` sends a value only if it fired.

use super::{
    cluster::ClusterId,
    firing::{handles_absence, may_be_missing},
    links::Links,
};
use crate::{
    catalog::Catalog,
    graph::{Graph, NodeId, NodeKind, PortId},
    index::IdVec,
};
use std::collections::BTreeSet;

/// Tokens that must be present for a node to fire, without those that others in the set imply.
pub type Clock = BTreeSet<PortId>;

/// Clock of each node, seen from its cluster. `order` has producers before consumers.
pub fn clocks(
    graph: &Graph,
    catalog: &Catalog,
    links: &Links,
    order: &[NodeId],
    cluster_of: &IdVec<NodeId, ClusterId>,
) -> IdVec<NodeId, Clock> {
    let mut clocks = IdVec::from_elem(Clock::new(), graph.nodes.len());
    for &node in order {
        let mut clock = Clock::new();
        if !fires_always(graph, catalog, node) {
            for &index in &links.inputs[node] {
                let c = &graph.connections[index];
                if !is_mandatory(graph, c.to) {
                    continue;
                }
                // A token that was not sent in this firing is always tested itself: it may be ⊥.
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

/// Returns `true` if a node acts in every firing of its cluster: it has a method for ⊥ (R3), or it stores ⊥ like any
/// other token.
fn fires_always(graph: &Graph, catalog: &Catalog, node: NodeId) -> bool {
    matches!(graph.nodes[node].kind, NodeKind::Delay(_) | NodeKind::Boundary(_))
        || handles_absence(graph, catalog, node)
}

/// Returns `true` if the node does not run with ⊥ at this input (R3).
pub fn is_mandatory(graph: &Graph, input: PortId) -> bool {
    !graph.port(input).optional
}

/// Tokens that must be present for the token at `from` to be present, seen from its own cluster.
pub fn presence(graph: &Graph, catalog: &Catalog, clocks: &IdVec<NodeId, Clock>, from: PortId) -> Clock {
    if may_be_missing(graph, catalog, from) { Clock::from([from]) } else { clocks[from.node].clone() }
}

/// Removes the tokens that others in the clock imply: a token is present only if its node fired.
fn reduce(
    clocks: &IdVec<NodeId, Clock>,
    cluster_of: &IdVec<NodeId, ClusterId>,
    cluster: ClusterId,
    clock: Clock,
) -> Clock {
    let implied = implied(clocks, cluster_of, cluster, &clock);
    clock.into_iter().filter(|token| !implied.contains(token)).collect()
}

/// All tokens that are present if those of `clock` are. A token of `clock` itself is among them only if another one
/// implies it.
pub fn implied(
    clocks: &IdVec<NodeId, Clock>,
    cluster_of: &IdVec<NodeId, ClusterId>,
    cluster: ClusterId,
    clock: &Clock,
) -> BTreeSet<PortId> {
    let mut implied = BTreeSet::new();
    let mut stack: Vec<PortId> = clock.iter().copied().collect();
    while let Some(token) = stack.pop() {
        // The clock of a node in another cluster refers to another firing.
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
