//! A warning about tokens that wait for one another forever.

use crate::{
    analyse::{Analysis, find_stuck},
    catalog::Catalog,
    graph::{ConnectionId, Graph},
    report::{Diagnostic, Diagnostics},
};

/// Warns of tokens that may wait for one another, with a shortest run to them.
pub fn check_stuck(graph: &Graph, analysis: &Analysis, catalog: &Catalog, diagnostics: &mut Diagnostics) {
    if graph.is_body || graph.is_open {
        return;
    }
    let Some(stuck) = find_stuck(graph, analysis, catalog) else { return };
    let text = |connection: ConnectionId| format!("`{}`", graph.connection_text(connection));
    let waits = |(token, before): &(ConnectionId, ConnectionId)| {
        let node = graph.path(graph.connections[*token].to.node);
        format!(
            "the token of {} waits: `{node}` is called only after that of {} was taken",
            text(*token),
            text(*before)
        )
    };
    let first = stuck.waits[0].0;
    let names: Vec<String> =
        stuck.waits.iter().map(|(token, _)| graph.end_name(graph.connections[*token].to)).collect();
    let message = format!("tokens may wait for one another forever at `{}`", names.join("` and `"));
    let mut warning = Diagnostic::warning("stuck", graph.connections[first].span, message);
    if !stuck.run.is_empty() {
        let run: Vec<String> = stuck.run.iter().map(|token| text(*token)).collect();
        warning = warning.note(format!("first the tokens of {} are taken", run.join(", then ")));
    }
    warning = stuck.waits.iter().map(waits).fold(warning, Diagnostic::note);
    let warning = warning.note("let one token reach only one node of a cycle, or send it on through a `delay`");
    diagnostics.push(warning.inside(graph.scope_path(graph.nodes[graph.connections[first].to.node].scope)));
}
