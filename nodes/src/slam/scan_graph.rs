use super::{
    Edge, Pose, PoseGraph, RobustKernel, Settings, Window, heading,
    matcher::{Match, Matcher},
    spread::Spread,
    table::Table,
};
use crate::scan::Point2;
use nalgebra::Matrix3;
use std::ops::Range;

/// Distance with the same drift as a turn of 1 rad, in m.
const TURN_LENGTH: f64 = 0.5;
/// Maximum distance that a loop edge contributes to the drift, in m.
const LOOP_LENGTH: f64 = 0.5;
/// Minimum ratio of the response on whole cells to the interpolated response.
const BETWEEN_CELLS: f64 = 0.9;

/// Pose graph with the scan of each pose.
#[derive(Debug, Clone)]
pub(super) struct ScanGraph {
    pub settings: Settings,
    pub graph: PoseGraph,
    /// Points of the scans in the frame of the robot, in m.
    pub scans: Vec<Vec<Point2>>,
    pub spread: Spread,
    /// Edges of the graph, by pose: the pose at the other end, and the length including turns.
    pub neighbours: Vec<Vec<(usize, f64)>>,
    /// Number of closed loops.
    pub loops: usize,
    table: Table,
    matcher: Matcher,
}

impl ScanGraph {
    pub fn new(settings: Settings) -> Self {
        Self {
            graph: PoseGraph::default(),
            scans: Vec::new(),
            spread: Spread::default(),
            neighbours: Vec::new(),
            loops: 0,
            table: Table::new(settings.resolution, settings.correlation_sigma),
            matcher: Matcher::default(),
            settings,
        }
    }

    /// Number of the last pose.
    pub fn last(&self) -> Option<usize> {
        self.scans.len().checked_sub(1)
    }

    /// Appends a pose and its scan.
    pub fn push(&mut self, pose: Pose, points: Vec<Point2>) {
        self.graph.add_pose(pose);
        self.scans.push(points);
        self.neighbours.push(Vec::new());
    }

    /// Removes the poses from a number on, of which no measurement leads to an earlier one.
    pub fn truncate(&mut self, first: usize) {
        self.graph.truncate(first);
        self.scans.truncate(first);
        self.neighbours.truncate(first);
        self.spread.truncate(first);
    }

    /// Finds the pose at which points match some of the scans, with a response of at least `least`.
    pub fn compare(
        &mut self,
        points: &[Point2],
        prediction: &Pose,
        scans: Range<usize>,
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

    /// Adds the measurements of another graph with the same poses, of which the first is known exactly.
    pub fn connect_all(&mut self, graph: &PoseGraph) {
        self.spread.begin();
        for Edge { from, to, measured, information, .. } in graph.edges() {
            let pose = graph.poses()[*from] * measured;
            self.connect(*from, *to, &pose, *information);
        }
    }

    /// Adds the measurement of a pose at another one. It closes a loop unless it was taken at the pose before.
    pub fn connect(&mut self, from: usize, to: usize, pose: &Pose, information: Matrix3<f64>) {
        let measured = self.graph.poses()[from].inv_mul(pose);
        let mut length = measured.translation.vector.norm() + TURN_LENGTH * heading(&measured).abs();
        if from + 1 != to {
            self.loops += 1;
            length = length.min(LOOP_LENGTH);
        }
        self.neighbours[from].push((to, length));
        self.neighbours[to].push((from, length));
        self.spread.learn(from, to, &self.graph.poses()[from], &measured, &information);
        // Cannot fail: both poses are in the graph.
        let _ = self.graph.add_edge(Edge { from, to, measured, information, kernel: RobustKernel::Square });
    }
}
