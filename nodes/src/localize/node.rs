use super::{
    BeamModel, Filter, MotionNoise, PoseFit, SearchSettings, Settings, TableError, TableSettings, VisibilityTable,
};
use crate::{
    io::{PlanOptions, ReadError, read_plan},
    scan::{Pose2, Scan, UncertainPose},
};
use apex_rt::{Event, Out, node};
use core::{f32::consts::PI, fmt};
use std::path::Path;

/// Standard deviation of the heading of an initial pose, in rad.
const TURNED: f32 = 0.2;

/// Error of a [`VectorMapLocalizer`] without a map.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum LocalizerError {
    /// The plan cannot be read.
    Plan(ReadError),
    /// The look-up table cannot be built.
    Table(TableError),
}

impl fmt::Display for LocalizerError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Plan(error) => error.fmt(f),
            Self::Table(error) => error.fmt(f),
        }
    }
}

impl core::error::Error for LocalizerError {}

/// Localization of a robot on a plan of the building: vector-based adaptive Monte Carlo localization (thesis 6.9; see
/// [`Filter`]).
///
/// `odometry` is the pose of the robot at the time of the scan, in any frame without jumps. `pose` is the pose on the
/// plan; it is ⊥ while the robot does not know it. `estimate` is the best guess, also then, with its covariance.
/// `fit` says how well particles and scan agree with it.
/// Without an `initial` pose the robot begins anywhere in the building, and has to drive some metres. With one that
/// scans confirm the pose is known after some scans, before the robot moves. `localized` comes
/// with the pose as soon as it is known; `lost` if scans no longer agree with the plan, for example because the robot
/// was carried away. Then it searches the whole plan. If odometry is not a number or more than 100 km away, both
/// outputs are ⊥.
///
/// The first firing reads the plan and builds its look-up table, which takes seconds; `cache` stores it for the next
/// time. Fails once if there is no valid plan, and then sends ⊥.
#[node]
#[derive(Debug)]
pub struct VectorMapLocalizer {
    /// File of the plan (see [`read_plan`]).
    #[param]
    plan: &'static str,
    /// Layers of a DXF file with walls, separated by commas; empty for all.
    #[param(default = "")]
    layers: &'static str,
    /// Length of a unit of the plan.
    #[param(unit = "m", default = 1.0, range = 0.0001..=10_000.0)]
    scale: f64,
    /// Folder for the look-up table; empty for none.
    #[param(default = "")]
    cache: &'static str,
    /// Side of a cell of the look-up table.
    #[param(unit = "m", default = 0.5, range = 0.05..=10.0)]
    cell: f32,
    /// Maximum distance of the walls that are looked up.
    #[param(unit = "m", default = 30.0, range = 1.0..=1000.0)]
    reach: f32,
    /// Forward position of the scanner in the frame of the robot.
    #[param(unit = "m", default = 0.0, range = -10.0..=10.0)]
    mount_x: f32,
    /// Position of the scanner to the left.
    #[param(unit = "m", default = 0.0, range = -10.0..=10.0)]
    mount_y: f32,
    /// Direction of the scanner's x axis, counter-clockwise from straight ahead.
    #[param(unit = "rad", default = 0.0, range = -PI..=PI)]
    mount_theta: f32,
    /// Number of beams of a scan that are compared with the plan.
    #[param(default = 30, range = 5..=128)]
    beams: usize,
    /// Standard deviation of a range: of the measurement and of the plan.
    #[param(unit = "m", default = 0.1, range = 0.01..=2.0)]
    sigma: f32,
    /// Minimum number of particles.
    #[param(default = 500, range = 10..=100_000)]
    min_particles: usize,
    /// Maximum number of particles, which is that of a start anywhere.
    #[param(default = 20_000, range = 10..=1_000_000)]
    max_particles: usize,
    /// Standard deviation of the position by odometry after 1 m.
    #[param(unit = "m", default = 0.08, range = 0.0..=1.0)]
    slip: f32,
    /// Standard deviation of the heading by odometry after 1 m.
    #[param(unit = "rad", default = 0.08, range = 0.0..=1.0)]
    veer: f32,
    /// Standard deviation of the heading by odometry after a turn of 1 rad.
    #[param(unit = "rad", default = 0.1, range = 0.0..=1.0)]
    skid: f32,
    /// Distance after which a scan is used.
    #[param(unit = "m", default = 0.2, range = 0.0..=10.0)]
    travel: f32,
    /// Rotation after which a scan is used.
    #[param(unit = "rad", default = 0.2, range = 0.0..=3.2)]
    turn: f32,
    /// Least share of the beams that agree with the plan where the robot is localized: lower with much furniture.
    #[param(default = 0.5, range = 0.0..=1.0)]
    agreement: f32,
    /// Standard deviation of an initial position.
    #[param(unit = "m", default = 0.5, range = 0.0..=10.0)]
    initial_spread: f32,
    /// Seed of the random numbers.
    #[param(default = 1)]
    seed: u64,
    filter: Option<Filter>,
    failed: bool,
    odometry: Option<Pose2>,
    /// Initial pose that came before the first odometry.
    initial: Option<Pose2>,
}

