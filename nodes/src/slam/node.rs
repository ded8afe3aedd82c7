use super::{Mapper, Pose, PosedScans, Settings, Window, mapper::shown, pose, selected_scans};
use crate::{
    io::ReadError,
    scan::{BeamDirections, Pose2, Scan, UncertainPose},
};
use apex_rt::{Event, Out, node};
use core::{f32::consts::PI, fmt};
use std::path::Path;

/// Error of the map of a [`GraphSlam`].
#[derive(Debug)]
pub enum SlamError {
    /// The map cannot be read.
    Read(ReadError),
    /// The map cannot be written: file and error.
    Write(&'static str, std::io::Error),
}

impl fmt::Display for SlamError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Read(error) => error.fmt(f),
            Self::Write(file, error) => write!(f, "cannot write `{file}`: {error}"),
        }
    }
}

impl core::error::Error for SlamError {}

/// Simultaneous localization and mapping with a pose graph, in the manner of Karto, with a bounded number of scans for
/// the map (thesis 4.3.5; see [`Mapper`] and [`selected_scans`]).
///
/// `odometry` is the pose of the robot at the time of the scan, in any frame without jumps. `pose` is the corrected
/// pose in the frame of the map, which is that of odometry at the first scan; it is sent for every scan. `scans` are
/// those of which [`DrawScans`] draws the map, at their corrected poses; they are sent for the first kept scan and then
/// for every `map_every`-th one, otherwise ⊥. With `whole` they are all of them, not a bounded number. If odometry is
/// not a number or more than 100 km away, all outputs are ⊥ and the scan is not used.
///
/// `estimate` says how sure the pose is: its covariance is the drift since the first scan, by the path of measurements
/// that says most. `response` is the agreement of the last kept scan with the scans before: 1 if all its points are
/// where they have points, 0 if it has none within reach. `lost` comes after three scans in a row that agree neither
/// with those before nor with odometry, each `travel` or `turn` after the other: the robot was carried away, or its
/// wheels slipped by metres. Then all outputs are ⊥, and the node compares what it sees with the whole map. `localized`
/// comes with the pose as soon as one place alone fits; this takes a firing for two metres of the path of the map, and
/// the robot may have to move if places look alike. What was seen in the meantime gets into the map.
///
/// With a `file` the node begins lost on the map that the slot `save` wrote there, if there is one; `pose` is then in
/// the frame of that map, which grows.
///
/// Scans should show stationary objects only: remove other robots with [`ShortSegmentFilter`].
///
/// [`DrawScans`]: super::DrawScans
/// [`ShortSegmentFilter`]: crate::scan::ShortSegmentFilter
#[node]
#[derive(Debug)]
pub struct GraphSlam {
    /// Forward position of the scanner in the frame of the robot.
    #[param(unit = "m", default = 0.0, range = -10.0..=10.0)]
    mount_x: f32,
    /// Position of the scanner to the left.
    #[param(unit = "m", default = 0.0, range = -10.0..=10.0)]
    mount_y: f32,
    /// Direction of the scanner's x axis, counter-clockwise from straight ahead.
    #[param(unit = "rad", default = 0.0, range = -PI..=PI)]
    mount_theta: f32,
    /// Distance after which a new scan is kept.
    #[param(unit = "m", default = 0.3, range = 0.01..=10.0)]
    travel: f32,
    /// Rotation after which a new scan is kept.
    #[param(unit = "rad", default = 0.35, range = 0.01..=3.2)]
    turn: f32,
    /// Maximum distance of the used points from the robot.
    #[param(unit = "m", default = 20.0, range = 1.0..=100.0)]
    reach: f32,
    /// Maximum error of odometry between two kept scans, along x and y.
    #[param(unit = "m", default = 0.4, range = 0.05..=2.0)]
    slip: f32,
    /// Maximum error of the heading of odometry between two kept scans.
    #[param(unit = "rad", default = 0.35, range = 0.01..=1.0)]
    skid: f32,
    /// Standard deviation of the distance between two measurements of the same object; smaller with a good scanner in
    /// small rooms.
    #[param(unit = "m", default = 0.06, range = 0.005..=1.0)]
    correlation_sigma: f32,
    /// Number of previous scans that a scan is compared with.
    #[param(default = 20, range = 1..=1000)]
    window_scans: usize,
    /// Drift of a pose per metre of the path. The search for loops is extended by the accumulated drift.
    #[param(default = 0.04, range = 0.0..=1.0)]
    drift: f32,
    /// Maximum drift that is searched for a loop. The computing time grows with its square.
    #[param(unit = "m", default = 4.0, range = 0.0..=10.0)]
    loop_distance: f32,
    /// Minimum response that closes a loop: 1 if all points of a scan are where earlier scans have points.
    #[param(default = 0.6, range = 0.0..=1.0)]
    loop_response: f32,
    /// Number of kept scans per map.
    #[param(default = 5, range = 1..=1000)]
    map_every: u32,
    /// Choice of all kept scans for each map, so that no place is forgotten. The time to draw a map grows with them.
    #[param(default = false)]
    whole: bool,
    /// File of the map for [`Mapper::read`]; empty for none.
    #[param(default = "")]
    file: &'static str,
    mapper: Option<Mapper>,
    directions: BeamDirections,
    failed: bool,
}

