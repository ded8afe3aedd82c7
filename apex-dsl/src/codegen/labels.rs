//! Names of the rows of a program and of the functions that work on them.

use super::{
    generator::Generator,
    names::{constant_name, unused, valid},
};
use crate::{
    analyse::{Analysis, ClusterId},
    graph::{Graph, NodeId, PortId},
    index::IdVec,
    program::Wiring,
};
use std::collections::{BTreeMap, BTreeSet};

/// Names of rows and functions, which are those of the text.
pub struct Labels {
    /// Rows of the nodes that can be active: `WAITING`.
    pub nodes: BTreeMap<NodeId, String>,
    /// Rows of ports: `WAITING_SIGNAL`.
    pub ports: BTreeMap<PortId, String>,
    /// Functions of slots: `stopped_to_waiting_enable`.
    pub slots: Vec<String>,
    /// Functions of clusters: `fire_camera`, by the first node of its schedule.
    pub clusters: IdVec<ClusterId, String>,
}

impl Labels {
    /// The names in a program or in a part of one.
    pub fn new(generator: &Generator<'_>, graph: &Graph, analysis: &Analysis, wiring: &Wiring) -> Self {
        let path = |node: NodeId| graph.path(node).replace('.', "_");
        let mut used = BTreeSet::new();
        let mut named = |name: String| unused(name.chars().map(valid).collect(), &mut used);
        let slots = wiring.slots.iter().map(|slot| {
            let c = &graph.connections[slot.connection];
            let (from, to) = (generator.name(c.from), path(c.to.node));
            let subject = graph.nodes[c.to.node].interrupts().and_then(|_| to.strip_suffix("_cancel"));
            let to = subject.unwrap_or(&to);
            named(format!("{from}_to_{to}_{}", graph.port(c.to).name))
        });
        let slots = slots.collect();
        let clusters = analysis.clusters.iter().map(|cluster| {
            let first = cluster.schedule().first().map(|node| path(*node)).unwrap_or_default();
            named(format!("fire_{first}"))
        });
        let clusters = clusters.collect();
        let mut used = BTreeSet::new();
        let mut constant = |name: &str| unused(constant_name(name), &mut used);
        let nodes = wiring.nodes.iter().map(|node| (*node, constant(&path(*node)))).collect();
        let ports = wiring.ports().map(|port| (port.end, constant(&generator.name(port.end).to_string()))).collect();
        Self { nodes, ports, slots, clusters }
    }
}
