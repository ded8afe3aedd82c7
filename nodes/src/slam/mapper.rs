use super::{
    Change, Edge, Pose, PoseGraph, RobustKernel, Window, heading,
    loops::LOOP_LENGTH,
    lost::{ENOUGH, Lost},
    matcher::{Match, Matcher},
    spread::{Spread, odometry_information},
    table::Table,
};
use crate::scan::Point2;
use nalgebra::Matrix3;

/// Distance with the same drift as a turn of 1 rad, in m.
const TURN_LENGTH: f64 = 0.5;
/// Number of due scans in a row that agree with none of the scans before, after which the robot is lost: a single one is
/// wrong where somebody stands before the scanner.
const DOUBTS: usize = 3;
/// Minimum ratio of the response on whole cells to the interpolated response.
const BETWEEN_CELLS: f64 = 0.9;

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
    /// Minimum response of a scan that agrees with those before. With the other defaults it was at least 0.45 on the
    /// recordings of two buildings; after the robot was carried away, it was below 0.4 in 83 to 91 % of the cases.
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
            least_response: 0.4,
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
///
/// The robot is lost after three due scans in a row that agree with none of the scans before (see [`is_lost`]). Then the
/// mapper begins anew, beside the map, and [`search`]es the map for what the robot sees. A mapper that was
/// [`read`](Self::read) from a file begins like that.
///
/// [`is_lost`]: Self::is_lost
/// [`search`]: Self::search
#[derive(Debug, Clone)]
pub struct Mapper {
    pub(super) settings: Settings,
    pub(super) graph: PoseGraph,
    /// Points of the kept scans in the frame of the robot, in m.
    pub(super) scans: Vec<Vec<Point2>>,
    pub(super) spread: Spread,
    /// Odometry at the last kept scan.
    odometry: Pose,
    /// Odometry at the last due scan, which was kept unless it agreed with no other.
    looked: Pose,
    /// Number of due scans since the last kept one.
    doubts: usize,
    /// Response of the last kept scan.
    response: f64,
    pub(super) lost: Option<Lost>,
    /// Edges of the graph, by pose: the pose at the other end, and the length including turns.
    pub(super) neighbours: Vec<Vec<(usize, f64)>>,
    pub(super) loops: usize,
    table: Table,
    matcher: Matcher,
}

