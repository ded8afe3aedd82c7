//! `far.afg`: nodes that compute with poses stop and fail where an `f32` has no centimetres, instead of driving
//! anywhere or being done at once. A node that is not in the file is reported.

use apex_dsl::catalog::{Catalog, PortSig};
use apex_host::{Disk, Seen, Workspace};
use apex_macros::graph;
use apex_nodes::{
    nav::{BackPath, BackPiece, Path, Twist},
    scan::{Point2, Pose2},
};
use apex_rt::prelude::*;
use std::{fs, path::Path as FilePath};

graph!("far.afg");

/// Twists of the nodes that drive, `None` for those that send none, and the number of nodes that failed.
type Answer = ([Option<Twist>; 9], usize, bool);

struct Robot {
    program: Drives,
    step: i64,
}

impl Robot {
    fn new() -> Self {
        let mut program = Drives::new();
        let path = Path { points: [0.0, 3.0].map(|x| Point2::new(x, 0.0)).into(), heading: 0.0 };
        assert!(program.inputs().path.put(path).is_ok());
        let back = BackPath { pieces: vec![BackPiece { bend: 0.0, length: 2.0 }] };
        assert!(program.inputs().back_path.put(back).is_ok());
        Self { program, step: 0 }
    }

    /// Lets the robot see itself at a place for one step.
    fn at(&mut self, pose: Pose2) -> Answer {
        let inputs = self.program.inputs();
        assert!(inputs.pose.put(pose).is_ok());
        assert!(inputs.trailer.put(pose.compose(&Pose2::new(-0.4, 0.0, 0.0))).is_ok());
        assert!(inputs.goal.put(Pose2::new(3.0, 0.0, 0.0)).is_ok());
        self.program.react(Time::from_millis(20 * self.step));
        self.step += 1;
        let out = self.program.outputs();
        let twists = [
            out.moved,
            out.backed,
            out.backed_path,
            out.reacted,
            out.planned,
            out.followed,
            out.curved,
            out.looked,
            out.skidded,
        ];
        let events = self.program.events();
        let failed = [
            events.move_failed.take(),
            events.back_failed.take(),
            events.back_path_failed.take(),
            events.reactive_failed.take(),
            events.planned_failed.take(),
            events.follow_failed.take(),
            events.curve_failed.take(),
            events.look_failed.take(),
            events.skid_failed.take(),
            events.track_failed.take(),
        ];
        (twists, failed.iter().flatten().count(), events.done.take().is_some())
    }
}

#[test]
fn far_from_the_origin_they_stop_and_fail() {
    for far in [Pose2::new(5e6, 0.0, 0.0), Pose2::new(0.0, -2e5, 0.0), Pose2::new(0.0, f32::MAX, 1.0)] {
        let mut robot = Robot::new();
        for _ in 0..10 {
            let (_, failed, done) = robot.at(Pose2::default());
            assert_eq!((failed, done), (0, false));
        }
        let (twists, failed, _) = robot.at(Pose2::default());
        assert!(failed == 0 && twists.iter().all(|twist| twist.is_some_and(|t| t != Twist::ZERO)), "{twists:?}");
        // What drives stops first; what only tracks fails at once.
        assert_eq!(robot.at(far), ([Some(Twist::ZERO); 9], 1, false));
        for _ in 0..3 {
            assert_eq!(robot.at(far), ([None; 9], 10, false));
        }
    }
}

#[test]
fn at_the_border_they_still_drive() {
    let mut robot = Robot::new();
    // In double precision: the robot sees itself with the precision of an `f32` there, steps of 8 mm.
    let mut x = 9e4_f64;
    for _ in 0..300 {
        let (twists, failed, done) = robot.at(Pose2::new(x as f32, 0.0, 0.0));
        assert_eq!(failed, 0);
        if done {
            break;
        }
        x += 0.02 * f64::from(twists[0].map_or(0.0, |twist| twist.x));
    }
    assert!((x - 9e4 - 1.0).abs() < 0.02, "{}", x - 9e4);
}

#[test]
fn every_node_that_drives_by_poses_is_tried() {
    let folder = FilePath::new(env!("CARGO_MANIFEST_DIR"));
    let workspace = Workspace::load(folder).expect("cargo knows the package");
    let catalog = Catalog::load(workspace.crates(&Seen::Crate("far", false)), &mut Disk::new(None));
    let text = fs::read_to_string(folder.join("tests/far.afg")).expect("the file is there");
    let nav =
        catalog.signatures.iter().filter(|s| s.path.get(1..3).is_some_and(|p| p[0] == "apex_nodes" && p[1] == "nav"));
    let has = |ports: &[PortSig], name: &str, is_input: bool| {
        ports.iter().any(|port| (port.kind.word() == "input") == is_input && port.ty.name() == name)
    };
    // Without the nodes that change a twist: they pass zero on.
    let drives = nav.filter(|s| has(&s.ports, "Pose2", true) && has(&s.ports, "Twist", false));
    let names: Vec<&str> = drives.filter(|s| !has(&s.ports, "Twist", true)).map(|s| s.name.as_str()).collect();
    assert!(names.len() >= 6, "{names:?}");
    for name in names.into_iter().filter(|name| *name != "PositionToTarget") {
        assert!(text.contains(&format!("= {name}(")), "`{name}` is not in `tests/far.afg`");
    }
}
