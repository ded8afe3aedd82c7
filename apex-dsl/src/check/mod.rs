//! What can be wrong with a graph whose names are all known. One pass a file; each reports all it finds.

mod activity;
mod asynchronous;
mod inputs;
mod lists;
mod modifiers;
mod parallel;
mod target;
mod types;

use crate::{
    catalog::Catalog,
    graph::{Graph, NodeKind},
    report::Diagnostics,
};

pub use lists::token_type;
pub use types::compare as compare_types;

/// Runs all checks on `graph` and on the bodies in it.
pub fn check(graph: &mut Graph, catalog: &Catalog, diagnostics: &mut Diagnostics) {
    inputs::check_open_inputs(graph, catalog, diagnostics);
    lists::resolve_lists(graph, diagnostics);
    types::check_types(graph, catalog, diagnostics);
    modifiers::check_modifiers(graph, catalog, diagnostics);
    asynchronous::check_asynchronous(graph, catalog, diagnostics);
    activity::check_activity(graph, catalog, diagnostics);
    parallel::check_parallel(graph, catalog, diagnostics);
    target::check_target(graph, catalog, diagnostics);
    for node in &mut graph.nodes {
        if let NodeKind::Each(each) = &mut node.kind {
            check(&mut each.body, catalog, diagnostics);
        }
    }
}
