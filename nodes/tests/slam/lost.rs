//! Robots that are carried away, and maps that are saved.

use crate::{
    recording,
    recordings::{Recording, fr079, intel, play},
};
use apex_nodes::{
    scan::{Point2, Pose2, PoseChange, Scan},
    slam::{Mapper, Pose, Settings, heading, pose},
};
use apex_sim::{Laser, Odometry, OdometryNoise, Random, World};
use std::{f32::consts::PI, path::PathBuf};

/// Two rooms in the shape of an L, with two pillars.
fn rooms() -> World {
    let mut world = World::default();
    let walls = [(0.0, 0.0), (14.0, 0.0), (14.0, 5.0), (6.0, 5.0), (6.0, 12.0), (0.0, 12.0)];
    world.polygon(&walls.map(|(x, y)| Point2::new(x, y)));
    for (x, y, side) in [(9.0, 3.5, 0.5), (4.5, 8.0, 0.8)] {
        let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)];
        world.polygon(&corners.map(|(u, v)| Point2::new(x + side * u, y + side * v)));
    }
    world
}

/// Room of 8 m × 6 m, which looks the same after half a turn.
fn bare_room() -> World {
    let mut world = World::default();
    world.polygon(&[(0.0, 0.0), (8.0, 0.0), (8.0, 6.0), (0.0, 6.0)].map(|(x, y)| Point2::new(x, y)));
    world
}

/// A robot and its mapper.
struct Robot {
    world: World,
    mapper: Mapper,
    at: Pose2,
    wheels: Odometry,
    /// Pose at which odometry begins, and the pose by odometry.
    origin: Pose2,
    odometry: Pose2,
    random: Random,
    /// Changes of the mapper, and the distance of the estimated from the true pose then, in m.
    changes: Vec<(PoseChange, f32)>,
}

impl Robot {
    fn new(world: World, mapper: Mapper, at: Pose2) -> Self {
        let wheels = Odometry::new(OdometryNoise::PIONEER, 5);
        Self { world, mapper, at, wheels, origin: at, odometry: at, random: Random::new(6), changes: Vec::new() }
    }

    /// Distance of the estimated from the true pose, in m.
    fn error(&self) -> f32 {
        let at = self.mapper.locate(&double(&self.odometry));
        (Point2::new(at.translation.x as f32, at.translation.y as f32) - self.at.position()).norm()
    }

    fn look(&mut self) {
        let mut scan = Scan::default();
        Laser::LMS100.measure(&self.world, &self.at, &mut self.random, &mut scan);
        let odometry = double(&self.odometry);
        let change = if self.mapper.is_due(&odometry) {
            self.mapper.add(&odometry, scan.points().map(|(_, point)| point).collect())
        } else {
            self.mapper.search()
        };
        self.changes.extend(change.map(|change| (change, self.error())));
    }

    /// Turns to a place and drives there.
    fn drive(&mut self, x: f32, y: f32) {
        loop {
            let goal = self.at.to_inner(Point2::new(x, y));
            let turn = goal.angle().clamp(-0.1, 0.1);
            let way = if goal.angle().abs() > 0.1 { 0.0 } else { goal.norm().min(0.1) };
            if goal.norm() < 0.05 {
                break;
            }
            let next = self.at.compose(&Pose2::new(way, 0.0, turn));
            self.odometry = self.origin.compose(&self.wheels.measure(&self.at, &next));
            self.at = next;
            self.look();
        }
    }

    /// Waits for the end of a search.
    fn wait(&mut self) {
        (0..100).for_each(|_| self.look());
    }
}

fn double(at: &Pose2) -> Pose {
    pose(at.x.into(), at.y.into(), at.theta.into())
}

fn explored() -> Robot {
    let mut robot = Robot::new(rooms(), Mapper::new(Settings::default()), Pose2::new(2.0, 2.0, 0.0));
    for (x, y) in [(12.0, 2.0), (3.0, 2.5), (2.0, 10.0), (2.5, 3.0)] {
        robot.drive(x, y);
    }
    assert!(robot.changes.is_empty() && robot.error() < 0.1, "{:?}, {} m", robot.changes, robot.error());
    robot
}

