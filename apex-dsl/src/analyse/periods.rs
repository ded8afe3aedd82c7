//! Real periods: how often the nodes of a program with timers fire.
//!
//! A source begins its next iteration when all nodes downstream have finished the one before (R4). So a source that is
//! joined with a slower one fires as often as that one, and so do all sources that such joins connect.

use super::{
    analyse,
    analysis::Analysis,
    cluster::{Cluster, ClusterId, Guard},
};
use crate::{
    catalog::Catalog,
    graph::{Graph, NodeId},
    index::IdVec,
    report::Diagnostics,
};
use std::{collections::BTreeMap, time::Duration};

/// Source that fires less often than its `every` says.
pub struct Throttled {
    /// The source.
    pub node: NodeId,
    /// Its period as written, and the real one.
    pub periods: [Duration; 2],
    /// The source that sets the real period.
    pub slowest: NodeId,
}

impl Analysis {
    /// Real period of each source with `every`, and the source that sets it.
    fn paces(&self, graph: &Graph) -> BTreeMap<NodeId, (Duration, NodeId)> {
        let timers = |cluster: ClusterId| {
            let timer = |guard: &usize| match self.guards[*guard] {
                Guard::Timer(node) => Some((node, graph.nodes[node].modifiers.every?)),
                _ => None,
            };
            self.clusters[cluster].guards.iter().filter_map(timer)
        };
        let all = self.clusters.ids().flat_map(timers);
        let mut paces: BTreeMap<NodeId, (Duration, NodeId)> = all.map(|(node, every)| (node, (every, node))).collect();
        // Joins connect further ones: until nothing changes.
        loop {
            let mut changed = false;
            for cluster in self.clusters.ids().filter(|cluster| self.clusters[*cluster].fires) {
                let Some(slowest) = timers(cluster).map(|(node, _)| paces[&node]).max() else { continue };
                for (node, _) in timers(cluster) {
                    changed |= paces.insert(node, slowest) != Some(slowest);
                }
            }
            if !changed {
                return paces;
            }
        }
    }

    /// Real period of each cluster whose nodes depend on timers alone.
    pub fn real_periods(&self, graph: &Graph) -> IdVec<ClusterId, Option<Duration>> {
        let paces = self.paces(graph);
        let of_guard = |guard: &usize| match self.guards[*guard] {
            Guard::Events(_) => None,
            Guard::Timer(node) => Some(paces.get(&node).map(|(period, _)| *period)),
            Guard::Input(_) | Guard::React | Guard::Token(_) => Some(None),
        };
        let of_cluster = |cluster: &Cluster| {
            let periods = cluster.guards.iter().filter_map(of_guard);
            periods.collect::<Option<Vec<Duration>>>()?.into_iter().max()
        };
        self.clusters.iter().map(of_cluster).collect()
    }

    /// Sources that are joined with slower ones, and so fire less often than their `every` says.
    pub fn throttled(&self, graph: &Graph) -> Vec<Throttled> {
        let paces = self.paces(graph).into_iter();
        let slower = paces.filter_map(|(node, (real, slowest))| {
            let own = graph.nodes[node].modifiers.every.filter(|own| *own < real)?;
            Some(Throttled { node, periods: [own, real], slowest })
        });
        slower.collect()
    }
}

/// Real periods of the sources of a checked graph that fire less often than their `every` says.
pub fn throttled_periods(graph: &Graph, catalog: &Catalog) -> BTreeMap<NodeId, Duration> {
    if graph.nodes.iter().filter(|node| node.modifiers.every.is_some()).count() < 2 {
        return BTreeMap::new();
    }
    let Some(analysis) = analyse(graph, catalog, &mut Diagnostics::default()) else { return BTreeMap::new() };
    analysis.throttled(graph).into_iter().map(|throttled| (throttled.node, throttled.periods[1])).collect()
}
