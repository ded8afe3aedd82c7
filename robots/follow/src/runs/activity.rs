use crate::robot::Summit;
use apex_rt::{Observer, Program, Time};
use std::{fmt, time::Duration};

/// Notes failures, and the time for which each node was active.
pub struct Watch {
    pub now: Time,
    pub failures: Vec<String>,
    /// Time for which each node was active before, and since when it is now.
    nodes: Vec<(Duration, Option<Time>)>,
}

impl Watch {
    pub fn new() -> Self {
        let nodes = vec![(Duration::ZERO, None); <Summit as Program>::INFO.nodes.len()];
        Self { now: Time::ZERO, failures: vec![], nodes }
    }

    /// Nodes that were active up to the end of a run, and for how long.
    pub fn at(&self, end: Time) -> Vec<(&'static str, Duration)> {
        let total =
            |(before, since): &(Duration, Option<Time>)| *before + since.map_or(Duration::ZERO, |t| end.since(t));
        let names = <Summit as Program>::INFO.nodes.iter().map(|node| node.name);
        names.zip(self.nodes.iter().map(total)).filter(|(_, time)| !time.is_zero()).collect()
    }

    fn note(&mut self, failure: String) {
        if !self.failures.contains(&failure) {
            self.failures.push(failure);
        }
    }
}

impl Observer for Watch {
    fn activity(&mut self, node: usize, active: bool) {
        let (before, since) = &mut self.nodes[node];
        if active {
            since.get_or_insert(self.now);
        } else if let Some(since) = since.take() {
            *before += self.now.since(since);
        }
    }

    fn failed(&mut self, node: usize, error: &impl fmt::Display) {
        self.note(format!("`{}` failed: {error}", <Summit as Program>::INFO.nodes[node].name));
    }

    fn endless(&mut self, _nodes: &[usize], _counts: &[u32]) {
        self.note("endless cycle of tokens at one point in time".to_owned());
    }

    fn claim_failed(&mut self, claim: usize) {
        self.note(format!("the claim `{}` does not hold", <Summit as Program>::INFO.claims[claim]));
    }
}
