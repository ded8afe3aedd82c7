use super::{
    Pose, PoseGraph, Settings, Window, heading,
    lost::{ENOUGH, Lost},
    scan_graph::ScanGraph,
    spread::odometry_information,
};
use crate::scan::{Point2, Pose2, PoseChange, UncertainPose};
use nalgebra::Matrix3;

/// Number of due scans in a row that agree with none before, after which the robot is lost: a single one is wrong where
/// a person stands before the scanner.
const DOUBTS: usize = 3;

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
/// The robot is lost after three due scans in a row that agree with none of the scans before (see [`is_lost`]). Then
/// the mapper keeps scans beside the map, and [`search`]es the map for what the robot sees. A mapper that was
/// [`read`](Self::read) from a file begins like that.
///
/// [`is_lost`]: Self::is_lost
/// [`search`]: Self::search
#[derive(Debug, Clone)]
pub struct Mapper {
    map: ScanGraph,
    /// Odometry at the last kept scan.
    odometry: Pose,
    /// Odometry at the last due scan, which was kept unless it agreed with no other.
    looked: Pose,
    /// Number of due scans since the last kept one.
    doubts: usize,
    /// Response of the last kept scan.
    response: f64,
    lost: Option<Lost>,
}

impl Mapper {
    /// Creates an empty mapper.
    pub fn new(settings: Settings) -> Self {
        Self::with(ScanGraph::new(settings), None)
    }

    /// Goes on with a map. The robot is lost: nothing says where on the map it is.
    pub(super) fn resume(map: ScanGraph) -> Self {
        let lost = Some(Lost::new(map.scans.len()));
        Self::with(map, lost)
    }

    fn with(map: ScanGraph, lost: Option<Lost>) -> Self {
        let odometry = Pose::identity();
        Self { map, odometry, looked: odometry, doubts: 0, response: 1.0, lost }
    }

    /// Poses of the kept scans and the measurements between them.
    pub fn graph(&self) -> &PoseGraph {
        &self.map.graph
    }

    /// Points of the kept scans in the frame of the robot, in m, by number of the pose.
    pub fn scans(&self) -> &[Vec<Point2>] {
        &self.map.scans
    }

    /// Number of closed loops.
    pub fn loops(&self) -> usize {
        self.map.loops
    }

    /// Returns `true` while the place of the robot on the map is not known. Its pose is a guess then, and scans kept
    /// since are not part of the map.
    pub fn is_lost(&self) -> bool {
        self.lost.is_some()
    }

    /// Number of kept scans that are part of the map: those before the robot was lost, or all.
    pub fn mapped(&self) -> usize {
        self.lost.as_ref().map_or(self.map.scans.len(), |lost| lost.first)
    }

    /// Response of the last kept scan among the scans before: 1 if all points are where they have points.
    pub fn response(&self) -> f64 {
        self.response
    }

    /// Pose of the robot in the frame of the map, by odometry since the last kept scan. The frame of the map is that of
    /// odometry at the first kept scan.
    pub fn locate(&self, odometry: &Pose) -> Pose {
        self.graph().poses().last().map_or(*odometry, |last| last * self.odometry.inv_mul(odometry))
    }

    /// Pose of the robot at this odometry with its covariance, in the frame of the map; `None` while the robot is lost.
    /// The first pose is known exactly.
    pub fn estimate(&self, odometry: &Pose) -> Option<UncertainPose> {
        let last = self.map.last().filter(|_| !self.is_lost())?;
        let since = self.odometry.inv_mul(odometry);
        let spread = self.map.spread.ahead(last, &self.graph().poses()[last], &since, &odometry_information(&since))?;
        let covariance = core::array::from_fn(|i| core::array::from_fn(|j| spread[(i, j)] as f32));
        Some(UncertainPose { pose: shown(&self.locate(odometry)), covariance })
    }

    /// Returns `true` if a scan at this odometry is due.
    pub fn is_due(&self, odometry: &Pose) -> bool {
        let moved = self.looked.inv_mul(odometry);
        let is_first = self.mapped() == self.map.scans.len() && (self.is_lost() || self.map.scans.is_empty());
        is_first
            || moved.translation.vector.norm() >= self.map.settings.travel
            || heading(&moved).abs() >= self.map.settings.turn
    }

    /// Keeps a scan, given by its points in the frame of the robot, and corrects the poses. A scan that agrees with no
    /// other is not kept.
    pub fn add(&mut self, odometry: &Pose, mut points: Vec<Point2>) -> Option<PoseChange> {
        points.retain(|p| f64::from(p.norm()) <= self.map.settings.reach);
        self.looked = *odometry;
        let first = self.lost.as_ref().map_or(0, |lost| lost.first);
        let Some(last) = self.map.last().filter(|last| *last >= first) else {
            self.begin(odometry, points);
            return None;
        };
        let prediction = self.locate(odometry);
        let before = last.saturating_sub(self.map.settings.window_scans.max(1) - 1).max(first)..last + 1;
        let Settings { window: Window { distance, angle }, least_response, .. } = self.map.settings;
        let wider = 1.0 + self.doubts as f64;
        let window = Window { distance: wider * distance, angle: wider * angle };
        let found = self.map.compare(&points, &prediction, before, &window, least_response);
        if found.is_none() && points.len() >= ENOUGH {
            return self.doubt(odometry, points);
        }
        let moved = self.odometry.inv_mul(odometry);
        let pose = found.as_ref().map_or(prediction, |m| m.pose);
        self.response = found.as_ref().map_or(0.0, |m| m.response);
        let information = found.map_or(Matrix3::zeros(), |m| m.information) + odometry_information(&moved);
        self.keep(odometry, pose, points);
        self.map.connect(last, last + 1, &pose, information);
        self.map.close_loops();
        None
    }

    /// Passes over a scan that agrees with none before. After some of them the robot is lost.
    fn doubt(&mut self, odometry: &Pose, points: Vec<Point2>) -> Option<PoseChange> {
        self.doubts += 1;
        if self.doubts < DOUBTS {
            return None;
        }
        let (pose, mapped) = (self.locate(odometry), self.mapped());
        // What a lost robot has seen before it is lost again belongs to no place.
        self.map.truncate(mapped);
        let change = (!self.is_lost()).then_some(PoseChange::Lost);
        self.lost = Some(Lost::new(mapped));
        self.keep(odometry, pose, points);
        change
    }

    /// Keeps the first scan of a map, or the first one beside a map.
    fn begin(&mut self, odometry: &Pose, points: Vec<Point2>) {
        let pose = self.graph().poses().last().copied().unwrap_or(*odometry);
        self.keep(odometry, pose, points);
        if !self.is_lost() {
            self.map.spread.begin();
        }
    }

    fn keep(&mut self, odometry: &Pose, pose: Pose, points: Vec<Point2>) {
        self.odometry = *odometry;
        self.doubts = 0;
        self.map.push(pose, points);
    }

    /// Continues the search for a robot that is lost: compares its newest scan with some places of the map, at any
    /// heading, which takes some milliseconds. Does nothing while the robot is not lost.
    ///
    /// If the scan fits one place alone, all that was seen since the robot was lost gets to its place on the map.
    pub fn search(&mut self) -> Option<PoseChange> {
        let is_found = self.lost.as_mut()?.search(&mut self.map);
        is_found.then(|| {
            self.lost = None;
            PoseChange::Localized
        })
    }
}

/// Pose in single precision, as nodes send it.
pub(super) fn shown(pose: &Pose) -> Pose2 {
    Pose2::new(pose.translation.x as f32, pose.translation.y as f32, heading(pose) as f32)
}
