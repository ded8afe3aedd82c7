//! Stamps that a program keeps. The stamp of a token is the firing time of the source from which it descends.
//!
//! Only nodes with a `deadline`, and nodes that take the context, use stamps. The search starts at these nodes and goes
//! upstream, so that all other tokens cost nothing. Its unit is the cluster: a firing of a cluster has one stamp, that
//! of the oldest token which the cluster takes. Example: `camera -> find`, `find.seen -> drive.goal` and
//! `drive.stuck -> log.line`, where `seen` and `stuck` are events, `goal` and `line` slots. If `drive` has a
//! `deadline`, its token from `find` and the cluster of `camera` and `find` have stamps; the token to `log` has none.

use super::{
    analysis::{Analysis, Stamps},
    cluster::{ClusterId, Guard},
};
use crate::{
    catalog::{ArgSig, Catalog},
    graph::{ConnectionId, Graph, NodeId, NodeKind},
};
use std::collections::{BTreeMap, BTreeSet};

/// Part of the graph that needs the stamps of its tokens.
enum Asks {
    Node(NodeId),
    Cluster(ClusterId),
}

/// Follows tokens upstream, from all nodes that use stamps to the sources.
pub fn stamps(graph: &Graph, catalog: &Catalog, analysis: &Analysis) -> Stamps {
    let mut slots_of: BTreeMap<NodeId, Vec<ConnectionId>> = BTreeMap::new();
    for &slot in &analysis.asynchronous.slots {
        slots_of.entry(graph.connections[slot].to.node).or_default().push(slot);
    }
    let first = |node: &NodeId| graph.nodes[*node].modifiers.deadline.is_some() || asks(graph, catalog, *node);
    let mut open: Vec<Asks> = graph.nodes.ids().filter(first).map(Asks::Node).collect();
    let (mut found, mut connections) = (Stamps::default(), BTreeSet::new());
    while let Some(next) = open.pop() {
        let mut sent_on: Vec<ConnectionId> = vec![];
        match next {
            Asks::Node(node) => {
                open.extend(analysis.fires_in(node).map(Asks::Cluster));
                sent_on.extend(slots_of.get(&node).into_iter().flatten());
                if let NodeKind::Sender(_) = graph.nodes[node].kind {
                    sent_on.extend(&analysis.links.inputs[node]);
                }
            }
            Asks::Cluster(cluster) if found.clusters.insert(cluster) => {
                // A cluster takes tokens from clusters upstream, and from events.
                let c = &analysis.clusters[cluster];
                open.extend(c.upstream.iter().copied().map(Asks::Cluster));
                let tokens = c.own_guards.iter().filter_map(|guard| match analysis.guards[*guard] {
                    Guard::Token(connection) => Some(connection),
                    _ => None,
                });
                sent_on.extend(tokens);
            }
            Asks::Cluster(_) => {}
        }
        // The sender may have sent in a firing or in a slot call: both need a stamp.
        sent_on.retain(|connection| connections.insert(*connection));
        open.extend(sent_on.into_iter().map(|connection| Asks::Node(graph.connections[connection].from.node)));
    }
    found.connections = connections.into_iter().collect();
    found
}

/// Returns `true` if a node can read stamps from the context. The sending end of a
/// cell counts if the receiving group needs them.
fn asks(graph: &Graph, catalog: &Catalog, node: NodeId) -> bool {
    match &graph.nodes[node].kind {
        NodeKind::Library(library) => {
            let signature = &catalog.signatures[library.signature];
            let slots = signature.slots.iter().flat_map(|s| &s.args);
            signature.process.iter().flatten().chain(slots).any(|arg| *arg == ArgSig::Ctx)
        }
        NodeKind::Each(each) => each.body.nodes.ids().any(|inner| asks(&each.body, catalog, inner)),
        NodeKind::Sender(far) => far.stamped,
        _ => false,
    }
}
