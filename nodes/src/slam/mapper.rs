use super::{
    Edge, Pose, PoseGraph, RobustKernel, Window, heading,
    matcher::{Match, Matcher},
    table::Table,
};
use crate::scan::Point2;
use nalgebra::{Matrix3, Vector3};
use std::{cmp::Reverse, collections::BinaryHeap};

/// Number of scans on each side of the nearest one in which a loop is searched.
const CHAIN: usize = 10;
/// Distance with the same drift as a turn of 1 rad, in m.
const TURN_LENGTH: f64 = 0.5;
/// Maximum distance that a loop edge contributes to the drift, in m.
const LOOP_LENGTH: f64 = 0.5;
/// χ² above which a loop contradicts the graph: the mean for a correct measurement of a pose.
const CONTRADICTION: f64 = 3.0;
/// Minimum ratio of the response on whole cells to the interpolated response.
const BETWEEN_CELLS: f64 = 0.9;
/// Maximum number of steps of the optimizer after a loop that contradicts the graph.
const STEPS: usize = 10;

/// Settings of a [`Mapper`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Distance after which a new scan is kept, in m.
    pub travel: f64,
    /// Rotation after which a new scan is kept, in rad.
    pub turn: f64,
    /// Maximum distance of the used points, in m.
    pub reach: f64,
    /// Side of the cells for the comparison of scans, in m.
    pub resolution: f64,
    /// Standard deviation of the distance between two measurements of the same object, in m.
    pub correlation_sigma: f64,
    /// Number of previous scans that a scan is compared with.
    pub window_scans: usize,
    /// Maximum error of odometry between two kept scans.
    pub window: Window,
    /// Minimum response of a comparison. Below it, odometry is used instead.
    pub least_response: f64,
    /// Drift of a pose per metre of the path, in m.
    pub drift: f64,
    /// Maximum drift that is searched for a loop, in m.
    pub loop_distance: f64,
    /// Minimum response that closes a loop.
    pub loop_response: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            travel: 0.3,
            turn: 0.35,
            reach: 20.0,
            resolution: 0.05,
            correlation_sigma: 0.06,
            window_scans: 20,
            window: Window { distance: 0.4, angle: 0.35 },
            least_response: 0.3,
            drift: 0.04,
            loop_distance: 4.0,
            loop_response: 0.6,
        }
    }
}

/// Localization and mapping with a pose graph, in the manner of Karto (Vincent, Limketkai, Eriksen: Comparison of
/// Indoor Robot Localization Techniques in the Absence of GPS, 2010; thesis 4.3.5).
///
/// Keeps a scan whenever the robot has moved a little, finds its pose by comparison with the previous scans, and adds
/// it to the graph. When the robot comes back to a place, a comparison with the scans taken there closes a loop. The
/// time for this hardly grows with the number of scans:
///
/// - A loop is only searched among scans that are far away along the graph, from which the new scan may have drifted
///   and where a loop is a short cut. So loops are closed every few metres instead of at each scan, however often the
///   robot has been at a place.
/// - The whole graph is optimized only if a loop contradicts it. Otherwise, only the new pose is moved to best
///   agreement with the loop and with the previous scans.
#[derive(Debug, Clone)]
pub struct Mapper {
    settings: Settings,
    graph: PoseGraph,
    /// Points of the kept scans in the frame of the robot, in m.
    scans: Vec<Vec<Point2>>,
    /// Odometry at the last kept scan.
    odometry: Pose,
    /// Edges of the graph, by pose: the pose at the other end, and the length including turns.
    neighbours: Vec<Vec<(usize, f64)>>,
    loops: usize,
    table: Table,
    matcher: Matcher,
}

impl Mapper {
    /// Creates an empty mapper.
    pub fn new(settings: Settings) -> Self {
        Self {
            graph: PoseGraph::default(),
            scans: Vec::new(),
            odometry: Pose::identity(),
            neighbours: Vec::new(),
            loops: 0,
            table: Table::new(settings.resolution, settings.correlation_sigma),
            matcher: Matcher::default(),
            settings,
        }
    }

    /// Poses of the kept scans and the measurements between them.
    pub fn graph(&self) -> &PoseGraph {
        &self.graph
    }

    /// Points of the kept scans in the frame of the robot, in m, by number of the pose.
    pub fn scans(&self) -> &[Vec<Point2>] {
        &self.scans
    }

    /// Number of closed loops.
    pub fn loops(&self) -> usize {
        self.loops
    }

    /// Pose of the robot in the frame of the map, by odometry since the last kept scan. The frame of the map is that of
    /// odometry at the first kept scan.
    pub fn locate(&self, odometry: &Pose) -> Pose {
        self.graph.poses().last().map_or(*odometry, |last| last * self.odometry.inv_mul(odometry))
    }

