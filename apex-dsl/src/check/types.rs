//! Comparison of the types at both ends of a connection.

use crate::{
    catalog::{Catalog, Match, Type, library},
    graph::{Connection, Graph, NodeKind, PortId},
    report::{Diagnostic, Diagnostics},
    resolve::{mismatch, token_type},
};

/// Reports connections whose ends certainly differ. All others are left to rustc.
pub fn check_types(graph: &Graph, catalog: &Catalog, diagnostics: &mut Diagnostics) {
    for connection in &graph.connections {
        if connection.differs || compare(graph, connection) != Match::Different {
            continue;
        }
        let (from, to) = (token_type(graph, connection.from), graph.port(connection.to).ty.clone());
        let iterates = matches!(&graph.nodes[connection.to.node].kind, NodeKind::Each(each) if each.list == Some(connection.to.port));
        let takes = if iterates { format!("a list of `{to}`") } else { format!("`{to}`") };
        let message = format!(
            "`{}` sends `{from}`, but `{}` takes {takes}",
            graph.end_name(connection.from),
            graph.end_name(connection.to)
        );
        let taken = &graph.port(connection.to).ty;
        let error = Diagnostic::error(mismatch::code(&from, taken), connection.span, message)
            .also(graph.nodes[connection.from.node].span, format!("sends `{from}`"))
            .also(graph.nodes[connection.to.node].span, format!("takes {takes}"))
            .note(declared(graph, catalog, connection.from))
            .note(declared(graph, catalog, connection.to));
        let (arrow, active) = (connection.span, connection.active);
        diagnostics.push(mismatch::remedy(error, &from, taken, arrow, active, catalog));
    }
}

/// Result of comparing the types at the two ends of a connection. The list of an `each` is compared by its elements. A
/// value in place of the tokens was fitted to the slot.
pub fn compare(graph: &Graph, connection: &Connection) -> Match {
    if connection.given.is_some() {
        return Match::Same;
    }
    let from = token_type(graph, connection.from);
    let to = &graph.port(connection.to).ty;
    match &graph.nodes[connection.to.node].kind {
        NodeKind::Each(each) if each.list == Some(connection.to.port) => match (from.list_item(), &from) {
            (Some(item), _) => item.compare(to),
            (None, Type::Unknown(_) | Type::Param(_)) => Match::Unknown,
            (None, Type::Named(name, _)) if !library::is_standard(name) => Match::Unknown,
            (None, _) => Match::Different,
        },
        _ => from.compare(to),
    }
}

fn declared(graph: &Graph, catalog: &Catalog, end: PortId) -> String {
    let name = graph.end_name(end);
    match &graph.nodes[end.node].kind {
        NodeKind::Library(library) => {
            let signature = &catalog.signatures[library.signature];
            format!("`{name}` is declared at {}:{} (`{}`)", signature.file.display(), signature.line, signature.name)
        }
        NodeKind::Each(each) => format!("`{name}` is a port of `{}`, which runs once per element", each.body.name),
        _ => format!("`{name}` is a port of the graph `{}`", graph.name),
    }
}
