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
mod asynchronous;
mod characteristics;
mod clocks;
mod clusters;
mod delivery;
mod demand_driven;
mod holding;
mod iteration;
mod live;
mod order;
mod periods;
mod rates;
mod schedule;
mod silences;
mod stamps;
mod steps;
mod stuck;

use crate::{
    catalog::Catalog,
    graph::{ConnectionId, Flow, Graph, NodeId, NodeKind, PortId},
    index::IdVec,
    report::{Diagnostic, Diagnostics},
    syntax::tree::PortKind,
};
use std::collections::{BTreeMap, BTreeSet};

pub use activity::{reachable as active_nodes, reachable_within as active_nodes_within, successors};
pub use asynchronous::{Asynchronous, MANY};
pub use characteristics::Characteristics;
pub use clocks::{Clock, is_mandatory};
pub use clusters::{Cluster, ClusterId, Guard};
pub use delivery::{Delivery, at_start, ordered};
pub use order::{Loops, circles, events_on_circles};
pub use periods::throttled_periods;
pub use rates::has_rates;
pub use schedule::{Block, Run, Step};
pub use silences::{Silence, parameter as silence_parameter};
pub use stamps::Stamps;
pub use stuck::{Stuck, blockers, find as find_stuck, is_live, is_possible as may_get_stuck};

/// Results of the analysis of a graph.
#[derive(Debug)]
pub struct Analysis {
    /// All nodes, producers before consumers, otherwise in the order of the source file.
    pub order: Vec<NodeId>,
    /// Number of firings of each node in one iteration of its region.
    pub repetitions: IdVec<NodeId, u64>,
    /// Region of each node.
    pub regions: IdVec<NodeId, usize>,
    /// Guards of all clusters.
    pub guards: Vec<Guard>,
    /// Clusters, in the order of their first node.
    pub clusters: IdVec<ClusterId, Cluster>,
    /// Cluster of each node. Nodes that do not fire have the number 0, but are in no cluster.
    pub cluster_of: IdVec<NodeId, ClusterId>,
    /// Characteristics of each node for pruning (thesis eqs. 3.6–3.8).
    pub characteristics: IdVec<NodeId, Characteristics>,
    /// Clock of each node.
    pub clocks: IdVec<NodeId, Clock>,
    /// Guards in whose place ⊥ is taken after a silence.
    pub silences: Vec<Silence>,
    /// Connections with slots or events.
    pub asynchronous: Asynchronous,
    /// Clusters and connections that keep stamps.
    pub stamps: Stamps,
    /// Nodes that activity can reach.
    pub active: BTreeSet<NodeId>,
    /// Nodes whose activity can be cancelled.
    pub cancelled: BTreeSet<NodeId>,
    /// Connections of each node.
    pub links: Links,
    /// Analysis of the body of each `each` node.
    pub bodies: BTreeMap<NodeId, Analysis>,
}

impl Analysis {
    /// Cluster in which a node fires; `None` for a node that only has slots.
    fn fires_in(&self, node: NodeId) -> Option<ClusterId> {
        let cluster = self.cluster_of[node];
        self.clusters.get(cluster).is_some_and(|c| c.nodes.contains(&node)).then_some(cluster)
    }
}

/// Connections of each node, by number.
#[derive(Debug)]
pub struct Links {
    /// Synchronous connections into each node.
    pub into: IdVec<NodeId, Vec<ConnectionId>>,
    /// Synchronous connections out of each node.
    pub out_of: IdVec<NodeId, Vec<ConnectionId>>,
    /// All connections into the inputs of each node.
    pub inputs: IdVec<NodeId, Vec<ConnectionId>>,
    /// Asynchronous connections out of each node that can carry tokens, in the order of its ports, then of the source
    /// file.
    pub sends: IdVec<NodeId, Vec<ConnectionId>>,
    /// Loops with delays.
    pub loops: Loops,
}

impl Links {
    /// Connections of `graph`.
    pub fn new(graph: &Graph) -> Self {
        let none = IdVec::from_elem(vec![], graph.nodes.len());
        let loops = Loops::default();
        let mut links = Self { into: none.clone(), out_of: none.clone(), inputs: none.clone(), sends: none, loops };
        for (index, connection) in graph.connections.iter_enumerated() {
            let flow = graph.flow(connection);
            if flow == Flow::Synchronous {
                links.into[connection.to.node].push(index);
                links.out_of[connection.from.node].push(index);
            } else {
                links.sends[connection.from.node].push(index);
            }
            if flow != Flow::ToSlot {
                links.inputs[connection.to.node].push(index);
            }
        }
        for sends in &mut links.sends {
            sends.sort_by_key(|c| (graph.connections[*c].from.port, *c));
        }
        links.loops = Loops::new(graph, &links);
        links
    }

