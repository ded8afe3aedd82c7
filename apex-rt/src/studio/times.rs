use super::message::NodeTimes;
use core::time::Duration;
use std::{time::Instant, vec, vec::Vec};

/// Interval at which times are sent.
const INTERVAL: Duration = Duration::from_millis(250);

/// Measured calls of one thread group.
#[derive(Default)]
pub struct Times {
    /// Calls in progress, innermost last: the node, the beginning, and the duration of the calls inside in ns.
    running: Vec<(usize, Instant, u64)>,
    nodes: Vec<NodeTimes>,
    sent: Option<Instant>,
}

impl Times {
    /// A call of a node begins.
    pub fn begin(&mut self, node: usize) {
        self.running.push((node, Instant::now(), 0));
    }

    /// The innermost call ends, if it is one of `node`. Calls that began before the measurement are left out.
    pub fn end(&mut self, node: usize) {
        let Some((_, start, inner)) = self.running.pop_if(|(running, ..)| *running == node) else { return };
        let all = u64::try_from(start.elapsed().as_nanos()).unwrap_or(u64::MAX);
        if let Some((_, _, outer)) = self.running.last_mut() {
            *outer += all;
        }
        if self.nodes.len() <= node {
            self.nodes.resize_with(node + 1, NodeTimes::default);
        }
        let (times, own) = (&mut self.nodes[node], all.saturating_sub(inner));
        times.node = node as u32;
        times.calls += 1;
        times.total += own;
        times.worst = times.worst.max(own);
    }

    /// Returns all times, if it is time to send them. Called between two reactions.
    pub fn due(&mut self) -> Option<Vec<NodeTimes>> {
        // What a panic has interrupted does not end.
        self.running.clear();
        if self.sent.is_some_and(|sent| sent.elapsed() < INTERVAL) {
            return None;
        }
        self.sent = Some(Instant::now());
        Some(self.nodes.iter().filter(|times| times.calls > 0).copied().collect())
    }

    /// Forgets everything.
    pub fn clear(&mut self) {
        if self.sent.is_some() {
            (self.running, self.nodes, self.sent) = (vec![], vec![], None);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inner_calls_do_not_count_for_outer_ones() {
        let mut times = Times::default();
        times.end(3);
        times.begin(1);
        times.begin(0);
        std::thread::sleep(Duration::from_millis(20));
        times.end(0);
        times.end(1);
        let all = times.due().expect("they were never sent");
        assert_eq!(all.iter().map(|times| (times.node, times.calls)).collect::<Vec<_>>(), [(0, 1), (1, 1)]);
        assert!(all[0].total >= 20_000_000 && all[1].total < all[0].total && all[0].worst == all[0].total);
        assert!(times.due().is_none());
    }
}