#[test]
fn a_robot_that_is_carried_away_is_lost_and_found() {
    let mut robot = explored();
    let mapped = robot.mapper.mapped();
    robot.at = Pose2::new(11.0, 2.0, PI);
    while robot.changes.is_empty() {
        robot.drive(robot.at.x - 0.2, robot.at.y);
        assert!(robot.at.x > 8.0, "the robot does not notice it");
    }
    assert_eq!(robot.changes[0].0, PoseChange::Lost);
    let odometry = double(&robot.odometry);
    assert!(robot.mapper.is_lost() && robot.mapper.estimate(&odometry).is_none());
    assert_eq!(robot.mapper.mapped(), mapped, "what it sees is not in the map");
    robot.drive(4.0, 2.0);
    robot.wait();
    assert!(matches!(robot.changes[1..], [(PoseChange::Localized, error)] if error < 0.15), "{:?}", robot.changes);
    assert!(robot.mapper.mapped() > mapped && robot.mapper.estimate(&odometry).is_some());
    robot.drive(2.0, 9.0);
    assert!(robot.changes.len() == 2 && robot.error() < 0.15, "{:?}, {} m", robot.changes, robot.error());
}

#[test]
fn a_person_before_the_scanner_does_not_make_it_lost() {
    let mut robot = explored();
    let at = robot.at.compose(&Pose2::new(0.7, 0.0, 0.0)).position();
    robot.world.disc(at, 0.45);
    robot.world.disc(at + Point2::new(0.0, 0.9), 0.45);
    robot.wait();
    robot.drive(2.5, 2.6);
    robot.world = rooms();
    robot.drive(10.0, 2.0);
    assert!(robot.changes.is_empty() && robot.error() < 0.15, "{:?}, {} m", robot.changes, robot.error());
}

fn file(name: &str) -> PathBuf {
    std::env::temp_dir().join(format!("apex-slam-{}-{name}.g2o", std::process::id()))
}

/// Writes a map, and begins with it.
fn read_again(mapper: &Mapper, name: &str) -> Mapper {
    let file = file(name);
    mapper.write(&file).expect("a temporary file");
    let read = Mapper::read(&file, Settings::default()).expect("what was written");
    std::fs::remove_file(&file).expect("it is there");
    read
}

#[test]
fn a_robot_finds_itself_again_on_a_saved_map() {
    let robot = explored();
    let mapper = read_again(&robot.mapper, "saved");
    assert_eq!(mapper.scans(), robot.mapper.scans());
    assert_eq!(mapper.graph().edges().len(), robot.mapper.graph().edges().len());
    let mapped = mapper.mapped();
    assert!(mapped == robot.mapper.mapped() && mapper.is_lost() && mapper.loops() == robot.mapper.loops());
    // It begins elsewhere, and its odometry in another frame.
    for start in [Pose2::new(10.0, 1.5, 2.0), Pose2::new(1.5, 9.0, -1.0)] {
        let mut robot = Robot::new(rooms(), mapper.clone(), start);
        robot.origin = Pose2::new(-50.0, 20.0, 1.0);
        robot.odometry = robot.origin;
        robot.wait();
        assert!(matches!(robot.changes[..], [(PoseChange::Localized, error)] if error < 0.2), "{:?}", robot.changes);
        robot.drive(3.0, 3.0);
        assert!(robot.mapper.mapped() > mapped && robot.error() < 0.2, "{} m", robot.error());
    }
}

#[test]
fn a_place_that_looks_like_another_one_is_not_taken_for_it() {
    let mut robot = Robot::new(bare_room(), Mapper::new(Settings::default()), Pose2::new(2.0, 2.0, 0.0));
    robot.drive(6.0, 4.0);
    robot.drive(2.0, 3.0);
    let mapper = read_again(&robot.mapper, "bare");
    let mut robot = Robot::new(bare_room(), mapper, Pose2::new(6.0, 2.0, 1.0));
    robot.drive(2.0, 4.0);
    robot.wait();
    assert_eq!(robot.changes, [], "half a turn makes no difference");
}

#[test]
fn maps_with_mistakes_are_refused() {
    for (name, text, message) in [
        ("empty", "", "a map has at least one vertex and its scan"),
        ("half", "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 7 1 0 0\nSCAN 0 1 2\n", "the scan of vertex 1 is missing: a map has"),
        ("twice", "VERTEX_SE2 0 0 0 0\nSCAN 0 1 2\nSCAN 0 1 2\n", "vertex 0 has a scan already"),
    ] {
        let file = file(name);
        std::fs::write(&file, text).expect("a temporary file");
        let error = Mapper::read(&file, Settings::default()).expect_err(name);
        std::fs::remove_file(&file).expect("it is there");
        assert!(error.message.starts_with(message), "{error}");
    }
}

