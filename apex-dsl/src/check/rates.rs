//! Regions whose nodes fire at different rates.

use crate::{
    analyse::{Analysis, has_rates},
    graph::{Graph, NodeId, NodeKind, PortId},
    report::{Diagnostic, Diagnostics},
    syntax::tree::PortKind,
};
use std::collections::BTreeSet;

/// Reports everything in regions with several rates for which no code can be generated, also in the bodies of a graph.
pub fn check_rates(graph: &Graph, analysis: &Analysis, diagnostics: &mut Diagnostics) {
    check_regions(graph, analysis, diagnostics);
    for (id, node) in graph.nodes.iter().enumerate() {
        if let (NodeKind::Each(each), Some(body)) = (&node.kind, analysis.bodies.get(&id)) {
            check_rates(&each.body, body, diagnostics);
        }
    }
}

fn check_regions(graph: &Graph, analysis: &Analysis, diagnostics: &mut Diagnostics) {
    let regions: BTreeSet<usize> =
        (0..graph.nodes.len()).filter(|n| has_rates(graph, analysis, *n)).map(|n| analysis.regions[n]).collect();
    for (index, cluster) in analysis.clusters.iter().enumerate().filter(|(_, c)| regions.contains(&c.region)) {
        let first = cluster.nodes.iter().min().copied().unwrap_or(0);
        if !cluster.upstream.is_empty() || !cluster.downstream.is_empty() {
            let message =
                "all nodes of a region with several rates must fire together: only one source can have its own timer";
            diagnostics.push(Diagnostic::error("rates", graph.nodes[first].span, message));
        }
        for &node in &analysis.clusters[index].nodes {
            let n = &graph.nodes[node];
            let count = analysis.repetitions[node];
            let message = match &n.kind {
                NodeKind::Boundary(PortKind::Input) if count > 1 && !graph.is_body => {
                    format!("one iteration would take {count} tokens from the input `{}`, which holds one", n.name)
                }
                _ if graph
                    .connections
                    .iter()
                    .any(|c| (c.active || !graph.is_synchronous(c)) && (c.from.node == node || c.to.node == node)) =>
                {
                    format!(
                        "`{}` is in a region with several rates, where events, slots and `=>` cannot be connected",
                        n.name
                    )
                }
                NodeKind::Each(_) => {
                    format!("`{}` is in a region with several rates, where `each` is not allowed", n.name)
                }
                NodeKind::Boundary(_) if graph.is_body => "the body of an `each` cannot have several rates".to_owned(),
                NodeKind::Delay(initial) if (initial.len() as u64) < count => {
                    format!(
                        "a delay in a region with several rates must hold at least the tokens of one iteration: {count}, not {}",
                        initial.len()
                    )
                }
                NodeKind::Library(_)
                    if n.ports.iter().any(|p| p.parameter.is_some() && is_connected(graph, node, p.parameter)) =>
                {
                    format!("parameters of `{}` cannot be connected in a region with several rates", n.name)
                }
                _ => continue,
            };
            diagnostics.push(Diagnostic::error("rates", n.span, message));
        }
    }
}

fn is_connected(graph: &Graph, node: NodeId, parameter: Option<usize>) -> bool {
    let at = |end: PortId| end.node == node && graph.port(end).parameter == parameter;
    graph.connections.iter().any(|c| at(c.from) || at(c.to))
}
