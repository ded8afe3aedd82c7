//! Sources without a period that fire with the consumers of their tokens, where these are on other threads.

use crate::{
    analyse::{self, Analysis, Guard},
    catalog::Catalog,
    graph::{Connection, Graph, NodeId, NodeKind},
    report::{Diagnostic, Diagnostics},
};
use std::collections::BTreeSet;

/// Synchronous connections between groups.
pub fn synchronous(graph: &Graph) -> impl Iterator<Item = &Connection> {
    let crosses = |c: &&Connection| graph.group(c.from.node) != graph.group(c.to.node);
    graph.connections.iter().filter(|c| graph.is_synchronous(c)).filter(crosses)
}

/// Sources without a period whose tokens go to another thread, also through nodes on their own, each with the nodes
/// that determine when it fires, as its consumers take their tokens, too.
pub fn paced(graph: &Graph, analysis: &Analysis, catalog: &Catalog) -> Vec<(NodeId, BTreeSet<NodeId>)> {
    let sources = before_cells(graph, analysis);
    sources.into_iter().filter_map(|node| Some((node, paces(graph, analysis, catalog, node)?))).collect()
}

/// Nodes whose tokens go to other threads, and the nodes upstream of them on their threads.
fn before_cells(graph: &Graph, analysis: &Analysis) -> BTreeSet<NodeId> {
    let mut found = BTreeSet::new();
    let mut ends: Vec<NodeId> = synchronous(graph).map(|c| c.from.node).collect();
    while let Some(node) = ends.pop() {
        if found.insert(node) {
            let into = analysis.links.into[node].iter().map(|c| graph.connections[*c].from.node);
            ends.extend(into.filter(|from| graph.group(*from) == graph.group(node)));
        }
    }
    found
}

fn paces(graph: &Graph, analysis: &Analysis, catalog: &Catalog, source: NodeId) -> Option<BTreeSet<NodeId>> {
    if !analyse::is_source(graph, catalog, &analysis.links, source) {
        return None;
    }
    let mut paces = BTreeSet::new();
    for guard in &analysis.clusters[analysis.cluster_of[source]].guards {
        match analysis.guards[*guard] {
            Guard::Timer(node) | Guard::Input(node) => paces.insert(node),
            Guard::Token(connection) => paces.insert(graph.connections[connection].to.node),
            Guard::Events(_) => continue,
            Guard::React => return None,
        };
    }
    (!paces.is_empty() && !paces.contains(&source)).then_some(paces)
}

/// Warns of sources that send values of another moment, as what determines when they are taken is on another thread.
pub fn check(graph: &Graph, analysis: &Analysis, catalog: &Catalog, diagnostics: &mut Diagnostics) {
    for (source, paces) in paced(graph, analysis, catalog) {
        let node = &graph.nodes[source];
        let changes =
            matches!(&node.kind, NodeKind::Library(library) if catalog.signatures[library.signature].stateful);
        let elsewhere = paces.into_iter().find(|pace| graph.group(*pace) != graph.group(source));
        let Some(pace) = elsewhere.filter(|_| changes) else { continue };
        let (name, group) = (graph.path(pace), graph.group(pace));
        let message = format!(
            "`{}` may send an older value than that of the moment when it is taken together with the token of `{name}`",
            node.name
        );
        let note = format!("run both on one thread: `{}` on `{group}`; its slots take tokens of any thread", node.name);
        let pace = (graph.nodes[pace].span, format!("on thread `{group}`"));
        let warning = Diagnostic::warning("stale", node.span, message).also(pace.0, pace.1).note(note);
        diagnostics.push(warning.inside(graph.scope_path(node.scope)));
    }
}