    /// All connections out of `node` that can carry tokens: the asynchronous ones, then the synchronous ones.
    pub fn from(&self, node: NodeId) -> impl Iterator<Item = ConnectionId> + '_ {
        self.sends[node].iter().chain(&self.out_of[node]).copied()
    }

    /// Nodes that take the synchronous tokens of `node` in the same iteration.
    pub fn successors<'a>(&'a self, graph: &'a Graph, node: NodeId) -> impl Iterator<Item = NodeId> + 'a {
        let held_back = self.loops.delays.contains(&node);
        self.out_of[node].iter().filter(move |_| !held_back).map(|c| graph.connections[*c].to.node)
    }

    /// Nodes that have to come after `node` in an iteration.
    pub fn followers<'a>(&'a self, graph: &'a Graph, node: NodeId) -> impl Iterator<Item = NodeId> + 'a {
        let begun = self.loops.begun_by.get(&node);
        self.successors(graph, node).chain(begun.into_iter().flatten().copied())
    }
}

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

/// Returns `true` if a node has a method for ⊥ at its mandatory inputs (`#[no_message]`).
pub fn handles_absence(graph: &Graph, catalog: &Catalog, node: NodeId) -> bool {
    matches!(&graph.nodes[node].kind, NodeKind::Library(library) if catalog.signatures[library.signature].no_message.is_some())
}

/// Returns `true` if a token may be ⊥ although the node that sends it fired.
pub fn may_be_missing(graph: &Graph, catalog: &Catalog, from: PortId) -> bool {
    let node = &graph.nodes[from.node];
    match &node.kind {
        // A node that is disabled, or that failed, sends ⊥.
        NodeKind::Library(_) if graph.nodes[from.node].may_produce_absent() => true,
        NodeKind::Library(_) if graph.port(from).parameter.is_some() => false,
        NodeKind::Library(library) => {
            graph.port(from).optional
                || handles_absence(graph, catalog, from.node)
                || refuses(&catalog.signatures[library.signature], node)
        }
        // The presence of these tokens is stored with them, and tested.
        NodeKind::Delay(_) | NodeKind::Each(_) | NodeKind::Relay => true,
        // In the body of an `each` the element of the list is present. Other inputs may be ⊥ if they are optional.
        NodeKind::Boundary(_) => !graph.is_body || graph.port(from).optional,
        NodeKind::Receiver(_) => graph.port(from).optional,
        NodeKind::Start
        | NodeKind::Watchdog
        | NodeKind::SetBack
        | NodeKind::Exit(_)
        | NodeKind::Reset
        | NodeKind::Interrupt(_)
        | NodeKind::Probe
        | NodeKind::Sender(_) => false,
    }
}

/// Returns `true` if a function node has a parameter that arrives as a token and may be out of its range.
fn refuses(signature: &crate::catalog::Signature, node: &crate::graph::Node) -> bool {
    let arrives = |p: &crate::graph::Port| p.kind == PortKind::Input && !p.optional;
    signature.is_function
        && node
            .ports
            .iter()
            .filter(|p| arrives(p))
            .any(|p| p.parameter.is_some_and(|i| signature.params[i].range.is_some()))
}

/// Returns `true` if the tokens of a node take activity away: its own, or those that it passes on over `=>`.
pub fn takes_activity(graph: &Graph, catalog: &Catalog, node: NodeId) -> bool {
    match &graph.nodes[node].kind {
        NodeKind::Library(library) => catalog.signatures[library.signature].deactivates,
        NodeKind::Relay => {
            let mut into = graph.connections.iter().filter(|c| c.active && c.to.node == node);
            into.any(|c| takes_activity(graph, catalog, c.from.node))
        }
        NodeKind::Receiver(far) => far.takes_activity,
        _ => false,
    }
}

/// Returns `true` if a node fires, and so belongs to a cluster. A node that only has slots does not.
pub fn fires(graph: &Graph, catalog: &Catalog, links: &Links, node: NodeId) -> bool {
    match &graph.nodes[node].kind {
        NodeKind::Library(library) => {
            catalog.signatures[library.signature].process.is_some() || !links.inputs[node].is_empty()
        }
        NodeKind::Each(_) | NodeKind::Delay(_) | NodeKind::Relay => true,
        NodeKind::Boundary(kind) => kind.is_synchronous(),
        NodeKind::Probe => !links.inputs[node].is_empty(),
        NodeKind::Start
        | NodeKind::Watchdog
        | NodeKind::SetBack
        | NodeKind::Exit(_)
        | NodeKind::Reset
        | NodeKind::Interrupt(_)
        | NodeKind::Sender(_)
        | NodeKind::Receiver(_) => false,
    }
}

/// Returns `true` if a node is a source: it fires, and no connection leads to its inputs.
pub fn is_source(graph: &Graph, catalog: &Catalog, links: &Links, node: NodeId) -> bool {
    fires(graph, catalog, links, node)
        && links.inputs[node].is_empty()
        && !matches!(graph.nodes[node].kind, NodeKind::Boundary(PortKind::Output))
}
