//! Graphs that are legal, but hardly what was meant.

use crate::{
    analyse::{active_nodes_within, may_be_missing},
    catalog::{Catalog, Signature},
    graph::{ConnectionId, Graph, NodeId, NodeKind, PortId, Standard, WireEnd},
    index::IdVec,
    report::{Diagnostic, Diagnostics},
    syntax::tree::PortKind,
};
use std::collections::BTreeSet;

/// Warns of results that nothing uses, failures that lead nowhere, and activity that may wait forever.
pub fn check_lints(graph: &Graph, catalog: &Catalog, diagnostics: &mut Diagnostics) {
    for node in &graph.nodes {
        if let NodeKind::Each(each) = &node.kind {
            check_lints(&each.body, catalog, diagnostics);
        }
    }
    let lints = Lints {
        graph,
        catalog,
        sends: graph.wires.iter().map(|wire| wire.from).collect(),
        reached: active_nodes_within(graph),
        cancelled: graph.cancelled(),
        passes: graph.connections.iter().filter(|c| c.active).map(|c| c.from.node).collect(),
        into: into(graph),
    };
    let has_activity = !lints.passes.is_empty();
    for node in graph.nodes.ids() {
        let NodeKind::Library(library) = &graph.nodes[node].kind else { continue };
        let signature = &catalog.signatures[library.signature];
        let mut warnings = vec![lints.unused(node, signature), lints.ignored_failure(node, signature)];
        // Activity may come from the graph around this one, and not into the body of an `each`.
        if !graph.is_body && !graph.is_open {
            warnings.push(lints.waits_forever(node));
            warnings.push(lints.without_activity(node, signature).filter(|_| !has_activity));
        }
        for warning in warnings.into_iter().flatten() {
            diagnostics.push(warning.inside(graph.scope_path(graph.nodes[node].scope)));
        }
    }
}

struct Lints<'a> {
    graph: &'a Graph,
    catalog: &'a Catalog,
    /// Ports from which a connection leads, as written.
    sends: BTreeSet<WireEnd>,
    /// Nodes that activity can reach.
    reached: BTreeSet<NodeId>,
    /// Nodes whose activity can be cancelled.
    cancelled: BTreeSet<NodeId>,
    /// Nodes from which `=>` leads on.
    passes: BTreeSet<NodeId>,
    /// Connections into each node.
    into: IdVec<NodeId, Vec<ConnectionId>>,
}

fn into(graph: &Graph) -> IdVec<NodeId, Vec<ConnectionId>> {
    let mut into = IdVec::from_elem(vec![], graph.nodes.len());
    for (index, c) in graph.connections.iter_enumerated() {
        into[c.to.node].push(index);
    }
    into
}

impl Lints<'_> {
    fn is_used(&self, node: NodeId, port: usize) -> bool {
        self.sends.contains(&WireEnd::Port(PortId { node, port }))
    }

    /// Function without a used result. It has no other effect.
    fn unused(&self, node: NodeId, signature: &Signature) -> Option<Diagnostic> {
        let mut sends = (0..signature.ports.len()).filter(|port| signature.ports[*port].kind.sends()).peekable();
        let is_used = sends.peek().is_none() || sends.any(|port| self.is_used(node, port));
        if !signature.is_function || is_used {
            return None;
        }
        let n = &self.graph.nodes[node];
        let message = format!("nothing depends on `{}`: none of its results is used", n.name);
        let note = "connect one of its outputs or events, or remove the node";
        Some(Diagnostic::warning("unused-node", n.span, message).note(note))
    }

    /// Node with an event of failure that leads nowhere.
    fn ignored_failure(&self, node: NodeId, signature: &Signature) -> Option<Diagnostic> {
        let n = &self.graph.nodes[node];
        let declared = (0..signature.ports.len()).filter(|port| signature.ports[*port].failure);
        let open = declared.filter(|port| !self.is_used(node, *port));
        let mut names: Vec<String> = open.map(|port| format!("`{}`", signature.ports[port].name)).collect();
        let unheard = n.standard(Standard::Timeout).is_none_or(|port| !self.is_used(node, port));
        if n.modifiers.timeout.is_some() && unheard {
            names.push("`timeout`".to_owned());
        }
        let verb = if names.len() == 1 { "leads" } else { "lead" };
        let message = format!("{} of `{}` {verb} nowhere, so that a failure is not noticed", names.join(", "), n.name);
        let first = names.first()?.trim_matches('`');
        Some(
            Diagnostic::warning("ignored-failure", n.span, message)
                .note(format!("connect it, for example `{}.{first} => …;`", n.name)),
        )
    }

    /// Node that takes activity at an input, and passes it on only when its other inputs hold values, too.
    fn waits_forever(&self, node: NodeId) -> Option<Diagnostic> {
        let (graph, n) = (self.graph, &self.graph.nodes[node]);
        if !self.passes.contains(&node)
            || !self.reached.contains(&node)
            || n.modifiers.timeout.is_some()
            || self.cancelled.contains(&node)
        {
            return None;
        }
        let is_mandatory = |port: usize| n.ports[port].kind == PortKind::Input && !n.ports[port].optional;
        let connections = || self.into[node].iter().map(|c| &graph.connections[*c]);
        let inputs = || connections().filter(|c| is_mandatory(c.to.port));
        let brings = inputs().find(|c| c.active && self.reached.contains(&c.from.node))?;
        let lacks = inputs().find(|c| {
            c.from != brings.from && graph.is_synchronous(c) && may_be_missing(graph, self.catalog, c.from)
        })?;
        let message = format!(
            "`{}` may stay active forever: it takes activity at `{}`, but runs only when `{}` is not ⊥",
            n.name,
            graph.port(brings.to).name,
            graph.port(lacks.to).name
        );
        let warning = Diagnostic::warning("waits-forever", n.span, message)
            .also(brings.span, "brings activity")
            .also(lacks.span, "may bring ⊥");
        Some(warning.note("give it a `timeout` with a `=>` to another node, or make sure that there is always a value"))
    }

    /// Node with a method for its activation, which activity never reaches.
    fn without_activity(&self, node: NodeId, signature: &Signature) -> Option<Diagnostic> {
        let n = &self.graph.nodes[node];
        if signature.on_activate.is_none() || self.reached.contains(&node) || n.starts_active {
            return None;
        }
        let message = format!("`{}` is never activated: the graph has no `=>`", self.graph.path(node));
        let note = format!(
            "`{}` acts when it becomes active: write `start => {};`, or `=>` where its task begins",
            n.name, n.name
        );
        Some(Diagnostic::warning("never-activated", n.span, message).note(note))
    }
}