#[node]
impl GraphSlam {
    fn process(
        &mut self,
        odometry: &Pose2,
        scan: &Scan,
        pose: &mut Out<Pose2>,
        scans: &mut Out<PosedScans>,
        estimate: &mut Out<UncertainPose>,
        response: &mut Out<f32>,
        localized: Event<Pose2>,
        lost: Event<()>,
    ) -> Result<(), SlamError> {
        let Some(odometry) = usable(odometry).filter(|_| !self.failed) else { return Ok(()) };
        let mut mapper = match self.mapper.take() {
            Some(mapper) => mapper,
            None => self.open().inspect_err(|_| self.failed = true)?,
        };
        let before = mapper.mapped();
        let mount = Pose2::new(self.mount_x, self.mount_y, self.mount_theta);
        let due = mapper.is_due(&odometry);
        let change = if due {
            let mount = mount.transform();
            mapper.add(&odometry, self.directions.points(scan).map(|(_, p)| mount.to_outer(p)).collect())
        } else {
            mapper.search()
        };
        if let Some(change) = change {
            change.emit(shown(&mapper.locate(&odometry)), localized, lost);
        }
        if let Some(known) = mapper.estimate(&odometry) {
            pose.set(known.pose);
            estimate.set(known);
            response.set(mapper.response() as f32);
        }
        let count = mapper.mapped();
        if count != before && (change.is_some() || (count - 1).is_multiple_of(self.map_every.max(1) as usize)) {
            let scans = scans.get_mut();
            if self.whole {
                mapper.write_scans(0..count, mount.position(), scans);
            } else {
                mapper.write_scans(selected_scans(count), mount.position(), scans);
            }
        }
        self.mapper = Some(mapper);
        Ok(())
    }

    /// Discards map and poses, and begins a new map at the next odometry.
    #[slot]
    fn reset(&mut self) {
        self.mapper = Some(Mapper::new(self.settings()));
        self.failed = false;
    }

    /// Writes the map to its file.
    #[slot]
    fn save(&mut self) -> Result<(), SlamError> {
        match &self.mapper {
            // A shadow repeats the run of another process, which has written the map.
            Some(mapper) if !self.file.is_empty() && !apex_rt::is_shadow() => {
                mapper.write(self.file).map_err(|error| SlamError::Write(self.file, error))
            }
            _ => Ok(()),
        }
    }

    /// Begins a map, or goes on with the one of the file.
    fn open(&self) -> Result<Mapper, SlamError> {
        if self.file.is_empty() || !Path::new(self.file).exists() {
            return Ok(Mapper::new(self.settings()));
        }
        Mapper::read(self.file, self.settings()).map_err(SlamError::Read)
    }

    fn settings(&self) -> Settings {
        Settings {
            travel: f64::from(self.travel),
            turn: f64::from(self.turn),
            reach: f64::from(self.reach),
            window: Window { distance: f64::from(self.slip), angle: f64::from(self.skid) },
            correlation_sigma: f64::from(self.correlation_sigma),
            window_scans: self.window_scans,
            drift: f64::from(self.drift),
            loop_distance: f64::from(self.loop_distance),
            loop_response: f64::from(self.loop_response),
            ..Settings::default()
        }
    }
}

