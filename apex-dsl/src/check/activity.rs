//! Activity that never arrives, or never leaves (execution semantics, section 5).

use crate::{
    analyse::{active_nodes, active_nodes_within},
    catalog::Catalog,
    graph::{Graph, NodeId, NodeKind},
    report::{Diagnostic, Diagnostics},
};
use std::collections::BTreeSet;

/// Reports nodes whose active connections can never carry activity, and nodes that hold it although it looks as if
/// they were meant to pass it on.
pub fn check_activity(graph: &Graph, catalog: &Catalog, diagnostics: &mut Diagnostics) {
    if graph.is_body || graph.is_open {
        return;
    }
    // Nobody is around a robot; a graph may get its activity from the one that uses it.
    let reached = if graph.robot { active_nodes(graph) } else { active_nodes_within(graph) };
    let mut named = BTreeSet::new();
    // Activity goes into a delay only because it goes on from there.
    let is_delay = |node: NodeId| graph.nodes[node].is_delay();
    for c in graph.connections.iter().filter(|c| c.active && !is_delay(c.to.node)) {
        let node = c.from.node;
        // A node that takes activity away does so without any of its own.
        let takes_away =
            matches!(&graph.nodes[node].kind, NodeKind::Library(l) if catalog.signatures[l.signature].deactivates);
        if takes_away || !graph.can_hold_activity(node) || reached.contains(&node) || !named.insert(node) {
            continue;
        }
        let held = graph.connections.iter().find(|c| c.to.node == node).filter(|_| is_delay(node));
        let node = held.map_or(node, |c| c.from.node);
        let message = format!("`{}` is never activated: this `=>` never carries activity", graph.path(node));
        let warning = Diagnostic::warning("never-activated", c.span, message).note(match sources(graph, node) {
            Some(from) => format!("activity would have to come from `{from}`, which is never activated either"),
            None => format!("activity begins at `start`: write `start => {};`, or `=>` towards it", graph.path(node)),
        });
        diagnostics.push(warning);
    }
    for &node in &reached {
        let n = &graph.nodes[node];
        let out: Vec<_> = graph.connections.iter().filter(|c| c.from.node == node).collect();
        if out.is_empty() || out.iter().any(|c| c.active) {
            continue;
        }
        let message =
            format!("activity that enters `{}` can never leave: all its connections are `->`", graph.path(node));
        diagnostics.push(
            Diagnostic::warning("never-leaves", n.span, message)
                .also(out[0].span, "for example this one")
                .note("write `=>` where activity is to go on"),
        );
    }
}

/// A node from which activity would have to come.
fn sources(graph: &Graph, node: NodeId) -> Option<String> {
    let from = graph.connections.iter().find(|c| c.active && c.to.node == node)?;
    Some(graph.path(from.from.node))
}
