use super::{
    Edge, Pose, PoseGraph, Window, heading,
    matcher::{Match, Matcher},
    table::Table,
};
use crate::scan::Point2;
use nalgebra::{Matrix3, Vector3};
use std::{cmp::Reverse, collections::BinaryHeap};

/// Scans to each side of the nearest one that a loop is searched among.
const CHAIN: usize = 10;
/// A turn of 1 rad adds as much drift as so many metres.
const TURN_LENGTH: f64 = 0.5;
/// A closed loop adds as much drift as at most so many metres.
const LOOP_LENGTH: f64 = 0.5;
/// A loop contradicts the graph if its χ² is greater than this, which is its mean for a right measurement of a pose.
const CONTRADICTION: f64 = 3.0;
/// On whole cells a scan fits to at least this share of what it does between them.
const BETWEEN_CELLS: f64 = 0.9;
/// Steps of the optimizer after a loop that contradicts the graph.
const STEPS: usize = 10;

/// When a scan is kept, and what it is compared with.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// A scan is kept when the robot has moved so far since the last one, in m …
    pub travel: f64,
    /// … or turned so far, in rad.
    pub turn: f64,
    /// Points farther away than this are left out, in m.
    pub reach: f64,
    /// The side of the cells in which scans are compared, in m.
    pub resolution: f64,
    /// The standard deviation of the distance between two sights of the same thing, in m.
    pub smear: f64,
    /// A scan is compared with so many before it.
    pub running: usize,
    /// How wrong odometry can be from one kept scan to the next.
    pub window: Window,
    /// Below this response odometry is believed, and not the comparison.
    pub least_response: f64,
    /// How far a pose drifts per metre of the way, in m.
    pub drift: f64,
    /// The greatest drift that is searched for a loop, in m.
    pub loop_distance: f64,
    /// A loop is closed from this response on.
    pub loop_response: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            travel: 0.3,
            turn: 0.35,
            reach: 20.0,
            resolution: 0.05,
            smear: 0.06,
            running: 20,
            window: Window { distance: 0.4, angle: 0.35 },
            least_response: 0.3,
            drift: 0.04,
            loop_distance: 4.0,
            loop_response: 0.6,
        }
    }
}

/// Localization and mapping with a graph of poses, in the manner of Karto (Vincent, Limketkai, Eriksen: Comparison of
/// Indoor Robot Localization Techniques in the Absence of GPS, 2010; thesis 4.3.5).
///
/// Keeps a scan whenever the robot has moved a little, finds its pose by comparison with the scans before it, and
/// adds it to the graph. When the robot comes back to a place, a comparison with the scans that it took there closes
/// a loop. The time for this hardly grows with the number of scans:
///
/// - A loop is only searched with scans from which the new one has drifted: that are far away along the graph, where
///   a closed loop is a short cut. So loops are closed every few metres of the way, and not at each scan, however
///   often the robot was at a place before.
/// - The whole graph is optimized only if a loop contradicts it. Else the new pose alone is moved to where
///   it agrees best with the loop and with the scans before it.
#[derive(Debug, Clone)]
pub struct Mapper {
    settings: Settings,
    graph: PoseGraph,
    /// The points of the kept scans in the frame of the robot.
    scans: Vec<Vec<Point2>>,
    /// The odometry of the scan that was kept last.
    odometry: Pose,
    /// Along each edge of the graph, by pose: the pose at its other end, and its length with turns.
    neighbours: Vec<Vec<(usize, f64)>>,
    loops: usize,
    table: Table,
    matcher: Matcher,
}

impl Mapper {
    /// A mapper that knows nothing yet.
    pub fn new(settings: Settings) -> Self {
        Self {
            graph: PoseGraph::default(),
            scans: Vec::new(),
            odometry: Pose::identity(),
            neighbours: Vec::new(),
            loops: 0,
            table: Table::new(settings.resolution, settings.smear),
            matcher: Matcher::default(),
            settings,
        }
    }

