use super::{Settings, Window, matcher::Match, scan_graph::ScanGraph};
use std::{cmp::Reverse, collections::BinaryHeap};

/// Number of scans on each side of the nearest one in which a loop is searched.
pub(super) const CHAIN: usize = 10;
/// χ² above which a loop contradicts the graph: the mean for a correct measurement of a pose.
const CONTRADICTION: f64 = 3.0;
/// Maximum number of steps of the optimizer after a loop that contradicts the graph.
const STEPS: usize = 10;

impl ScanGraph {
    /// Compares the last kept scan with earlier scans around it.
    pub fn close_loops(&mut self) {
        let new = self.scans.len() - 1;
        let points = std::mem::take(&mut self.scans[new]);
        let before = self.graph.edges().len();
        for (nearest, way) in self.loop_candidates(new) {
            let drift = self.settings.drift * way;
            let window = Window {
                distance: (self.settings.window.distance + drift).min(self.settings.loop_distance),
                angle: (self.settings.window.angle + 0.1 * drift).min(0.6),
            };
            let chain = nearest.saturating_sub(CHAIN)..(nearest + CHAIN + 1).min(new);
            let prediction = self.graph.poses()[new];
            let found = self.compare(&points, &prediction, chain, &window, self.settings.loop_response);
            if let Some(found) = found.filter(is_certain) {
                self.connect(nearest, new, &found.pose, found.information);
            }
        }
        self.scans[new] = points;
        let closed = &self.graph.edges()[before..];
        if closed.iter().any(|edge| edge.chi2(self.graph.poses()) > CONTRADICTION) {
            self.graph.optimize(STEPS);
        } else if !closed.is_empty() {
            self.graph.settle_last();
        }
    }

    /// Chains of consecutive scans that are near the scan `new`, but far away along the graph: for each of them the
    /// nearest scan, and the length of the path to it. Scans that no path reaches are left out: those of a map on which
    /// the robot is lost.
    fn loop_candidates(&self, new: usize) -> Vec<(usize, f64)> {
        let Settings { travel, window_scans, drift, loop_distance, .. } = self.settings;
        let ways = self.ways(new);
        let poses = self.graph.poses();
        let distance = |k: usize| (poses[k].translation.vector - poses[new].translation.vector).norm();
        let mut candidates: Vec<(usize, f64)> = Vec::new();
        let mut last = None;
        for (k, &way) in ways.iter().enumerate().take(new.saturating_sub(window_scans)) {
            let near = travel * CHAIN as f64 + (drift * way).min(loop_distance);
            if !way.is_finite() || way < travel * window_scans as f64 * 0.5 || distance(k) > near {
                continue;
            }
            let joins = last.is_some_and(|last| k - last == 1);
            last = Some(k);
            match candidates.last_mut() {
                Some(chain) if joins => {
                    if distance(k) < distance(chain.0) {
                        *chain = (k, way);
                    }
                }
                _ => candidates.push((k, way)),
            }
        }
        candidates.sort_by(|a, b| distance(a.0).total_cmp(&distance(b.0)));
        candidates.truncate(3);
        candidates
    }

    /// Lengths of the shortest paths along the graph from one pose to each, in m, including turns (Dijkstra 1959).
    fn ways(&self, from: usize) -> Vec<f64> {
        let mut ways = vec![f64::INFINITY; self.scans.len()];
        ways[from] = 0.0;
        // The bits of positive floating-point numbers have the same order as the numbers.
        let mut open = BinaryHeap::from([(Reverse(0_u64), from)]);
        while let Some((Reverse(bits), at)) = open.pop() {
            if f64::from_bits(bits) > ways[at] {
                continue;
            }
            for &(next, length) in &self.neighbours[at] {
                let way = ways[at] + length;
                if way < ways[next] {
                    ways[next] = way;
                    open.push((Reverse(way.to_bits()), next));
                }
            }
        }
        ways
    }
}

/// Returns `true` if the points determine the position in all directions, to 10 cm.
pub(super) fn is_certain(found: &Match) -> bool {
    let position = found.information.try_inverse().map(|c| c.fixed_view::<2, 2>(0, 0).into_owned());
    position.is_some_and(|p| p.symmetric_eigenvalues().max() < 0.01)
}
