//! Slots and events that cannot work.

use crate::{
    analyse::events_on_circles,
    catalog::Catalog,
    graph::{Flow, Graph, NodeKind, Standard},
    report::{Diagnostic, Diagnostics},
    syntax::tree::PortKind,
};

/// Reports connections that would never carry a token, and asynchronous ones inside an `each`.
pub fn check_asynchronous(graph: &Graph, catalog: &Catalog, diagnostics: &mut Diagnostics) {
    for c in &graph.connections {
        let (from, to) = (&graph.nodes[c.from.node], &graph.nodes[c.to.node]);
        if graph.is_body && (c.active || graph.flow(c) != Flow::Synchronous) {
            let what = if c.active { "pass activity on" } else { "have asynchronous connections" };
            let message = format!("the body of an `each` runs to completion for each element: it cannot {what}");
            diagnostics.push(
                Diagnostic::error("each-asynchronous", c.span, message)
                    .note("connect the node with `each` itself: its outputs can lead to a slot, and with `=>`"),
            );
        }
        if c.from.node == c.to.node && graph.flow(c) == Flow::ToSlot && graph.port(c.from).kind == PortKind::Event {
            let message = format!(
                "`{}` would wait for its own event: a slot is served only while all events of its node are free to be triggered",
                graph.end_name(c.to)
            );
            diagnostics.push(
                Diagnostic::error("own-event", c.span, message)
                    .note("send the token through another node, or call the method in Rust"),
            );
        }
        if matches!((&from.kind, &to.kind), (NodeKind::Start, NodeKind::Reset)) {
            let message = "`start` cannot lead to `reset`, which triggers `start` again";
            diagnostics.push(Diagnostic::error("own-event", c.span, message));
        }
    }
    for node in &graph.nodes {
        check_standard_ports(node, catalog, diagnostics);
    }
    check_waits(graph, diagnostics);
}

/// Reports events that lead to inputs from which tokens flow back to the node of the event. Such an event is free again
/// only when everything downstream has finished (R7), but the node fires only while the event is free (R1).
fn check_waits(graph: &Graph, diagnostics: &mut Diagnostics) {
    for c in events_on_circles(graph).into_iter().map(|c| &graph.connections[c]) {
        let (node, event) = (graph.path(c.from.node), graph.end_name(c.from));
        let message =
            format!("`{node}` would wait for its own event: the nodes that `{event}` triggers lead back to `{node}`");
        diagnostics.push(
            Diagnostic::error("own-event", c.span, message)
                .note("a node fires only while its events are free, and this event is free again only after everything downstream has fired, also after a `delay`")
                .note("connect the event to a slot instead"),
        );
    }
}

/// Reports standard ports without the modifier that they need, and `restart` of nodes that cannot be made again.
fn check_standard_ports(node: &crate::graph::Node, catalog: &Catalog, diagnostics: &mut Diagnostics) {
    let needs = [
        (Standard::Timeout, node.modifiers.timeout.is_some(), "timeout"),
        (Standard::Late, node.modifiers.deadline.is_some(), "deadline"),
    ];
    for (port, given, modifier) in needs {
        if node.standard(port).is_some() && !given {
            let message =
                format!("`{}.{}` is never triggered: `{}` has no `{modifier}`", node.name, port.name(), node.name);
            diagnostics.push(
                Diagnostic::error("missing-modifier", node.span, message)
                    .note(format!("write it after the instance, for example `{modifier} 5s`")),
            );
        }
    }
    if node.modifiers.restart
        && let NodeKind::Library(library) = &node.kind
    {
        let function = catalog.signatures[library.signature].is_function;
        if library.handed_in || function {
            let why = if function { "has no state" } else { "is made in Rust" };
            let message = format!("`restart` replaces a failed node by a new one, but `{}` {why}", node.name);
            diagnostics.push(Diagnostic::error("wrong-modifier", node.span, message));
        }
    }
}
