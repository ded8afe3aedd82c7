use apex_macros::graph;
use apex_nodes::{
    math::Random,
    nav::{Path, Twist},
    scan::{Point2, Pose2},
};
use apex_rt::prelude::*;
use core::f32::consts::PI;

graph! {
    use apex_nodes::nav::{Path, PathFollower, Steer, Twist};
    use apex_nodes::scan::Pose2;

    /// Follows a path with an omnidirectional base.
    graph Follow {
        in    pose: Pose2;
        slot  path: Path;
        out   twist: Twist;
        event reached;
        event gave_up;

        node way    = apex_nodes::flow::Latest();
        node follow = PathFollower(heading_tolerance = 0.2rad);
        start  => follow.enable;
        path   -> way.set;
        way    -> follow.path;
        pose   -> follow.pose;
        follow -> twist;
        follow.reached -> reached;
        [follow.blocked, follow.off_path] -> gave_up;
    }

    /// The same with a faster robot, which brakes late.
    graph FollowFast {
        in    pose: Pose2;
        slot  path: Path;
        out   twist: Twist;
        event reached;
        event gave_up;

        node way    = apex_nodes::flow::Latest();
        node follow = PathFollower(
            speed = 1.5m/s, acceleration = 1.8m/s^2, min_speed = 10cm/s, max_rotation = 2.4rad/s,
            rotation_acceleration = 5rad/s^2, turning_gain = 0.25 / 1rad, rotation_gain = 0.1s/rad,
            goal_gain = 10cm, tolerance = 10cm, heading_tolerance = 0.2rad,
        );
        start  => follow.enable;
        path   -> way.set;
        way    -> follow.path;
        pose   -> follow.pose;
        follow -> twist;
        follow.reached -> reached;
        [follow.blocked, follow.off_path] -> gave_up;
    }

    /// The same with a base that drives in curves.
    graph FollowInCurves {
        in    pose: Pose2;
        slot  path: Path;
        out   twist: Twist;
        event reached;
        event gave_up;

        node way    = apex_nodes::flow::Latest();
        node follow = PathFollower(
            heading_tolerance = 180deg, turn_within = 0m, min_speed = 8cm/s, turning_gain = 0.08 / 1rad,
            rotation_gain = 0.6s / 1rad, tolerance = 15cm,
        );
        node steer  = Steer(radius = 0.5m);
        start  => follow.enable;
        path   -> way.set;
        way    -> follow.path;
        pose   -> follow.pose;
        follow -> steer -> twist;
        follow.reached -> reached;
        [follow.blocked, follow.off_path] -> gave_up;
    }
}

/// Time between two poses, in s.
const STEP: f32 = 0.02;
/// Longest drive, in steps.
const MOST_STEPS: usize = 500_000;

/// Robot that follows a path.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Robot {
    /// Omnidirectional robot with the defaults of the node.
    Usual,
    /// Faster one, which brakes late.
    Fast,
    /// Base that drives in curves, through `Steer`.
    Steered,
}

/// Angle of a sharp corner, in rad.
const SHARP: f32 = 1.75;

/// Outcome of a drive.
#[derive(Debug, Clone, Copy)]
pub struct Outcome {
    pub is_reached: bool,
    /// Greatest distance from a point that was to be passed, in tolerances of the point.
    pub miss: f32,
    /// Duration, in s.
    pub seconds: f32,
}

impl Outcome {
    /// Returns `true` if the robot came to the goal and passed all points in their order.
    pub fn is_good(&self) -> bool {
        self.is_reached && self.miss <= 1.0
    }
}

/// One drive of a program: its answer to a pose.
type Answer = (Option<Twist>, Option<End>);

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum End {
    Reached,
    GaveUp,
}

/// Drives a path from near its start on.
pub fn drive(path: &Path, robot: Robot, random: &mut Random) -> Outcome {
    // A base that drives in curves begins along the path.
    let is_steered = robot == Robot::Steered;
    let heading = if is_steered { (path.points[1] - path.points[0]).angle() } else { random.uniform(-PI, PI) };
    macro_rules! drive {
        ($graph:ident, $tolerances:expr) => {{
            let mut program = $graph::new();
            assert!(program.inputs().path.put(path.clone()).is_ok());
            run(Passed::new(path, $tolerances), heading, random, |pose, now| {
                assert!(program.inputs().pose.put(*pose).is_ok());
                program.react(now);
                let events = program.events();
                let reached = events.reached.take().map(|()| End::Reached);
                let gave_up = events.gave_up.take().map(|()| End::GaveUp);
                (program.outputs().twist, reached.or(gave_up))
            })
        }};
    }
    match robot {
        Robot::Usual => drive!(Follow, Tolerances { sharp: 0.05, rounded: 0.2 }),
        Robot::Fast => drive!(FollowFast, Tolerances { sharp: 0.1, rounded: 0.5 }),
        Robot::Steered => drive!(FollowInCurves, Tolerances { sharp: 0.15, rounded: 0.25 }),
    }
}

/// Drives from the first point of a path on, until the robot ends the drive.
fn run(
    mut passed: Passed,
    heading: f32,
    random: &mut Random,
    mut answer: impl FnMut(&Pose2, Time) -> Answer,
) -> Outcome {
    let start = passed.points[0].0 + Point2::new(random.normal(0.02), random.normal(0.02));
    let mut pose = Pose2::new(start.x, start.y, heading);
    for step in 0..MOST_STEPS {
        passed.see(pose.position());
        let (twist, end) = answer(&pose, Time::from_millis(20 * step as i64));
        if let Some(end) = end {
            let seconds = step as f32 * STEP;
            return Outcome { is_reached: end == End::Reached, miss: passed.miss(), seconds };
        }
        let twist = twist.unwrap_or(Twist::ZERO);
        pose = pose.compose(&Pose2::new(STEP * twist.x, STEP * twist.y, STEP * twist.omega));
    }
    Outcome { is_reached: false, miss: passed.miss(), seconds: MOST_STEPS as f32 * STEP }
}

/// Distances within which a robot has to come to points, in m.
#[derive(Debug, Clone, Copy)]
struct Tolerances {
    /// To sharp corners, and to the goal.
    sharp: f32,
    /// To other points, which it may round.
    rounded: f32,
}

/// Points of a path that were passed in their order.
struct Passed {
    /// Points with their tolerances, and the least possible greatest distance from the points up to this one, in
    /// tolerances.
    points: Vec<(Point2, f32, f32)>,
}

impl Passed {
    fn new(path: &Path, tolerances: Tolerances) -> Self {
        let last = path.points.len() - 1;
        let is_sharp = |i: usize| i == last || path.turn(i).abs() > SHARP;
        let tolerance = |i| if is_sharp(i) { tolerances.sharp } else { tolerances.rounded };
        // The follower decides with a rounding error, and the pose of a step is the nearest one to a millimetre.
        let point = |(i, point): (usize, &Point2)| (*point, 1.02 * tolerance(i), f32::INFINITY);
        Self { points: path.points.iter().enumerate().map(point).collect() }
    }

    /// Takes a position of the robot into account.
    fn see(&mut self, position: Point2) {
        // From the last point on: a position may count for several points, in their order.
        let mut before = 0.0;
        for (point, tolerance, least) in &mut self.points {
            let worst = f32::max(before, (position - *point).norm() / *tolerance);
            *least = least.min(worst);
            before = *least;
        }
    }

    /// Greatest distance from a point, in tolerances.
    fn miss(&self) -> f32 {
        self.points.last().map_or(0.0, |(.., least)| *least)
    }
}
