//! Decisions that are made before a program runs: the order of nodes, rates, clusters, and the tests for ⊥.
//!
//! Comments refer to the rules by which nodes fire, whichever way a graph is run:
//!
//! - R1: A node fires when each connected input holds a token, each outgoing connection is free, and its events are
//!   enabled.
//! - R2: A firing takes one token from each input and puts one token, a value or ⊥, on each synchronous connection.
//! - R3: With ⊥ at a mandatory input the node does not run, and sends ⊥. A node with a method for ⊥ runs that method.
//!   An optional input passes ⊥ to the node.
//! - R4: A synchronous connection is free again when everything downstream of it has finished. A `pipelined` node
//!   counts as finished as soon as it has fired.
//! - R5: A slot is called when its connection holds a token and all events of its node are enabled. The connection is
//!   free as soon as the token is taken.
//! - R6: An event is enabled while none of its connections holds a token. No token is overwritten.
//! - R7: A connection from an event to an input is free again when the region behind it has finished. A connection from
//!   an output to a slot is free again as soon as the slot has taken the token.

mod activity;
mod analysis;
mod asynchronous;
mod characteristics;
mod clocks;
mod cluster;
mod clusters;
mod delivery;
mod demand_driven;
mod firing;
mod holding;
mod iteration;
mod links;
mod live;
mod order;
mod periods;
mod precedence;
mod rates;
mod schedule;
mod silences;
mod stamps;
mod steps;
mod stuck;
mod view;

use crate::{
    catalog::Catalog,
    graph::{Graph, NodeKind},
    report::{Diagnostic, Diagnostics},
};
use std::collections::BTreeMap;

pub use activity::{reachable as active_nodes, reachable_within as active_nodes_within, successors};
pub use analysis::{Analysis, Stamps};
pub use asynchronous::{Asynchronous, Delivery, MANY};
pub use characteristics::Characteristics;
pub use clocks::{Clock, is_mandatory};
pub use cluster::{Block, Cluster, ClusterId, Guard, Run, Step};
pub use delivery::{at_start, ordered};
pub use firing::{fires, handles_absence, is_source, may_be_missing, takes_activity};
pub use links::{Links, Loops};
pub use periods::throttled_periods;
pub use precedence::{circles, events_on_circles};
pub use rates::has_rates;
pub use silences::{Silence, parameter as silence_parameter};
pub use stuck::{Stuck, blockers, find as find_stuck, is_live, is_possible as may_get_stuck};

/// Largest number of connections to slots: the queue of a program counts them in 16 bits.
const MAX_TO_SLOTS: usize = u16::MAX as usize;

/// Analyses a checked graph. Returns `None` after an error that leaves nothing to schedule.
pub fn analyse(graph: &Graph, catalog: &Catalog, diagnostics: &mut Diagnostics) -> Option<Analysis> {
    let mut links = Links::new(graph);
    clusters::check_paces(graph, diagnostics)?;
    let order = order::order(graph, &links, diagnostics)?;
    let repetitions = rates::repetitions(graph, &links, diagnostics)?;
    let mut bodies = BTreeMap::new();
    for (id, node) in graph.nodes.iter_enumerated() {
        if let NodeKind::Each(each) = &node.kind {
            bodies.insert(id, analyse(&each.body, catalog, diagnostics)?);
        }
    }
    let regions = clusters::regions(graph);
    let asynchronous = Asynchronous::new(graph, catalog, &mut links, &regions);
    if let Some(over) = asynchronous.slots.get(MAX_TO_SLOTS) {
        let message = format!("this program has more than {MAX_TO_SLOTS} connections to slots");
        diagnostics.push(Diagnostic::error("too-large", graph.connections[*over].span, message));
        return None;
    }
    live::check_live(graph, &links, &asynchronous.live, diagnostics);
    let (guards, mut clusters, cluster_of) =
        clusters::clusters(graph, catalog, &links, &order, &regions, &asynchronous);
    live::mark(&mut clusters, &links, &asynchronous.live);
    let characteristics = characteristics::characteristics(graph, catalog, &links, &order);
    let clocks = clocks::clocks(graph, catalog, &links, &order, &cluster_of);
    let active = activity::reachable(graph);
    let silences = silences::silences(graph, catalog, &guards, &clusters);
    let mut analysis = Analysis {
        order,
        repetitions,
        regions,
        guards,
        clusters,
        cluster_of,
        characteristics,
        clocks,
        silences,
        asynchronous,
        stamps: Stamps::default(),
        active,
        cancelled: graph.cancelled(),
        links,
        bodies,
    };
    for cluster in analysis.clusters.ids() {
        let block = if rates::is_multirate(graph, &analysis, cluster) {
            let nodes = &analysis.clusters[cluster].nodes;
            let runs = iteration::runs(graph, &analysis.links, &analysis.repetitions, nodes, diagnostics)?;
            Block { opens: vec![], steps: runs.into_iter().map(Step::Repeat).collect() }
        } else {
            schedule::schedule(graph, &analysis.links, &analysis, cluster)
        };
        analysis.clusters[cluster].block = block;
        let order = analysis.clusters[cluster].schedule();
        analysis.clusters[cluster].sends =
            order.iter().flat_map(|n| analysis.links.sends[*n].iter().copied()).collect();
    }
    if delivery::is_ordered(graph, &analysis) {
        analysis.asynchronous.order();
    }
    analysis.stamps = stamps::stamps(graph, catalog, &analysis);
    Some(analysis)
}
