//! Balance equations (Lee 1987): the number of firings of each node in one iteration, with which each connection
//! carries as many tokens as are taken.
//!
//! If `a` sends 2 tokens per firing and `b` takes 3, `a` fires 3 times and `b` twice. On an undirected cycle of
//! connections the equations can contradict each other. Then there is no solution.

use super::{analysis::Analysis, cluster::ClusterId, links::Links};
use crate::{
    graph::{ConnectionId, Graph, NodeId},
    index::IdVec,
    report::{Diagnostic, Diagnostics},
};

/// Largest number of firings of a node per iteration. It also bounds the size of buffers.
pub const MAX_REPETITIONS: u64 = 100_000;

/// The smallest repetition vector. Reports a cycle of connections whose rates contradict each other.
pub fn repetitions(graph: &Graph, links: &Links, diagnostics: &mut Diagnostics) -> Option<IdVec<NodeId, u64>> {
    let mut rates: IdVec<NodeId, Option<(u64, u64)>> = IdVec::from_elem(None, graph.nodes.len());
    let mut reached: IdVec<NodeId, Option<ConnectionId>> = IdVec::from_elem(None, graph.nodes.len());
    let mut repetitions = IdVec::from_elem(1, graph.nodes.len());
    for start in graph.nodes.ids() {
        if rates[start].is_some() {
            continue;
        }
        // Fractions relative to the first node, by a breadth-first search through the region.
        rates[start] = Some((1, 1));
        let mut region = vec![start];
        let mut at = 0;
        while at < region.len() {
            let node = region[at];
            at += 1;
            for &index in links.into[node].iter().chain(&links.out_of[node]) {
                let c = &graph.connections[index];
                let (sent, taken) = (graph.port(c.from).rate as u64, graph.port(c.to).rate as u64);
                let (other, up, down) =
                    if c.from.node == node { (c.to.node, sent, taken) } else { (c.from.node, taken, sent) };
                let Some((n, d)) = rates[node] else { continue };
                let Some(rate) = scale((n, d), up, down) else {
                    too_many(graph, index, diagnostics);
                    return None;
                };
                match rates[other] {
                    None => {
                        rates[other] = Some(rate);
                        reached[other] = Some(index);
                        region.push(other);
                    }
                    Some(before) if before == rate => {}
                    Some(_) => {
                        contradiction(graph, index, node, &reached, diagnostics);
                        return None;
                    }
                }
            }
        }
        // The least common multiple of the denominators makes all fractions whole numbers.
        let common =
            region.iter().filter_map(|n| rates[*n]).try_fold(1u64, |lcm, (_, d)| (lcm / gcd(lcm, d)).checked_mul(d));
        let counts: Option<Vec<u64>> = common.and_then(|lcm| {
            region
                .iter()
                .map(|n| rates[*n].and_then(|(a, d)| a.checked_mul(lcm / d)))
                .map(|c| c.filter(|c| *c <= MAX_REPETITIONS))
                .collect()
        });
        let Some(counts) = counts else {
            too_many(graph, links.out_of[start].first().or(links.into[start].first()).copied()?, diagnostics);
            return None;
        };
        let divisor = counts.iter().fold(0, |g, c| gcd(g, *c)).max(1);
        for (node, count) in region.iter().zip(counts) {
            repetitions[*node] = count / divisor;
        }
    }
    Some(repetitions)
}

fn gcd(a: u64, b: u64) -> u64 {
    if b == 0 { a } else { gcd(b, a % b) }
}

fn scale((n, d): (u64, u64), up: u64, down: u64) -> Option<(u64, u64)> {
    let (n, d) = (n.checked_mul(up)?, d.checked_mul(down)?);
    let g = gcd(n, d);
    Some((n / g, d / g))
}

fn too_many(graph: &Graph, connection: ConnectionId, diagnostics: &mut Diagnostics) {
    let message = format!("one iteration would need more than {MAX_REPETITIONS} firings of a node");
    diagnostics.push(
        Diagnostic::error("rates", graph.connections[connection].span, message)
            .note("check the numbers of tokens per firing in this region"),
    );
}

fn contradiction(
    graph: &Graph,
    connection: ConnectionId,
    node: NodeId,
    reached: &IdVec<NodeId, Option<ConnectionId>>,
    diagnostics: &mut Diagnostics,
) {
    let c = &graph.connections[connection];
    let other = if c.from.node == node { c.to.node } else { c.from.node };
    let describe = |index: ConnectionId| {
        let c = &graph.connections[index];
        format!(
            "`{}` sends {} and `{}` takes {} per firing",
            graph.end_name(c.from),
            graph.port(c.from).rate,
            graph.end_name(c.to),
            graph.port(c.to).rate
        )
    };
    let mut path = vec![];
    for mut at in [node, other] {
        while let Some(index) = reached[at] {
            let c = &graph.connections[index];
            // Behind the node where both walks meet, they are the same: connections that occur twice are removed.
            if let Some(known) = path.iter().position(|p| *p == index) {
                path.remove(known);
            } else {
                path.push(index);
            }
            at = if c.to.node == at { c.from.node } else { c.to.node };
        }
    }
    path.sort_unstable();
    let nodes = |index: &ConnectionId| [graph.connections[*index].from.node, graph.connections[*index].to.node];
    let mut names: Vec<String> =
        path.iter().chain([&connection]).flat_map(nodes).map(|n| format!("`{}`", graph.path(n))).collect();
    names.sort();
    names.dedup();
    let message =
        format!("the rates of {} are inconsistent: tokens would pile up on a connection or run out", names.join(", "));
    let mut error = Diagnostic::error("rates", c.span, message).label(describe(connection));
    for index in path.iter().take(8) {
        error = error.also(graph.connections[*index].span, describe(*index));
    }
    diagnostics.push(error);
}

/// Returns `true` if a node in the region of a cluster has rates (see [`has_rates`]).
pub(super) fn is_multirate(graph: &Graph, analysis: &Analysis, cluster: ClusterId) -> bool {
    let region = analysis.clusters[cluster].region;
    graph.nodes.ids().any(|n| analysis.regions[n] == region && has_rates(graph, analysis, n))
}

/// Returns `true` if a node fires several times per iteration, or has a port for several tokens per firing.
pub fn has_rates(graph: &Graph, analysis: &Analysis, node: NodeId) -> bool {
    analysis.repetitions[node] != 1 || graph.nodes[node].ports.iter().any(|p| p.rate != 1 && p.kind.is_synchronous())
}
