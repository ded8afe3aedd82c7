//! Upper bound of the steps that the dispatcher takes until all consequences of a firing have finished.

use super::{analysis::Analysis, cluster::ClusterId};
use crate::graph::{ConnectionId, Flow, Graph};
use std::collections::{BTreeMap, btree_map::Entry};

/// Action that takes one step: the firing of a cluster, or the call of the slot at the end of a connection.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Step {
    Cluster(ClusterId),
    Slot(ConnectionId),
}

impl Analysis {
    /// Largest number of steps from a firing of `cluster` until everything downstream has finished and all slots that
    /// it reaches have been called. `None` if there is no bound, because tokens can circulate.
    pub fn steps_after(&self, graph: &Graph, cluster: ClusterId) -> Option<u64> {
        // Depth-first search: a step is counted after all that it causes.
        let mut known = BTreeMap::new();
        let mut open = vec![(Step::Cluster(cluster), false)];
        while let Some((step, counted)) = open.pop() {
            let next = self.caused(graph, step);
            if counted {
                // A step that is not known by now leads back to this one.
                let below = next.iter().map(|next| *known.get(next)?);
                let steps: Option<u64> =
                    below.into_iter().try_fold(1u64, |sum, steps: Option<u64>| Some(sum.saturating_add(steps?)));
                known.insert(step, steps);
            } else if let Entry::Vacant(entry) = known.entry(step) {
                entry.insert(None);
                open.push((step, true));
                open.extend(next.into_iter().filter(|next| !known.contains_key(next)).map(|next| (next, false)));
            }
        }
        known.get(&Step::Cluster(cluster)).copied().flatten()
    }

    /// Steps that a step may cause. A cluster that takes tokens from several clusters fires once, when all tokens have
    /// arrived, but is counted for each of them.
    fn caused(&self, graph: &Graph, step: Step) -> Vec<Step> {
        let after = |connection: &ConnectionId| {
            let c = &graph.connections[*connection];
            match graph.flow(c) {
                _ if !self.asynchronous.live[*connection] => None,
                Flow::ToSlot => Some(Step::Slot(*connection)),
                Flow::ToInput => self.fires_in(c.to.node).map(Step::Cluster),
                Flow::Synchronous => None,
            }
        };
        match step {
            Step::Cluster(cluster) => {
                let cluster = &self.clusters[cluster];
                let down = cluster.downstream.iter().copied().map(Step::Cluster);
                down.chain(cluster.sends.iter().filter_map(after)).collect()
            }
            Step::Slot(connection) => self.asynchronous.causes(connection).iter().filter_map(after).collect(),
        }
    }
}