    /// The poses at which scans were kept, and what was measured between them.
    pub fn graph(&self) -> &PoseGraph {
        &self.graph
    }

    /// The points of the kept scans in the frame of the robot, in m; those of a pose have its number.
    pub fn scans(&self) -> &[Vec<Point2>] {
        &self.scans
    }

    /// How many loops were closed.
    pub fn loops(&self) -> usize {
        self.loops
    }

    /// The pose of the robot in the frame of the map, by odometry since the scan that was kept last. The map begins
    /// where odometry did when the first scan was kept.
    pub fn locate(&self, odometry: &Pose) -> Pose {
        self.graph.poses().last().map_or(*odometry, |last| last * self.odometry.inv_mul(odometry))
    }

    /// Whether a scan at this odometry has to be kept.
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
        let running = last.saturating_sub(self.settings.running.max(1) - 1)..last + 1;
        let Settings { window, least_response, .. } = self.settings;
        let found = self.compare(&points, &prediction, running, &window, least_response);
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

    /// Finds where points fit among some of the kept scans, if at least to a share of `least`.
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

    /// Adds an edge, which adds drift as one of at most `longest` m.
    fn connect(&mut self, from: usize, to: usize, pose: &Pose, information: Matrix3<f64>, longest: f64) {
        let measured = self.graph.poses()[from].inv_mul(pose);
        let length = measured.translation.vector.norm() + TURN_LENGTH * heading(&measured).abs();
        self.neighbours[from].push((to, length.min(longest)));
        self.neighbours[to].push((from, length.min(longest)));
        // Both are poses of the graph.
        let _ = self.graph.add_edge(Edge { from, to, measured, information });
    }

    /// Compares the scan that was kept last with those of other times around it.
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
        if closed.iter().any(|edge| edge.cost(self.graph.poses()) > CONTRADICTION) {
            self.graph.optimize(STEPS);
        } else if !closed.is_empty() {
            self.graph.settle_last();
        }
    }

    /// For each chain of scans that is near the scan `new`, but far away along the way that connects them: its scan
    /// that is nearest, and the length of the way.
    fn loop_candidates(&self, new: usize) -> Vec<(usize, f64)> {
        let Settings { travel, running, drift, loop_distance, .. } = self.settings;
        let ways = self.ways(new);
        let poses = self.graph.poses();
        let distance = |k: usize| (poses[k].translation.vector - poses[new].translation.vector).norm();
        let mut candidates: Vec<(usize, f64)> = Vec::new();
        let mut last = None;
        for (k, &way) in ways.iter().enumerate().take(new.saturating_sub(running)) {
            let near = travel * CHAIN as f64 + (drift * way).min(loop_distance);
            if way < travel * running as f64 * 0.5 || distance(k) > near {
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

    /// The length of the shortest way along the graph from one pose to each, in m, turns included (Dijkstra 1959).
    fn ways(&self, from: usize) -> Vec<f64> {
        let mut ways = vec![f64::INFINITY; self.scans.len()];
        ways[from] = 0.0;
        // Positive numbers have the order of their bits.
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

/// What odometry says about a short way: a tenth of it is uncertain, and a tenth of the turn.
fn odometry_information(moved: &Pose) -> Matrix3<f64> {
    let (way, turn) = (moved.translation.vector.norm(), heading(moved).abs());
    let (distance, angle) = (0.02 + 0.1 * way, 0.02 + 0.1 * turn + 0.05 * way);
    Matrix3::from_diagonal(&Vector3::new(distance.powi(-2), distance.powi(-2), angle.powi(-2)))
}

/// Whether the points decide where a scan lies, in all directions: to 10 cm.
fn is_certain(found: &Match) -> bool {
    let position = found.information.try_inverse().map(|c| c.fixed_view::<2, 2>(0, 0).into_owned());
    position.is_some_and(|p| p.symmetric_eigenvalues().max() < 0.01)
}
