//! What is decided before a program runs: order, rates, clusters, and what ⊥ can spare.

mod activity;
mod asynchronous;
mod clocks;
mod clusters;
mod delivery;
mod live;
mod order;
mod pruning;
mod pulled;
mod rates;
mod schedule;
mod stamps;
mod steps;

use crate::{
    catalog::Catalog,
    graph::{End, Flow, Graph, NodeId, NodeKind, Standard},
    report::{Diagnostic, Diagnostics},
    syntax::tree::PortKind,
};
use std::collections::{BTreeMap, BTreeSet};

pub use activity::{reachable as active_nodes, reachable_within as active_nodes_within};
pub use asynchronous::{Asynchronous, MANY};
pub use clocks::{Clock, is_mandatory};
pub use clusters::{Cluster, Guard};
pub use delivery::{Delivery, at_start, ordered};
pub use order::{Loops, circles, events_on_circles};
pub use pruning::Characteristics;
pub use rates::{has_rates, is_multirate};
pub use schedule::{Block, Step};
pub use stamps::Stamps;

/// Everything that is known about a graph before it runs.
#[derive(Debug)]
pub struct Analysis {
    /// All nodes, producers before consumers, otherwise in the order of the text.
    pub order: Vec<NodeId>,
    /// How often each node fires in one iteration of its region.
    pub repetitions: Vec<u64>,
    /// The region of each node: connected by synchronous connections.
    pub regions: Vec<usize>,
    /// What sets the pace.
    pub guards: Vec<Guard>,
    /// Nodes that fire together, in the order of their first node.
    pub clusters: Vec<Cluster>,
    /// The cluster of each node.
    pub cluster_of: Vec<usize>,
    /// What a ⊥ at a node means for others (thesis eqs. 3.6–3.8).
    pub characteristics: Vec<Characteristics>,
    /// When each node fires within its cluster.
    pub clocks: Vec<Clock>,
    /// Slots, events and hybrid connections.
    pub asynchronous: Asynchronous,
    /// What keeps the time when the source fired that a token descends from.
    pub stamps: Stamps,
    /// The nodes that activity can reach.
    pub active: BTreeSet<NodeId>,
    /// How its nodes hang together.
    pub links: Links,
    /// The bodies of `each` nodes.
    pub bodies: BTreeMap<NodeId, Analysis>,
}

impl Analysis {
    /// The cluster that a node fires in. A node that only has slots is in none.
    fn fires_in(&self, node: NodeId) -> Option<usize> {
        let cluster = self.cluster_of[node];
        self.clusters.get(cluster).is_some_and(|c| c.nodes.contains(&node)).then_some(cluster)
    }
}

/// How nodes hang together: who sends to whom, by node.
#[derive(Debug)]
pub struct Links {
    /// Synchronous connections into each node, by number.
    pub into: Vec<Vec<usize>>,
    /// Synchronous connections out of each node, by number.
    pub out_of: Vec<Vec<usize>>,
    /// All connections into the inputs of each node.
    pub inputs: Vec<Vec<usize>>,
    /// Asynchronous connections out of each node that can carry tokens, in the order of its ports, then of the text.
    pub sends: Vec<Vec<usize>>,
    /// The loops.
    pub loops: Loops,
}

