//! Modifiers that cannot work or have no effect.

use crate::{
    analyse::handles_absence,
    catalog::Catalog,
    graph::{Graph, NodeId, NodeKind},
    report::{Diagnostic, Diagnostics},
    syntax::tree::PortKind,
};
use std::collections::BTreeSet;

/// Reports timers of nodes that cannot have one, and `skip` and `essential` without effect.
pub fn check_modifiers(graph: &Graph, catalog: &Catalog, diagnostics: &mut Diagnostics) {
    let driven: BTreeSet<NodeId> =
        graph.connections.iter().filter(|c| graph.port(c.to).kind == PortKind::Input).map(|c| c.to.node).collect();
    for (id, node) in graph.nodes.iter_enumerated() {
        let word = if node.modifiers.every.is_some() { "every" } else { "after" };
        if node.modifiers.has_pace() && driven.contains(&id) {
            let message =
                format!("`{word}` sets the timer of a source, but `{}` fires when its inputs arrive", node.name);
            diagnostics.push(
                Diagnostic::error("every-on-driven", node.span, message)
                    .note(format!("write `{word}` after the source of its inputs")),
            );
        }
        if node.modifiers.has_pace() && graph.is_body {
            let message = format!(
                "`{}` is in the body of an `each`, which runs once per element: it cannot have a timer",
                node.name
            );
            diagnostics.push(
                Diagnostic::error("every-on-driven", node.span, message)
                    .note(format!("remove `{word}`, or move the source out of the body")),
            );
        }
        if node.modifiers.skip && node.modifiers.every.is_none() {
            let message =
                format!("`skip` has no effect on `{}`: it has no period whose firings it could miss", node.name);
            let error = Diagnostic::error("wrong-modifier", node.span, message);
            diagnostics.push(error.note("write `every` before it, as in `every 10ms skip`, or remove it"));
        }
        if node.modifiers.essential && !can_see_missing(graph, catalog, id) {
            let message = format!("`essential` has no effect on `{}`: the node cannot see ⊥", node.name);
            let warning = Diagnostic::warning("essential-without-hook", node.span, message)
                .note("an essential node takes `Option<&T>`, or has a method marked `#[no_message]`");
            diagnostics.push(warning);
        }
    }
}

fn can_see_missing(graph: &Graph, catalog: &Catalog, node: NodeId) -> bool {
    let optional =
        graph.nodes[node].ports.iter().any(|p| p.kind == PortKind::Input && p.optional && p.parameter.is_none());
    optional || handles_absence(graph, catalog, node) || !matches!(graph.nodes[node].kind, NodeKind::Library(_))
}
