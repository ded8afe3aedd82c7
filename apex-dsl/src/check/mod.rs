//! Checks of a graph whose names are all resolved. One check per file; each reports all problems that it finds.

mod activity;
mod asynchronous;
mod frames;
mod inputs;
mod lints;
mod modifiers;
mod parallel;
mod rates;
mod target;
mod types;
mod unused;

use crate::{
    catalog::Catalog,
    graph::{Graph, NodeKind},
    report::Diagnostics,
    resolve::check_origins,
};

pub use lints::check_lints;
pub use rates::{check_periods, check_rates};
pub use types::compare as compare_types;
pub use unused::check_unused;

/// Runs all checks on `graph` and on the bodies in it.
pub fn check(graph: &Graph, catalog: &Catalog, diagnostics: &mut Diagnostics) {
    inputs::check_open_inputs(graph, catalog, diagnostics);
    types::check_types(graph, catalog, diagnostics);
    frames::check_frames(graph, catalog, diagnostics);
    check_origins(graph, diagnostics);
    modifiers::check_modifiers(graph, catalog, diagnostics);
    asynchronous::check_asynchronous(graph, catalog, diagnostics);
    activity::check_activity(graph, catalog, diagnostics);
    parallel::check_parallel(graph, catalog, diagnostics);
    target::check_target(graph, catalog, diagnostics);
    for node in &graph.nodes {
        if let NodeKind::Each(each) = &node.kind {
            check(&each.body, catalog, diagnostics);
        }
    }
}