#[node]
impl VectorMapLocalizer {
    fn process(
        &mut self,
        odometry: &Pose2,
        scan: &Scan,
        pose: &mut Out<Pose2>,
        estimate: &mut Out<UncertainPose>,
        fit: &mut Out<PoseFit>,
        localized: Event<Pose2>,
        lost: Event<()>,
    ) -> Result<(), LocalizerError> {
        if self.failed || !odometry.is_usable() {
            return Ok(());
        }
        let mut filter = match self.filter.take() {
            Some(filter) => filter,
            None => self.open().inspect_err(|_| self.failed = true)?,
        };
        self.odometry = Some(*odometry);
        if let Some(initial) = self.initial.take() {
            filter.begin(&initial, odometry, (self.initial_spread, TURNED));
        }
        let change = filter.update(odometry, scan);
        let here = filter.pose_at(odometry);
        if let Some(change) = change {
            change.emit(here, localized, lost);
        }
        if filter.is_localized() {
            pose.set(here);
        }
        estimate.set(UncertainPose { pose: here, ..*filter.estimate() });
        fit.set(*filter.fit());
        self.filter = Some(filter);
        Ok(())
    }

    /// Begins at a pose on the plan. One that is not a number is ignored.
    #[slot]
    fn initial(&mut self, pose: &Pose2) {
        if !pose.is_usable() {
            return;
        }
        match (&mut self.filter, &self.odometry) {
            (Some(filter), Some(odometry)) => filter.begin(pose, odometry, (self.initial_spread, TURNED)),
            _ => self.initial = Some(*pose),
        }
    }

    /// Forgets the pose: the robot is anywhere in the building.
    #[slot]
    fn reset(&mut self) {
        self.initial = None;
        if let Some(filter) = &mut self.filter {
            filter.restart();
        }
    }

    /// Reads the plan and builds or loads its look-up table.
    fn open(&self) -> Result<Filter, LocalizerError> {
        let options = PlanOptions::of_layers(self.layers, self.scale);
        let plan = read_plan(self.plan, &options).map_err(LocalizerError::Plan)?;
        plan.warn(self.plan);
        let map = plan.map;
        let settings = TableSettings { cell: self.cell, reach: self.reach, ..TableSettings::default() };
        let table = if self.cache.is_empty() {
            VisibilityTable::build(&map, settings, |_| ())
        } else {
            VisibilityTable::cached(&map, settings, Path::new(self.cache), |_| ()).map(|cached| cached.table)
        };
        Ok(Filter::new(table.map_err(LocalizerError::Table)?, self.settings()))
    }