/// Numbers of robots that are carried to another place of a recording and notice it, and that find themselves then.
#[derive(Debug, Default, PartialEq)]
struct Carried {
    unnoticed: usize,
    right: usize,
    wrong: usize,
    not_found: usize,
}

/// Carries a robot to a scan of a recording. Returns whether it notices it, and how far from its true pose it finds
/// itself. A scanner is ten times faster than the recording.
fn carry(mapper: &mut Mapper, last: &Pose, scans: &[(Pose, Vec<Point2>)], truth: &[Pose]) -> (bool, Option<Pose>) {
    let mut is_lost = false;
    for (i, (odometry, points)) in scans.iter().enumerate() {
        let odometry = last * scans[0].0.inv_mul(odometry);
        for _ in 0..10 {
            let due = mapper.is_due(&odometry);
            match if due { mapper.add(&odometry, points.clone()) } else { mapper.search() } {
                Some(PoseChange::Lost) => is_lost = true,
                Some(PoseChange::Localized) => return (is_lost, Some(truth[i].inv_mul(&mapper.locate(&odometry)))),
                None => {}
            }
        }
        if !is_lost && i > 30 {
            break;
        }
    }
    (is_lost, None)
}

/// Carries the robot of a recording to an earlier place, after so many different parts of the recording.
fn carried(recording: &Recording, cases: usize) -> Carried {
    let (_, truth, _) = play(recording, Settings::default());
    let (mut mapper, mut counted) = (Mapper::new(Settings::default()), Carried::default());
    for (i, (odometry, points)) in recording.scans.iter().enumerate() {
        if mapper.is_due(odometry) {
            mapper.add(odometry, points.clone());
        }
        let (part, is_first) =
            (i * 2 * cases / recording.scans.len(), i * 2 * cases % recording.scans.len() < 2 * cases);
        if part < cases || !is_first {
            continue;
        }
        let first = 50 + part * 397 % (i - 300);
        let there = first..first + 250;
        let (is_lost, found) = carry(&mut mapper.clone(), odometry, &recording.scans[there.clone()], &truth[there]);
        match found {
            Some(off) if off.translation.vector.norm() < 0.5 && heading(&off).abs() < 0.2 => counted.right += 1,
            Some(_) => counted.wrong += 1,
            None if is_lost => counted.not_found += 1,
            None => counted.unnoticed += 1,
        }
    }
    counted
}

#[test]
fn robots_that_are_carried_through_buildings_find_themselves_again() {
    let Some(file) = recording("fr079.log.gz") else { return };
    let folder = file.parent().expect("a folder");
    let cases: Option<usize> = std::env::var("APEX_CARRIED").ok().and_then(|cases| cases.parse().ok());
    let mut recordings = vec![("fr079", fr079(folder, 1.0))];
    match cases {
        Some(_) => recordings.push(("intel", intel(folder))),
        None => recordings[0].1.scans.truncate(700),
    }
    for (name, recording) in recordings {
        let counted = carried(&recording, cases.unwrap_or(4));
        println!("{name}: {counted:?}");
        assert!(counted.wrong == 0 && counted.not_found == 0 && counted.right > 0, "{name}: {counted:?}");
    }
}

/// Mean of the squared errors of the poses, normalised by their covariance (NEES): 3 if the covariance is right.
fn normalized_error(recording: &Recording) -> f64 {
    let (mut mapper, mut errors) = (Mapper::new(Settings::default()), Vec::new());
    let start = recording.scans[0].0 * recording.reference[&0].inverse();
    for (i, (odometry, points)) in recording.scans.iter().enumerate() {
        if mapper.is_due(odometry) {
            mapper.add(odometry, points.clone());
        }
        let Some(truth) = recording.reference.get(&i).map(|truth| start * truth) else { continue };
        let [x, y, theta] = [truth.translation.x, truth.translation.y, heading(&truth)].map(|part| part as f32);
        let estimate = mapper.estimate(odometry).expect("it is not lost");
        errors.extend(estimate.normalized_error(&Pose2::new(x, y, theta)));
    }
    errors.iter().sum::<f64>() / errors.len() as f64
}

#[test]
fn a_pose_is_as_sure_as_it_says() {
    let Some(file) = recording("fr079.log.gz") else { return };
    let mut recording = fr079(file.parent().expect("a folder"), 1.0);
    if std::env::var("APEX_CARRIED").is_err() {
        recording.scans.truncate(600);
    }
    let error = normalized_error(&recording);
    println!("squared error / covariance {error:.2} in the mean, 3 if the covariance is right");
    assert!((0.3..3.0).contains(&error), "{error}");
}
