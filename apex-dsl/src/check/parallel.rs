//! `each par`: its body must not keep any state from one element to the next.

use crate::{
    catalog::Catalog,
    graph::{Graph, Library, Node, NodeId, NodeKind, PortId},
    report::{Diagnostic, Diagnostics},
    source::Span,
    syntax::tree::PortKind,
};

/// Reports nodes that keep state in the body of an `each par`.
pub fn check_parallel(graph: &Graph, catalog: &Catalog, diagnostics: &mut Diagnostics) {
    for node in &graph.nodes {
        if let NodeKind::Each(each) = &node.kind
            && each.parallel
        {
            check_body(&each.body, node, catalog, diagnostics);
        }
    }
}

fn check_body(body: &Graph, around: &Node, catalog: &Catalog, diagnostics: &mut Diagnostics) {
    for (id, node) in body.nodes.iter_enumerated() {
        if let NodeKind::Each(each) = &node.kind {
            check_body(&each.body, around, catalog, diagnostics);
        }
        let Some((why, declared)) = remembers(body, id, catalog) else { continue };
        let message = format!("`{}` runs its elements in parallel, but {why}", around.name);
        let same = node.span == around.span;
        let error = Diagnostic::error("each-stateful", around.span, message);
        let error = if same { error } else { error.also(inner_span(node, around), "this node") };
        let error = declared.into_iter().fold(error, Diagnostic::note);
        diagnostics.push(error.note(
            "parallel elements cannot depend on each other: write `each` without `par`, or use a node without state",
        ));
    }
}

fn inner_span(node: &Node, around: &Node) -> Span {
    if node.span.end == node.span.start { around.span } else { node.span }
}

/// Reason why a node depends on previous elements, and the place of its declaration.
fn remembers(body: &Graph, id: NodeId, catalog: &Catalog) -> Option<(String, Option<String>)> {
    let (node, name) = (&body.nodes[id], body.path(id));
    let library = match &node.kind {
        NodeKind::Library(library) => library,
        NodeKind::Delay(_) => return Some((format!("`{name}` delays tokens from one element to the next"), None)),
        _ => return None,
    };
    let signature = &catalog.signatures[library.signature];
    let declared = format!("`{}` is declared at {}:{}", signature.name, signature.file.display(), signature.line);
    let why = if library.handed_in {
        format!("`{name}` is made in Rust and exists only once")
    } else if signature.stateful {
        format!(
            "`{name}` keeps state from one element to the next: `{}` has fields that are not parameters",
            signature.name
        )
    } else if let Some(method) = &signature.no_message {
        format!("`{name}` handles each ⊥ in `{method}`, in order")
    } else if let Some(param) = kept_parameter(body, id, library, catalog) {
        format!("`{name}` keeps the last value that arrived at its parameter `{param}`")
    } else {
        return None;
    };
    Some((why, Some(declared)))
}

/// A connected input that sets a parameter of a struct node, which keeps the value until the next one arrives.
fn kept_parameter<'a>(body: &'a Graph, node: NodeId, library: &Library, catalog: &Catalog) -> Option<&'a str> {
    if catalog.signatures[library.signature].is_function {
        return None;
    }
    let ports = body.nodes[node].ports.iter().enumerate();
    let mut params = ports.filter(|(_, p)| p.kind == PortKind::Input && p.parameter.is_some());
    params.find(|(port, _)| body.incoming(PortId { node, port: *port }).is_some()).map(|(_, p)| p.name.as_str())
}