    /// Returns `true` if a scan at this odometry has to be kept.
    pub fn is_due(&self, odometry: &Pose) -> bool {
        let moved = self.odometry.inv_mul(odometry);
        self.scans.is_empty()
            || moved.translation.vector.norm() >= self.settings.travel
            || heading(&moved).abs() >= self.settings.turn
    }

    /// Keeps a scan, given by its points in the frame of the robot, and corrects the poses.
    pub fn add(&mut self, odometry: &Pose, mut points: Vec<Point2>) {
        points.retain(|p| f64::from(p.norm()) <= self.settings.reach);
        let prediction = self.locate(odometry);
        let moved = self.odometry.inv_mul(odometry);
        self.odometry = *odometry;
        let Some(last) = self.scans.len().checked_sub(1) else {
            self.keep(prediction, points);
            return;
        };
        let window_scans = last.saturating_sub(self.settings.window_scans.max(1) - 1)..last + 1;
        let Settings { window, least_response, .. } = self.settings;
        let found = self.compare(&points, &prediction, window_scans, &window, least_response);
        let pose = found.as_ref().map_or(prediction, |m| m.pose);
        let information = found.map_or(Matrix3::zeros(), |m| m.information) + odometry_information(&moved);
        self.keep(pose, points);
        self.connect(last, last + 1, &pose, information, f64::INFINITY);
        self.close_loops();
    }

    fn keep(&mut self, pose: Pose, points: Vec<Point2>) {
        self.graph.add_pose(pose);
        self.scans.push(points);
        self.neighbours.push(Vec::new());
    }

    /// Finds the pose at which points match some of the kept scans, with a response of at least `least`.
    fn compare(
        &mut self,
        points: &[Point2],
        prediction: &Pose,
        scans: std::ops::Range<usize>,
        window: &Window,
        least: f64,
    ) -> Option<Match> {
        let farthest = points.iter().map(|p| f64::from(p.norm())).fold(0.0, f64::max);
        self.table.reset(prediction, farthest + window.distance);
        for scan in scans {
            self.table.add(&self.graph.poses()[scan], &self.scans[scan]);
        }
        let found = self.matcher.search(&self.table, points, prediction, window, BETWEEN_CELLS * least);
        found.filter(|m| m.response >= least)
    }

    /// Adds an edge. It contributes to the drift with at most `longest` m.
    fn connect(&mut self, from: usize, to: usize, pose: &Pose, information: Matrix3<f64>, longest: f64) {
        let measured = self.graph.poses()[from].inv_mul(pose);
        let length = measured.translation.vector.norm() + TURN_LENGTH * heading(&measured).abs();
        self.neighbours[from].push((to, length.min(longest)));
        self.neighbours[to].push((from, length.min(longest)));
        // Cannot fail: both poses are in the graph.
        let _ = self.graph.add_edge(Edge { from, to, measured, information, kernel: RobustKernel::Square });
    }

    /// Compares the last kept scan with earlier scans around it.
    fn close_loops(&mut self) {
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
                self.connect(nearest, new, &found.pose, found.information, LOOP_LENGTH);
                self.loops += 1;
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
    /// nearest scan, and the length of the path to it.
    fn loop_candidates(&self, new: usize) -> Vec<(usize, f64)> {
        let Settings { travel, window_scans, drift, loop_distance, .. } = self.settings;
        let ways = self.ways(new);
        let poses = self.graph.poses();
        let distance = |k: usize| (poses[k].translation.vector - poses[new].translation.vector).norm();
        let mut candidates: Vec<(usize, f64)> = Vec::new();
        let mut last = None;
        for (k, &way) in ways.iter().enumerate().take(new.saturating_sub(window_scans)) {
            let near = travel * CHAIN as f64 + (drift * way).min(loop_distance);
            if way < travel * window_scans as f64 * 0.5 || distance(k) > near {
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

/// Information of odometry on a short path: a tenth of the distance and a tenth of the turn are uncertain.
fn odometry_information(moved: &Pose) -> Matrix3<f64> {
    let (way, turn) = (moved.translation.vector.norm(), heading(moved).abs());
    let (distance, angle) = (0.02 + 0.1 * way, 0.02 + 0.1 * turn + 0.05 * way);
    Matrix3::from_diagonal(&Vector3::new(distance.powi(-2), distance.powi(-2), angle.powi(-2)))
}

/// Returns `true` if the points determine the position in all directions, to 10 cm.
fn is_certain(found: &Match) -> bool {
    let position = found.information.try_inverse().map(|c| c.fixed_view::<2, 2>(0, 0).into_owned());
    position.is_some_and(|p| p.symmetric_eigenvalues().max() < 0.01)
}
