//! Conditions of the dispatcher: which cluster is ready.

use apex_dsl::program::ClusterRow;

/// The conditions that hold.
#[derive(Debug, Clone)]
pub struct Conditions {
    holds: Vec<bool>,
}

impl Conditions {
    /// Returns `count` conditions of which `initial` hold.
    pub fn new(count: usize, initial: &[usize]) -> Self {
        let mut conditions = Self { holds: vec![false; count] };
        initial.iter().for_each(|bit| conditions.set(*bit, true));
        conditions
    }

    /// Returns `true` if a condition holds.
    pub fn has(&self, bit: usize) -> bool {
        self.holds.get(bit).copied().unwrap_or(false)
    }

    /// Returns `true` if all of some conditions hold.
    pub fn all(&self, bits: &[usize]) -> bool {
        bits.iter().all(|bit| self.has(*bit))
    }

    /// Sets or clears a condition.
    pub fn set(&mut self, bit: usize, value: bool) {
        if let Some(place) = self.holds.get_mut(bit) {
            *place = value;
        }
    }

    fn put(&mut self, bits: &[usize], value: bool) {
        bits.iter().for_each(|bit| self.set(*bit, value));
    }

    /// Takes what a cluster needs, and returns `true` if it is ready.
    pub fn start(&mut self, cluster: &ClusterRow) -> bool {
        let [waits_for, takes, ..] = &cluster.sets;
        let ready = self.all(takes) && self.all(waits_for);
        if ready {
            self.put(takes, false);
        }
        ready
    }

    /// Ends a firing of a cluster, by its row.
    pub fn finish(&mut self, clusters: &[ClusterRow], row: usize) {
        let [_, _, sends, occupies, ..] = &clusters[row].sets;
        self.put(sends, true);
        self.put(occupies, false);
        self.settle(clusters, row);
    }

    /// Enables a cluster again if everything downstream of it has finished, and also each cluster upstream for which it
    /// was the last one (R4).
    pub fn settle(&mut self, clusters: &[ClusterRow], row: usize) {
        let mut has_settled = |row: usize| {
            let [.., notified_by, notifies] = &clusters[row].sets;
            let settles = !self.has(clusters[row].enabled) && self.all(notified_by);
            if settles {
                self.put(notifies, true);
            }
            settles
        };
        if has_settled(row) {
            for above in &clusters[row].above {
                has_settled(*above);
            }
        }
    }
}