impl Mapper {
    /// Creates an empty mapper.
    pub fn new(settings: Settings) -> Self {
        Self {
            graph: PoseGraph::default(),
            scans: Vec::new(),
            spread: Spread::default(),
            odometry: Pose::identity(),
            looked: Pose::identity(),
            doubts: 0,
            response: 1.0,
            lost: None,
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

    /// Returns `true` while the place of the robot on the map is not known. Its pose is a guess then, and the scans that
    /// it has kept since are not part of the map.
    pub fn is_lost(&self) -> bool {
        self.lost.is_some()
    }

    /// Number of kept scans that are part of the map: those before the robot was lost, or all.
    pub fn mapped(&self) -> usize {
        self.lost.as_ref().map_or(self.scans.len(), |lost| lost.first)
    }

    /// Response of the last kept scan among the scans before: 1 if all points are where they have points.
    pub fn response(&self) -> f64 {
        self.response
    }

    /// Pose of the robot in the frame of the map, by odometry since the last kept scan. The frame of the map is that of
    /// odometry at the first kept scan.
    pub fn locate(&self, odometry: &Pose) -> Pose {
        self.graph.poses().last().map_or(*odometry, |last| last * self.odometry.inv_mul(odometry))
    }

    /// Covariance of x, y (in m) and heading (in rad) of the pose at this odometry, along the axes of the map; `None`
    /// while the robot is lost. The first pose is known exactly.
    pub fn covariance(&self, odometry: &Pose) -> Option<Matrix3<f64>> {
        let last = self.scans.len().checked_sub(1).filter(|_| !self.is_lost())?;
        let since = self.odometry.inv_mul(odometry);
        self.spread.ahead(last, &self.graph.poses()[last], &since, &odometry_information(&since))
    }

    /// Returns `true` if a scan at this odometry is due.
    pub fn is_due(&self, odometry: &Pose) -> bool {
        let moved = self.looked.inv_mul(odometry);
        let is_first = self.mapped() == self.scans.len() && (self.is_lost() || self.scans.is_empty());
        is_first
            || moved.translation.vector.norm() >= self.settings.travel
            || heading(&moved).abs() >= self.settings.turn
    }

    /// Keeps a scan, given by its points in the frame of the robot, and corrects the poses. A scan that agrees with none
    /// of those before is not kept.
    pub fn add(&mut self, odometry: &Pose, mut points: Vec<Point2>) -> Option<Change> {
        points.retain(|p| f64::from(p.norm()) <= self.settings.reach);
        self.looked = *odometry;
        let first = self.lost.as_ref().map_or(0, |lost| lost.first);
        let Some(last) = self.scans.len().checked_sub(1).filter(|last| *last >= first) else {
            self.begin(odometry, points);
            return None;
        };
        let prediction = self.locate(odometry);
        let before = last.saturating_sub(self.settings.window_scans.max(1) - 1).max(first)..last + 1;
        let Settings { window: Window { distance, angle }, least_response, .. } = self.settings;
        let wider = 1.0 + self.doubts as f64;
        let window = Window { distance: wider * distance, angle: wider * angle };
        let found = self.compare(&points, &prediction, before, &window, least_response);
        if found.is_none() && points.len() >= ENOUGH {
            return self.doubt(odometry, points);
        }
        let moved = self.odometry.inv_mul(odometry);
        let pose = found.as_ref().map_or(prediction, |m| m.pose);
        self.response = found.as_ref().map_or(0.0, |m| m.response);
        let information = found.map_or(Matrix3::zeros(), |m| m.information) + odometry_information(&moved);
        self.keep(odometry, pose, points);
        self.connect(last, last + 1, &pose, information, f64::INFINITY);
        self.close_loops();
        None
    }

    /// Passes over a scan that agrees with none before. After some of them the robot is lost.
    fn doubt(&mut self, odometry: &Pose, points: Vec<Point2>) -> Option<Change> {
        self.doubts += 1;
        if self.doubts < DOUBTS {
            return None;
        }
        let (pose, mapped) = (self.locate(odometry), self.mapped());
        // What a lost robot has seen before it is lost again belongs to no place.
        self.truncate(mapped);
        let change = (!self.is_lost()).then_some(Change::Lost);
        self.lost = Some(Lost::new(mapped));
        self.keep(odometry, pose, points);
        change
    }

    /// Keeps the first scan of a map, or the first one beside a map.
    fn begin(&mut self, odometry: &Pose, points: Vec<Point2>) {
        let pose = self.graph.poses().last().copied().unwrap_or(*odometry);
        self.keep(odometry, pose, points);
        if !self.is_lost() {
            self.spread.begin();
        }
    }

    fn keep(&mut self, odometry: &Pose, pose: Pose, points: Vec<Point2>) {
        self.odometry = *odometry;
        self.doubts = 0;
        self.push(pose, points);
    }

    /// Appends a pose and its scan.
    pub(super) fn push(&mut self, pose: Pose, points: Vec<Point2>) {
        self.graph.add_pose(pose);
        self.scans.push(points);
        self.neighbours.push(Vec::new());
    }

    /// Removes the poses from a number on, of which no measurement leads to an earlier one.
    fn truncate(&mut self, first: usize) {
        self.graph.truncate(first);
        self.scans.truncate(first);
        self.neighbours.truncate(first);
        self.spread.truncate(first);
    }

    /// Finds the pose at which points match some of the kept scans, with a response of at least `least`.
    pub(super) fn compare(
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

    /// Adds the measurements of a graph, whose poses are those of the mapper.
    pub(super) fn restore(&mut self, graph: &PoseGraph) {
        self.spread.begin();
        for Edge { from, to, measured, information, .. } in graph.edges() {
            let (first, second) = (*from.min(to), *from.max(to));
            let longest = if second == first + 1 { f64::INFINITY } else { LOOP_LENGTH };
            self.loops += usize::from(second != first + 1);
            let pose = graph.poses()[*from] * measured;
            self.connect(*from, *to, &pose, *information, longest);
        }
    }

    /// Adds an edge. It contributes to the drift with at most `longest` m.
    pub(super) fn connect(&mut self, from: usize, to: usize, pose: &Pose, information: Matrix3<f64>, longest: f64) {
        let measured = self.graph.poses()[from].inv_mul(pose);
        let length = measured.translation.vector.norm() + TURN_LENGTH * heading(&measured).abs();
        self.neighbours[from].push((to, length.min(longest)));
        self.neighbours[to].push((from, length.min(longest)));
        self.spread.learn(from, to, &self.graph.poses()[from], &measured, &information);
        // Cannot fail: both poses are in the graph.
        let _ = self.graph.add_edge(Edge { from, to, measured, information, kernel: RobustKernel::Square });
    }
}
