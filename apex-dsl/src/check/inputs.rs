//! Required inputs and outputs of the graph without a connection.

use crate::{
    catalog::Catalog,
    graph::{Graph, NodeId, NodeKind, PortId, ScopeId},
    report::{Diagnostic, Diagnostics},
    syntax::tree::PortKind,
};
use std::collections::BTreeSet;

/// Reports open inputs of nodes, and outputs of the graph that nothing is connected to.
pub fn check_open_inputs(graph: &Graph, catalog: &Catalog, diagnostics: &mut Diagnostics) {
    let connected: BTreeSet<PortId> = graph.connections.iter().map(|c| c.to).collect();
    for (id, node) in graph.nodes.iter_enumerated() {
        for (port, p) in node.ports.iter().enumerate() {
            if p.kind != PortKind::Input || connected.contains(&PortId { node: id, port }) {
                continue;
            }
            if graph.suppressed.contains(&PortId { node: id, port }) {
                continue;
            }
            if let NodeKind::Boundary(_) = node.kind {
                let message = format!("nothing is connected to the output `{}`", node.name);
                let error = Diagnostic::error("open-output", node.span, message);
                diagnostics.push(error.note(format!("connect it: `… -> {};`", node.name)));
            } else if !p.optional && !inside_unconnected(graph, id) {
                let message = format!("input `{}` of `{}` is not connected", p.name, node.name);
                let mut error = Diagnostic::error("open-input", node.span, message)
                    .label(format!("takes `{}: {}`", p.name, p.ty))
                    .note(format!("connect it: `… -> {}.{};`", node.name, p.name));
                if let NodeKind::Library(library) = &node.kind {
                    let signature = &catalog.signatures[library.signature];
                    error = error.note(format!(
                        "`{}` is declared at {}:{}; an optional input is written `Option<&T>`",
                        signature.name,
                        signature.file.display(),
                        signature.line
                    ));
                }
                diagnostics.push(error);
            }
        }
    }
}

/// Returns `true` if a port of the nested graph around the node is open, which is reported there.
fn inside_unconnected(graph: &Graph, node: NodeId) -> bool {
    graph.nodes[node].scope != ScopeId::TOP && graph.open_pins.contains(&node)
}