/// Odometry in double precision, or `None` if it is NaN or out of range.
fn usable(odometry: &Pose2) -> Option<Pose> {
    odometry.is_usable().then(|| pose(odometry.x.into(), odometry.y.into(), odometry.theta.into()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        map::{Grid, Occupancy},
        scan::Point2,
        slam::ScanDrawer,
    };
    use apex_rt::{Construct, event};

    const MOUNT: Pose2 = Pose2::new(0.2, 0.0, 0.1);

    fn node(map_every: u32, file: &'static str) -> GraphSlam {
        let Pose2 { x, y, theta } = MOUNT;
        GraphSlam::construct((
            x, y, theta, 0.3, 0.35, 20.0, 0.4, 0.35, 0.06, 20, 0.04, 4.0, 0.6, map_every, false, file,
        ))
    }

    /// Tokens that a firing sends.
    #[derive(Debug, Default, PartialEq)]
    struct Sent {
        pose: Option<Pose2>,
        scans: Option<PosedScans>,
        estimate: Option<UncertainPose>,
        localized: Option<Pose2>,
        lost: bool,
    }

    fn fire(node: &mut GraphSlam, odometry: &Pose2, scan: &Scan) -> Result<Sent, SlamError> {
        let (mut pose, mut scans, mut estimate, mut response) = (Out::new(), Out::new(), Out::new(), Out::new());
        let (mut localized, mut lost) = (None, None);
        let events = (event(&mut localized), event(&mut lost));
        node.process(odometry, scan, &mut pose, &mut scans, &mut estimate, &mut response, events.0, events.1)?;
        let (scans, lost) = (scans.get().cloned(), lost.is_some());
        Ok(Sent { pose: pose.get().copied(), scans, estimate: estimate.get().copied(), localized, lost })
    }

    /// A scan of a room of 8 m × 6 m with its centre at the origin, and with a pillar in it.
    fn scan(robot: &Pose2) -> Scan {
        let at = robot.compose(&MOUNT);
        let mut scan = Scan { angle_min: -2.0, angle_increment: 0.02, ..Scan::default() };
        let range = |beam: usize| {
            let direction = Point2::polar(1.0, at.theta + scan.angle(beam));
            let wall = |from: f32, d: f32, half: f32| if d == 0.0 { f32::MAX } else { (d.signum() * half - from) / d };
            let walls = wall(at.x, direction.x, 4.0).min(wall(at.y, direction.y, 3.0));
            let pillar = Point2::new(2.5, 1.0) - at.position();
            let (along, aside) = (pillar.dot(direction), pillar.dot(direction.perpendicular()));
            let hit = along - (0.16 - aside * aside).max(0.0).sqrt();
            if aside.abs() < 0.4 && along > 0.0 { hit.min(walls) } else { walls }
        };
        let ranges: crate::scan::Ranges = (0..200).map(range).collect();
        scan.ranges = ranges;
        scan
    }

    fn drawn(scans: &PosedScans) -> Grid<Occupancy> {
        let mut map = Grid::default();
        ScanDrawer::default().draw(scans, 0.1, &mut map).expect("a map of a room");
        map
    }

    /// Drives rounds in the room with odometry that turns too little. Returns the largest errors in m of the corrected
    /// pose and of odometry, and the maps of the
    /// sent scans.
    fn drive(node: &mut GraphSlam, steps: usize) -> (f32, f32, Vec<Grid<Occupancy>>) {
        let step = Pose2::new(0.1, 0.0, 0.05);
        let start = Pose2::new(0.0, -2.0, 0.0);
        let (mut truth, mut odometry) = (start, start);
        let (mut worst, mut off, mut maps) = (0.0_f32, 0.0_f32, Vec::new());
        for _ in 0..steps {
            let sent = fire(node, &odometry, &scan(&truth)).expect("no file");
            let estimate = sent.estimate.expect("an estimate");
            assert!(sent.pose == Some(estimate.pose) && !sent.lost && sent.localized.is_none());
            let error = (estimate.pose.position() - truth.position()).norm();
            assert!(error < 0.05 + 3.0 * estimate.deviation() && estimate.deviation() < 0.5, "{error} m, {estimate:?}");
            worst = worst.max(error);
            off = off.max((odometry.position() - truth.position()).norm());
            maps.extend(sent.scans.as_ref().map(drawn));
            truth = truth.compose(&step);
            odometry = odometry.compose(&Pose2::new(0.1, 0.0, 0.045));
        }
        (worst, off, maps)
    }

    #[test]
    fn poses_are_corrected_and_maps_are_sent() {
        let mut node = node(5, "");
        let (worst, odometry, maps) = drive(&mut node, 300);
        assert!(worst < 0.15 && odometry > 1.0, "{worst} m, odometry {odometry} m");
        let mapper = node.mapper.as_ref().expect("a mapper");
        assert_eq!(maps.len(), mapper.scans().len().div_ceil(5));
        assert!(mapper.loops() > 0);
        let map = maps.last().expect("a map");
        for (x, y, what) in
            [(0.0, 0.0, Occupancy::Free), (2.1, 1.0, Occupancy::Occupied), (9.0, 0.0, Occupancy::Unknown)]
        {
            let near = (-2..=2).any(|i| {
                let p = Point2::new(x + 0.1 * i as f32, y);
                map.at(p).copied().unwrap_or_default() == what
            });
            assert!(near, "{what:?} at {x}, {y}");
        }
    }

    #[test]
    fn what_is_no_number_is_no_pose() {
        let mut node = node(1, "");
        let fire = |node: &mut GraphSlam, odometry, scan: &Scan| fire(node, &odometry, scan).expect("no file");
        for x in [f32::NAN, f32::INFINITY, 1e30] {
            assert_eq!(fire(&mut node, Pose2::new(x, 0.0, 0.0), &Scan::default()), Sent::default());
        }
        for x in [0.0, 0.5, 9e4, -9e4] {
            let odd = Scan {
                angle_increment: f32::NAN,
                ranges: [1.0, 1e30, f32::NAN].into_iter().collect(),
                ..Scan::default()
            };
            fire(&mut node, Pose2::new(x, 0.0, 0.0), &Scan::default());
            assert!(fire(&mut node, Pose2::new(x, 1.0, 0.0), &odd).pose.is_some(), "{x}");
        }
        node.reset();
        let sent = fire(&mut node, Pose2::new(5.0, 0.0, 0.0), &Scan::default());
        assert_eq!(sent.pose, Some(Pose2::new(5.0, 0.0, 0.0)), "a new map begins where odometry is");
    }

    #[test]
    fn a_lost_robot_has_no_pose() {
        let mut node = node(1, "");
        drive(&mut node, 40);
        // It looks through a wall, and what it sees turns with it.
        let strange = Scan { ranges: (0..200).map(|i| [1.0, 6.0][i % 2]).collect(), ..scan(&Pose2::default()) };
        let mut odometry = Pose2::new(3.0, 3.0, 0.0);
        let sent: Vec<Sent> = (0..20)
            .map(|_| {
                odometry = odometry.compose(&Pose2::new(0.15, 0.0, 0.0));
                fire(&mut node, &odometry, &strange).expect("no file")
            })
            .collect();
        let at = sent.iter().position(|sent| sent.lost).expect("it is lost");
        assert!(sent[..at].iter().all(|sent| sent.pose.is_some()));
        assert!(sent[at + 1..].iter().all(|sent| *sent == Sent::default()), "{:?}", sent[at + 1]);
    }

    #[test]
    fn a_map_is_saved_and_read_again() {
        let file = std::env::temp_dir().join(format!("apex-slam-node-{}.g2o", std::process::id()));
        let name: &'static str = file.to_str().expect("UTF-8").to_owned().leak();
        let mut first = node(5, name);
        drive(&mut first, 100);
        let scans = first.mapper.as_ref().expect("a mapper").scans().len();
        first.save().expect("a temporary file");
        let mut second = node(5, name);
        let sent = fire(&mut second, &Pose2::default(), &scan(&Pose2::default())).expect("what was written");
        assert_eq!(sent, Sent::default(), "nothing says where it is");
        assert_eq!(second.mapper.as_ref().expect("a mapper").mapped(), scans);
        std::fs::write(&file, "VERTEX_SE2 0 1 2\n").expect("a temporary file");
        let mut third = node(5, name);
        let mut fire = || fire(&mut third, &Pose2::default(), &scan(&Pose2::default()));
        let error = fire().expect_err("a number is missing").to_string();
        assert!(error.ends_with(".g2o:1: 3 numbers are expected (x y θ), there are 2"), "{error}");
        assert_eq!(fire().expect("an error is said once"), Sent::default());
        std::fs::remove_file(&file).expect("it is there");
        let mut nowhere = node(5, "/nowhere/map.g2o");
        drive(&mut nowhere, 2);
        let error = nowhere.save().expect_err("no folder").to_string();
        assert!(error.starts_with("cannot write `/nowhere/map.g2o`: "), "{error}");
    }
}
