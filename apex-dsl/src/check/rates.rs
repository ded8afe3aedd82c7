//! Regions whose nodes fire at different rates, and sources that others slow down.

use crate::{
    analyse::{Analysis, has_rates},
    graph::{Connection, Graph, NodeId, NodeKind, PortId},
    report::{Diagnostic, Diagnostics},
    syntax::tree::PortKind,
};
use std::collections::BTreeSet;

/// Reports connections and ports that would have to hold several tokens of an iteration, also in the bodies of a graph.
pub fn check_rates(graph: &Graph, analysis: &Analysis, diagnostics: &mut Diagnostics) {
    check_regions(graph, analysis, diagnostics);
    for (id, node) in graph.nodes.iter_enumerated() {
        if let (NodeKind::Each(each), Some(body)) = (&node.kind, analysis.bodies.get(&id)) {
            check_rates(&each.body, body, diagnostics);
        }
    }
}

/// Warns of sources that fire less often than their `every` says, because they are joined with slower ones.
pub fn check_periods(graph: &Graph, analysis: &Analysis, diagnostics: &mut Diagnostics) {
    for throttled in analysis.throttled(graph) {
        let (node, slowest, [own, real]) =
            (&graph.nodes[throttled.node], &graph.nodes[throttled.slowest], throttled.periods);
        let name = graph.path(throttled.slowest);
        let message =
            format!("`{}` fires every {real:?} instead of every {own:?}: it is joined with `{name}`", node.name);
        let warning = Diagnostic::warning("throttled", node.span, message)
            .also(slowest.span, format!("every {real:?}"))
            .note(format!(
                "send its values through a `Latest` or `Latch`: `{} -> newest.set;`, and `newest` to the join",
                node.name
            ));
        diagnostics.push(warning.inside(graph.scope_path(node.scope)));
    }
}

fn check_regions(graph: &Graph, analysis: &Analysis, diagnostics: &mut Diagnostics) {
    let regions: BTreeSet<usize> =
        graph.nodes.ids().filter(|n| has_rates(graph, analysis, *n)).map(|n| analysis.regions[n]).collect();
    for cluster in analysis.clusters.iter().filter(|c| regions.contains(&c.region)) {
        for &node in cluster.nodes.iter().filter(|node| analysis.repetitions[**node] > 1) {
            check_boundary(graph, analysis.repetitions[node], node, diagnostics);
        }
    }
    for connection in &graph.connections {
        let is_meant = |end: PortId| regions.contains(&analysis.regions[end.node]);
        if is_meant(connection.from) || is_meant(connection.to) {
            check_connection(graph, analysis, connection, diagnostics);
        }
    }
}

/// Reports a port of the graph that would have to hold several tokens.
fn check_boundary(graph: &Graph, count: u64, node: NodeId, diagnostics: &mut Diagnostics) {
    let n = &graph.nodes[node];
    let message = match &n.kind {
        NodeKind::Boundary(PortKind::Input) if !graph.is_body => {
            format!("one iteration would take {count} tokens from the input `{}`, which holds one", n.name)
        }
        NodeKind::Boundary(_) if graph.is_body => {
            format!("one element of an `each` would have {count} tokens at `{}`, which holds one", n.name)
        }
        _ => return,
    };
    diagnostics.push(Diagnostic::error("rates", n.span, message));
}

/// Reports a connection that holds one token where an iteration sends or takes several. The tokens of an iteration have
/// room only between nodes that fire together.
fn check_connection(graph: &Graph, analysis: &Analysis, c: &Connection, diagnostics: &mut Diagnostics) {
    let tokens = |end: PortId| match graph.port(end).kind {
        PortKind::Slot => 1,
        _ => analysis.repetitions[end.node] * graph.port(end).rate as u64,
    };
    let is_synchronous = graph.is_synchronous(c);
    let apart = is_synchronous && analysis.cluster_of[c.from.node] != analysis.cluster_of[c.to.node];
    let (several, does) = match (tokens(c.from), tokens(c.to)) {
        (1, 1) => return,
        (1, _) => (c.to, "takes"),
        _ => (c.from, "sends"),
    };
    let why = match () {
        () if apart => "a connection to nodes with another timer holds one token",
        () if !is_synchronous => "a connection with an event or a slot holds one token",
        () if c.active => "`=>` passes activity on with one token",
        () => return,
    };
    let name = graph.end_name(several);
    let message = format!("`{name}` {does} {} tokens in one iteration, but {why}", tokens(several));
    diagnostics.push(Diagnostic::error("rates", c.span, message));
}
