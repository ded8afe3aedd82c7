//! Localization and mapping on recordings.
//!
//! The recordings are not part of the project. Without them the tests print a message and pass, unless they run with
//! `CI=true`.

mod arena;
mod graphs;
mod lost;
mod recordings;

use apex_nodes::{
    map::Occupancy,
    scan::{Point2, Pose2, Scan},
    slam::Settings,
};
use apex_rt::Time;
use recordings::{Recording, errors, fr079, intel, play};
use std::path::{Path, PathBuf};

mod programs {
    #![allow(missing_docs)]
    apex_macros::graph!("localize.afg");
}

/// A recording, or `None` (with a message) if it does not exist.
fn recording(name: &str) -> Option<PathBuf> {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/data/slam2d").join(name);
    if file.is_file() {
        return Some(file);
    }
    assert!(std::env::var("CI").as_deref() != Ok("true"), "{} is missing", file.display());
    eprintln!("skipped: {} is missing", file.display());
    None
}

/// Largest and median error of the poses that a mapper finds, in m.
fn error(recording: &Recording) -> (f64, f64) {
    let (mapper, estimate, slowest) = play(recording, Settings::default());
    let errors = errors(&estimate, &recording.reference);
    let (median, worst) = (errors[errors.len() / 2], errors[errors.len() - 1]);
    println!("error {median:.3} m, at most {worst:.3} m; {} loops, slowest {slowest:?}", mapper.loops());
    assert!(mapper.loops() > 10);
    (median, worst)
}

/// The first two rounds of the building, with odometry that is off by many metres.
#[test]
fn wheels_of_the_intel_lab_are_corrected() {
    let Some(file) = recording("intel_raw_odo_scans.csv.gz") else { return };
    let mut recording = intel(file.parent().expect("a folder"));
    recording.scans.truncate(1500);
    recording.reference.retain(|&scan, _| scan < 1500);
    let (median, worst) = error(&recording);
    assert!(recording.reference.len() > 100 && median < 0.25 && worst < 0.7);
}

/// The first part of the building, with additional noise on its odometry.
#[test]
fn noisy_odometry_of_freiburg_079_is_corrected() {
    let Some(file) = recording("fr079.log.gz") else { return };
    let mut recording = fr079(file.parent().expect("a folder"), 1.0);
    recording.scans.truncate(600);
    recording.reference.retain(|&scan, _| scan < 600);
    let (median, worst) = error(&recording);
    assert!(median < 0.15 && worst < 0.7);
}

/// A scan in a room of 8 m × 6 m around the origin, with another robot of 60 cm at (2, 1).
fn room(at: &Pose2) -> Scan {
    let mut scan = Scan { angle_min: -2.0, angle_increment: 0.01, ..Scan::default() };
    for beam in 0..400 {
        let direction = Point2::polar(1.0, at.theta + scan.angle(beam));
        let wall = |from: f32, d: f32, half: f32| if d == 0.0 { f32::MAX } else { (half.copysign(d) - from) / d };
        let walls = wall(at.x, direction.x, 4.0).min(wall(at.y, direction.y, 3.0));
        let robot = Point2::new(2.0, 1.0) - at.position();
        let (along, aside) = (robot.dot(direction), robot.dot(direction.perpendicular()));
        let seen = aside.abs() < 0.3 && along > 0.0;
        let range = if seen { walls.min(along - (0.09 - aside * aside).sqrt()) } else { walls };
        scan.ranges.push(range).expect("few beams");
    }
    scan
}

#[test]
fn other_robots_do_not_get_into_the_map() {
    let mut robot = programs::Localize::new();
    let (mut at, mut map) = (Pose2::new(-2.0, -2.0, 0.0), None);
    for _ in 0..30 {
        robot.inputs().odometry.put(at).expect("an empty mailbox");
        robot.inputs().scan.put(room(&at)).expect("an empty mailbox");
        robot.react(Time::ZERO);
        let pose = robot.outputs().pose.expect("a pose");
        assert!((pose.position() - at.position()).norm() < 0.1, "{pose:?} at {at:?}");
        map = robot.outputs().map.clone().or(map);
        at = at.compose(&Pose2::new(0.1, 0.0, 0.02));
    }
    let map = map.expect("a map");
    let around = |x: f32, y: f32, what: Occupancy| {
        let points =
            (-6..=6).flat_map(|i| (-6..=6).map(move |j| Point2::new(x + 0.05 * i as f32, y + 0.05 * j as f32)));
        points.filter(|p| map.at(*p) == Some(&what)).count()
    };
    assert_eq!(around(2.0, 1.0, Occupancy::Occupied), 0, "the robot");
    assert!(around(4.0, -1.0, Occupancy::Occupied) > 10, "the wall");
    assert_eq!(around(0.0, -1.0, Occupancy::Free), 13 * 13, "the floor");
}