impl Links {
    /// The connections of `graph`.
    pub fn new(graph: &Graph) -> Self {
        let none = vec![vec![]; graph.nodes.len()];
        let loops = Loops::default();
        let mut links = Self { into: none.clone(), out_of: none.clone(), inputs: none.clone(), sends: none, loops };
        for (index, connection) in graph.connections.iter().enumerate() {
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
    pub fn from(&self, node: NodeId) -> impl Iterator<Item = usize> + '_ {
        self.sends[node].iter().chain(&self.out_of[node]).copied()
    }

    /// The nodes that take what `node` sends in the same iteration.
    pub fn successors<'a>(&'a self, graph: &'a Graph, node: NodeId) -> impl Iterator<Item = NodeId> + 'a {
        let held_back = self.loops.delays.contains(&node);
        self.out_of[node].iter().filter(move |_| !held_back).map(|c| graph.connections[*c].to.node)
    }

    /// The nodes that have to come after `node` in an iteration.
    pub fn followers<'a>(&'a self, graph: &'a Graph, node: NodeId) -> impl Iterator<Item = NodeId> + 'a {
        let begun = self.loops.begun_by.get(&node);
        self.successors(graph, node).chain(begun.into_iter().flatten().copied())
    }
}

/// Connections to slots that a program may have: its queue counts them in 16 bits.
const MAX_TO_SLOTS: usize = u16::MAX as usize;

/// Analyses a checked graph. `None` if an error was found that leaves nothing to schedule.
pub fn analyse(graph: &Graph, catalog: &Catalog, diagnostics: &mut Diagnostics) -> Option<Analysis> {
    let mut links = Links::new(graph);
    clusters::check_paces(graph, diagnostics)?;
    let order = order::order(graph, &links, diagnostics)?;
    let repetitions = rates::repetitions(graph, &links, diagnostics)?;
    let mut bodies = BTreeMap::new();
    for (id, node) in graph.nodes.iter().enumerate() {
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
    let characteristics = pruning::characteristics(graph, catalog, &links, &order);
    let clocks = clocks::clocks(graph, catalog, &links, &order, &cluster_of);
    let active = activity::reachable(graph);
    let mut analysis = Analysis {
        order,
        repetitions,
        regions,
        guards,
        clusters,
        cluster_of,
        characteristics,
        clocks,
        asynchronous,
        stamps: Stamps::default(),
        active,
        links,
        bodies,
    };
    for cluster in 0..analysis.clusters.len() {
        let block = schedule::schedule(graph, &analysis.links, &analysis, cluster);
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

/// Whether a node of the catalog wants to be told of ⊥ at its mandatory inputs.
pub fn is_told(graph: &Graph, catalog: &Catalog, node: NodeId) -> bool {
    matches!(&graph.nodes[node].kind, NodeKind::Library(library) if catalog.signatures[library.signature].no_message.is_some())
}

/// Whether a token may be ⊥ although the node that sends it fired.
pub fn may_be_missing(graph: &Graph, catalog: &Catalog, from: End) -> bool {
    let node = &graph.nodes[from.node];
    match &node.kind {
        // A node that is disabled, or that failed, sends nothing.
        NodeKind::Library(_) if graph.nodes[from.node].may_be_silent() => true,
        NodeKind::Library(_) if graph.port(from).parameter.is_some() => false,
        NodeKind::Library(library) => {
            graph.port(from).optional
                || is_told(graph, catalog, from.node)
                || refuses(&catalog.signatures[library.signature], node)
        }
        // What waits in the program itself is looked up where it lies.
        NodeKind::Delay(_) | NodeKind::Each(_) | NodeKind::Relay => true,
        // An element of the list is there; what is repeated may be ⊥ where the body takes that.
        NodeKind::Boundary(_) => !graph.is_body || graph.port(from).optional,
        NodeKind::Receiver(_) => graph.port(from).optional,
        NodeKind::Start
        | NodeKind::Hung
        | NodeKind::Exit(_)
        | NodeKind::Reset
        | NodeKind::Probe
        | NodeKind::Sender(_) => false,
    }
}

/// Whether a function node has a parameter that arrives as a token and may be out of its range.
fn refuses(signature: &crate::catalog::Signature, node: &crate::graph::Node) -> bool {
    let arrives = |p: &crate::graph::Port| p.kind == PortKind::Input && !p.optional;
    signature.is_function
        && node
            .ports
            .iter()
            .filter(|p| arrives(p))
            .any(|p| p.parameter.is_some_and(|i| signature.params[i].range.is_some()))
}

/// Whether the tokens of a node take activity away.
pub fn takes_activity(graph: &Graph, catalog: &Catalog, node: NodeId) -> bool {
    match &graph.nodes[node].kind {
        NodeKind::Library(library) => catalog.signatures[library.signature].deactivates,
        NodeKind::Receiver(far) => far.takes_activity,
        _ => false,
    }
}

/// Whether a node fires, so that it belongs to a cluster. A node that only has slots does not.
pub fn fires(graph: &Graph, catalog: &Catalog, links: &Links, node: NodeId) -> bool {
    match &graph.nodes[node].kind {
        NodeKind::Library(library) => {
            catalog.signatures[library.signature].process.is_some() || !links.inputs[node].is_empty()
        }
        NodeKind::Each(_) | NodeKind::Delay(_) | NodeKind::Relay => true,
        NodeKind::Boundary(kind) => kind.is_synchronous(),
        NodeKind::Probe => !links.inputs[node].is_empty(),
        NodeKind::Start
        | NodeKind::Hung
        | NodeKind::Exit(_)
        | NodeKind::Reset
        | NodeKind::Sender(_)
        | NodeKind::Receiver(_) => false,
    }
}

/// Whether a node starts a region: it fires, and nothing flows into it.
pub fn is_source(graph: &Graph, catalog: &Catalog, links: &Links, node: NodeId) -> bool {
    fires(graph, catalog, links, node)
        && links.inputs[node].is_empty()
        && !matches!(graph.nodes[node].kind, NodeKind::Boundary(PortKind::Output))
}

/// Whether a port that every node has is connected.
pub fn has_standard(graph: &Graph, node: NodeId, wanted: &[Standard]) -> bool {
    graph.nodes[node].ports.iter().any(|p| p.standard.is_some_and(|s| wanted.contains(&s)))
}