    fn settings(&self) -> Settings {
        let standard = Settings::default();
        Settings {
            mount: Pose2::new(self.mount_x, self.mount_y, self.mount_theta),
            beams: self.beams,
            model: BeamModel { sigma: self.sigma, ..standard.model },
            motion: MotionNoise { slip: self.slip, veer: self.veer, skid: self.skid },
            particles: [self.min_particles, self.max_particles],
            travel: self.travel,
            turn: self.turn,
            search: SearchSettings { sigma: standard.search.sigma.max(self.sigma), ..standard.search },
            agreement: self.agreement,
            seed: self.seed,
            ..standard
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scan::Point2;

    fn node(plan: &'static str) -> VectorMapLocalizer {
        use apex_rt::Construct;
        VectorMapLocalizer::construct((
            plan, "", 1.0, "", 0.5, 30.0, 0.0, 0.0, 0.0, 30, 0.1, 300, 3000, 0.08, 0.08, 0.1, 0.2, 0.2, 0.5, 0.5, 1,
        ))
    }

    /// A room of 8 m × 6 m with a corner that is cut off.
    fn room() -> &'static str {
        let path = std::env::temp_dir().join(format!("apex-room-{}.csv", std::process::id()));
        std::fs::write(&path, "0,0,8,0\n8,0,8,6\n8,6,3,6\n3,6,0,4\n0,4,0,0\n").expect("a temporary file");
        path.to_str().expect("a readable path").to_owned().leak()
    }

    fn scan(at: &Pose2) -> Scan {
        let corners = [(0.0, 0.0), (8.0, 0.0), (8.0, 6.0), (3.0, 6.0), (0.0, 4.0)].map(|(x, y)| Point2::new(x, y));
        let mut scan = Scan { angle_min: -2.35, angle_increment: 4.7 / 90.0, ..Scan::default() };
        scan.ranges.extend((0..91).map(|beam| {
            let direction = Point2::polar(1.0, at.theta + scan.angle_min + beam as f32 * scan.angle_increment);
            let wall = |i: usize| crate::map::LineSegment { a: corners[i], b: corners[(i + 1) % 5] };
            (0..5).filter_map(|i| wall(i).hit(at.position(), direction)).fold(f32::INFINITY, f32::min)
        }));
        scan
    }

    struct Sent {
        pose: Option<Pose2>,
        estimate: Option<UncertainPose>,
        localized: bool,
        lost: bool,
    }

    fn fire(node: &mut VectorMapLocalizer, odometry: &Pose2, scan: &Scan) -> Result<Sent, LocalizerError> {
        let (mut pose, mut estimate, mut fit) = (Out::new(), Out::new(), Out::new());
        let (mut localized, mut lost) = (None, None);
        let events = (apex_rt::event(&mut localized), apex_rt::event(&mut lost));
        node.process(odometry, scan, &mut pose, &mut estimate, &mut fit, events.0, events.1)?;
        let (pose, estimate) = (pose.get().copied(), estimate.get().copied());
        Ok(Sent { pose, estimate, localized: localized.is_some(), lost: lost.is_some() })
    }

    #[test]
    fn the_pose_is_sent_when_it_is_known() {
        let mut node = node(room());
        node.initial(&Pose2::new(f32::NAN, 0.0, 0.0));
        node.initial(&Pose2::new(2.2, 1.9, 0.1));
        let (mut localized, mut lost) = (0, 0);
        for i in 0..60 {
            let odometry = Pose2::new(0.1 * i as f32, 0.0, 0.0);
            let truth = Pose2::new(2.0 + odometry.x.min(3.0), 2.0, 0.0);
            // From half of the time on, something hides the walls.
            let scan =
                if i < 30 { scan(&truth) } else { Scan { ranges: [0.3; 91].into_iter().collect(), ..scan(&truth) } };
            let sent = fire(&mut node, &odometry, &scan).expect("a room");
            localized += usize::from(sent.localized);
            lost += usize::from(sent.lost);
            assert!(
                sent.estimate.is_some_and(|e| e.pose.is_finite()) && sent.pose.is_some() == (localized > lost),
                "{i}"
            );
            if i == 29 {
                let pose = sent.pose.expect("it is known");
                assert!((pose.position() - truth.position()).norm() < 0.1 && localized == 1 && lost == 0, "{pose:?}");
            }
        }
        assert_eq!(lost, localized);
    }

    #[test]
    fn what_is_no_number_is_no_pose() {
        let mut node = node(room());
        for x in [f32::NAN, f32::INFINITY, 1e30] {
            let sent = fire(&mut node, &Pose2::new(x, 0.0, 0.0), &Scan::default()).expect("nothing");
            assert!(sent.pose.is_none() && sent.estimate.is_none());
        }
        node.reset();
        assert!(fire(&mut node, &Pose2::default(), &Scan::default()).expect("a room").pose.is_none());
    }

    #[test]
    fn a_missing_plan_fails_once() {
        let mut node = node("/nowhere/plan.csv");
        let first = fire(&mut node, &Pose2::default(), &Scan::default());
        assert!(first.is_err_and(|e| e.to_string().starts_with("/nowhere/plan.csv: ")));
        assert!(fire(&mut node, &Pose2::default(), &Scan::default()).is_ok_and(|sent| sent.estimate.is_none()));
    }
}
