use super::{
    FollowingLaw, Path, Projection, Twist,
    latest::{any_far, fresh},
    path::nearest_on,
    progress::{End, Progress, RESUMES},
    twist::Halt,
};
use crate::{
    math::PidLaw,
    scan::{BeamDirections, FarFromOrigin, Point2, Pose2, Scan, wrap_angle},
};
use apex_rt::{Ctx, Event, Time, node};
use core::f32::consts::PI;

/// Weight of a heading error in the distance left to go, in m/rad.
const TURN: f32 = 0.1;

/// Follows a path with an omnidirectional robot until it is at the goal (thesis 4.3.6, eqs. 4.2 to 4.5).
///
/// The robot passes the points of the path in their order. It rounds corners, and turns back at a sharp one, of more
/// than 100°, once it is within `tolerance` of it. So a path may cross itself and lead back the way it came.
///
/// A new path replaces the current one. `pose` is in the frame of the path; while there is none that is younger than
/// `max_age`, the robot stands still. `scan` is in the frame of the robot; before the first one, no obstacle is known.
/// That the robot stops before obstacles, and without scans, is the task of a [`SafetyField`](super::SafetyField). The
/// node sends twists while it has a path,
/// and drops the path when the robot
/// * has `reached` the goal,
/// * is `blocked`: for longer than `blocked_timeout`, an obstacle is on the path ahead or the robot makes no progress,
///   or the path is not finite,
/// * is `off_path`: farther than `max_offset` from the path,
/// * is deactivated.
///
/// Stops and fails while the pose is more than 100 km from the origin. Obstacles around the goal do not count as
/// standing on the path, as a goal may be close to a wall.
#[node]
#[derive(Debug, Clone)]
pub struct PathFollower {
    /// Decay rate of the offset from the path, per metre of path (k).
    #[param(unit = "1/m", default = 2.0, range = 0.0..=100.0)]
    convergence: f32,
    /// Nominal speed on a straight path far from obstacles and the goal (v_n).
    #[param(unit = "m/s", default = 1.0, range = 0.0..=10.0)]
    speed: f32,
    /// Minimum speed on the path.
    #[param(unit = "m/s", default = 0.05, range = 0.001..=1.0)]
    min_speed: f32,
    /// Gain of the slowdown by curves ahead (K_κ).
    #[param(unit = "1/rad", default = 0.5, range = 0.0..=100.0)]
    turning_gain: f32,
    /// Gain of the slowdown by the robot's own rotation (K_ω).
    #[param(unit = "s/rad", default = 0.2, range = 0.0..=100.0)]
    rotation_gain: f32,
    /// Gain of the slowdown by near obstacles (K_o).
    #[param(unit = "m", default = 0.1, range = 0.0..=100.0)]
    obstacle_gain: f32,
    /// Gain of the slowdown near the goal (K_g).
    #[param(unit = "m", default = 0.2, range = 0.0..=100.0)]
    goal_gain: f32,
    /// Length of the path ahead that is examined for curves and for obstacles.
    #[param(unit = "m", default = 1.5, range = 0.0..=100.0)]
    look_ahead: f32,
    /// Maximum acceleration.
    #[param(unit = "m/s^2", default = 1.0, range = 0.01..=100.0)]
    acceleration: f32,
    /// Maximum angular acceleration.
    #[param(unit = "rad/s^2", default = 3.0, range = 0.01..=100.0)]
    rotation_acceleration: f32,
    /// Maximum angular velocity.
    #[param(unit = "rad/s", default = 1.5, range = 0.0..=20.0)]
    max_rotation: f32,
    /// Proportional gain of the heading controller: angular velocity per heading error.
    #[param(unit = "1/s", default = 2.0, range = 0.0..=100.0)]
    proportional: f32,
    /// Integral gain of the heading controller.
    #[param(unit = "1/s^2", default = 0.0, range = 0.0..=100.0)]
    integral: f32,
    /// Derivative gain of the heading controller.
    #[param(default = 0.0, range = 0.0..=100.0)]
    derivative: f32,
    /// Remaining length of the path at which the robot starts to turn to the goal heading. Before, it faces along the
    /// path.
    #[param(unit = "m", default = 1.0, range = 0.0..=1000.0)]
    turn_within: f32,
    /// Tolerance of the position at the goal, and at corners of more than 100°.
    #[param(unit = "m", default = 0.05, range = 0.001..=1.0)]
    tolerance: f32,
    /// Tolerance of the heading at the goal.
    #[param(unit = "rad", default = 0.05, range = 0.001..=3.2)]
    heading_tolerance: f32,
    /// Maximum offset from the path. Beyond it the robot gives up with `off_path`.
    #[param(unit = "m", default = 1.0, range = 0.01..=100.0)]
    max_offset: f32,
    /// Required free distance on both sides of the path. A nearer scan point is an obstacle on the path.
    #[param(unit = "m", default = 0.3, range = 0.0..=10.0)]
    clearance: f32,
    /// Time that an obstacle may stand on the path, and time that the robot may go without progress.
    #[param(unit = "s", default = 2.0, range = 0.0..=600.0)]
    blocked_timeout: f32,
    /// Maximum age of a pose and of a scan.
    #[param(unit = "s", default = 0.5, range = 0.01..=60.0, silence)]
    max_age: f32,
    path: Path,
    progress: Progress,
    /// Distance to the nearest obstacle, in m.
    obstacle: Option<f32>,
    motion: Motion,
    halt: Halt,
    directions: BeamDirections,
}

/// Present motion of a robot.
#[derive(Debug, Clone, Default)]
struct Motion {
    at: Option<Time>,
    /// Velocity in the frame of the path, in m/s.
    velocity: Point2,
    /// Angular velocity, in rad/s.
    rotation: f32,
    heading: PidLaw<f32>,
}

#[node]
impl PathFollower {
    #[allow(clippy::too_many_arguments, reason = "they are the ports")]
    fn process(
        &mut self,
        ctx: &Ctx,
        pose: Option<&Pose2>,
        path: Option<&Path>,
        scan: Option<&Scan>,
        reached: Event<()>,
        #[failure] blocked: Event<()>,
        #[failure] off_path: Event<()>,
    ) -> Result<Option<Twist>, FarFromOrigin> {
        if let Some(path) = path {
            self.begin(path, ctx.now());
        }
        if !self.path.points.is_empty() && any_far([pose]) {
            return self.halt.far();
        }
        Ok(self.step(ctx, pose, scan, [reached, blocked, off_path]))
    }

    fn step(&mut self, ctx: &Ctx, pose: Option<&Pose2>, scan: Option<&Scan>, ends: [Event<()>; 3]) -> Option<Twist> {
        let Some(goal) = self.path.goal() else { return self.halt.rest() };
        let Some(pose) = fresh(ctx, pose, self.max_age) else {
            self.wait();
            return self.halt.drive(Twist::ZERO);
        };
        let projection = self.path.project(pose.position(), self.progress.segment, self.tolerance);
        let Some(projection) = projection else {
            // The path is not finite.
            return self.give_up_with(End::Blocked, ends);
        };
        self.progress.segment = projection.segment;
        if let Some(scan) = fresh(ctx, scan, self.max_age) {
            self.look(scan, pose, &projection, ctx.now());
        }
        match self.end(pose, goal, &projection, ctx.now()) {
            None => {
                let twist = self.drive(pose, &projection, ctx.now());
                self.halt.drive(twist)
            }
            Some(end) => self.give_up_with(end, ends),
        }
    }

    fn give_up_with(&mut self, end: End, ends: [Event<()>; 3]) -> Option<Twist> {
        end.tell(ends);
        self.give_up();
        self.halt.drive(Twist::ZERO)
    }

    /// Stops until there is a better pose.
    fn wait(&mut self) {
        self.motion = Motion::default();
        self.progress.pause();
    }

    /// Drops the path.
    #[on_deactivate]
    fn give_up(&mut self) {
        self.path.points.clear();
    }

    /// Begins a path. A robot that was driving just before goes on at its speed.
    fn begin(&mut self, path: &Path, now: Time) {
        if self.motion.at.is_none_or(|last| now.since(last).as_secs_f32() > RESUMES) {
            self.motion = Motion::default();
        }
        self.path.take(path);
        (self.progress, self.obstacle) = (Progress::default(), None);
        self.motion.heading.reset();
    }

    /// Returns `true` on the last piece of the path before a sharp corner or the goal, where the robot drives straight
    /// to it.
    fn is_arriving(&self, projection: &Projection) -> bool {
        projection.to_stop <= 2.0 * self.tolerance
    }

    fn look(&mut self, scan: &Scan, pose: &Pose2, projection: &Projection, now: Time) {
        let sight = self.look_ahead + self.clearance;
        let frame = pose.transform();
        let mut directions = core::mem::take(&mut self.directions);
        self.obstacle = directions.points(scan).map(|(_, point)| point.norm()).reduce(f32::min);
        let mut near = directions.points(scan).filter(|(_, point)| point.norm_squared() <= sight * sight);
        let is_obstructed = near.any(|(_, point)| self.stands_on_path(frame.to_outer(point), projection));
        drop(near);
        self.directions = directions;
        self.progress.obstruct(is_obstructed, now);
    }

    /// Returns `true` if a point is nearer to the path ahead than the clearance, except on the last piece before the
    /// goal.
    fn stands_on_path(&self, point: Point2, projection: &Projection) -> bool {
        let until = self.look_ahead.min(projection.remaining - 2.0 * self.clearance);
        let mut passed = 0.0;
        let mut last = projection.point;
        for next in &self.path.points[projection.segment + 1..] {
            if passed > until {
                return false;
            }
            let nearest = nearest_on(last, *next, point);
            let is_near = (point - nearest).norm_squared() <= self.clearance * self.clearance;
            if is_near && passed + (nearest - last).norm() <= until {
                return true;
            }
            passed += (*next - last).norm();
            last = *next;
        }
        false
    }

    fn end(&mut self, pose: &Pose2, goal: Point2, projection: &Projection, now: Time) -> Option<End> {
        let to_goal = (goal - pose.position()).norm();
        let turn = wrap_angle(self.path.heading - pose.theta).abs();
        let is_last = self.is_arriving(projection) && projection.stop + 1 == self.path.points.len();
        if is_last && to_goal <= self.tolerance && turn <= self.heading_tolerance {
            return Some(End::Reached);
        }
        if projection.distance > self.max_offset {
            return Some(End::OffPath);
        }
        let left = self.left(pose, projection) + TURN * if is_last { turn } else { PI };
        self.progress.advance(left, now);
        let is_blocked = self.progress.is_blocked(self.blocked_timeout, self.blocked_timeout, now);
        is_blocked.then_some(End::Blocked)
    }

    /// Length of the way to the goal, in m.
    fn left(&self, pose: &Pose2, projection: &Projection) -> f32 {
        if self.is_arriving(projection) {
            let to_stop = (self.path.points[projection.stop] - pose.position()).norm();
            return to_stop + projection.remaining - projection.to_stop;
        }
        projection.distance + projection.remaining
    }

    fn drive(&mut self, pose: &Pose2, projection: &Projection, now: Time) -> Twist {
        let dt = self.motion.at.replace(now).map_or(0.0, |last| now.since(last).as_secs_f32());
        let heading = if projection.remaining <= self.turn_within { self.path.heading } else { projection.tangent };
        let rotation = self.rotation(wrap_angle(heading - pose.theta), dt);
        let most = self.rotation_acceleration * dt;
        self.motion.rotation += (rotation - self.motion.rotation).clamp(-most, most);
        let change = self.velocity(pose, projection) - self.motion.velocity;
        let share = (self.acceleration * dt / change.norm().max(f32::MIN_POSITIVE)).min(1.0);
        self.motion.velocity = self.motion.velocity + change.scaled(share);
        let velocity = Pose2::new(0.0, 0.0, pose.theta).to_inner(self.motion.velocity);
        Twist::of(velocity, self.motion.rotation)
    }

    /// Angular velocity that corrects an error of the heading, in rad/s.
    fn rotation(&mut self, error: f32, dt: f32) -> f32 {
        let pid = &mut self.motion.heading;
        (pid.proportional, pid.integral, pid.derivative) = (self.proportional, self.integral, self.derivative);
        pid.limit = self.max_rotation;
        pid.step(error, dt)
    }

    /// Desired velocity in the frame of the path, in m/s. A sharp corner is approached like the goal.
    fn velocity(&self, pose: &Pose2, projection: &Projection) -> Point2 {
        let turning = self.path.turning(projection, self.look_ahead);
        let obstacle = self.obstacle.unwrap_or(f32::INFINITY);
        let law = self.law();
        if !self.is_arriving(projection) {
            let speed = law.speed(turning, self.motion.rotation, obstacle, projection.to_stop);
            return Point2::polar(speed, law.direction(projection));
        }
        let way = self.path.points[projection.stop] - pose.position();
        let distance = way.norm();
        // At the goal already: only the turn is left.
        if distance <= 0.5 * self.tolerance {
            return Point2::default();
        }
        way.scaled(law.speed(turning, self.motion.rotation, obstacle, distance) / distance)
    }

    fn law(&self) -> FollowingLaw {
        FollowingLaw {
            convergence: self.convergence,
            speed: self.speed,
            min_speed: self.min_speed,
            turning_gain: self.turning_gain,
            rotation_gain: self.rotation_gain,
            obstacle_gain: self.obstacle_gain,
            goal_gain: self.goal_gain,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        map::{DistanceTransform, Grid, Occupancy, Raster, grow},
        nav::{Planner, Smoothing, Terrain},
    };
    use apex_rt::Construct;
    use apex_sim::Random;
    use core::f32::consts::FRAC_PI_2;
    use std::{fs, path::PathBuf};

    fn follower() -> PathFollower {
        let gains = (0.5, 0.2, 0.1, 0.2);
        let limits = (1.0, 3.0, 1.5);
        PathFollower::construct((
            2.0, 1.0, 0.05, gains.0, gains.1, gains.2, gains.3, 1.5, limits.0, limits.1, limits.2, 2.0, 0.0, 0.0, 1.0,
            0.05, 0.05, 1.0, 0.3, 2.0, 0.5,
        ))
    }

    fn path(points: &[(f32, f32)], heading: f32) -> Path {
        Path { points: points.iter().map(|&(x, y)| Point2::new(x, y)).collect(), heading }
    }

    /// A robot that carries out each twist at once, 50 times per second.
    struct Robot {
        node: PathFollower,
        pose: Pose2,
        step: i64,
    }

    impl Robot {
        fn new(node: PathFollower, pose: Pose2) -> Self {
            Self { node, pose, step: 0 }
        }

        fn react(&mut self, path: Option<&Path>, scan: Option<&Scan>) -> (Option<Twist>, Option<End>) {
            let (mut reached, mut blocked, mut off_path) = (None, None, None);
            let ctx = Ctx::new(Time::from_millis(20 * self.step));
            self.step += 1;
            let scan = scan.map(|scan| Scan { stamp: ctx.now(), ..scan.clone() });
            let (a, b, c) = (apex_rt::event(&mut reached), apex_rt::event(&mut blocked), apex_rt::event(&mut off_path));
            let twist = self.node.process(&ctx, Some(&self.pose), path, scan.as_ref(), a, b, c).unwrap_or(None);
            let ends = [(reached, End::Reached), (blocked, End::Blocked), (off_path, End::OffPath)];
            let end = ends.into_iter().find_map(|(event, end)| event.map(|()| end));
            (twist, end)
        }

        fn drive(&mut self, twist: Twist) {
            let moved = twist.velocity().scaled(0.02);
            self.pose = self.pose.compose(&Pose2::new(moved.x, moved.y, 0.02 * twist.omega));
        }

        /// Follows a path to its end; calls `watch` after each step.
        fn follow(&mut self, path: &Path, mut watch: impl FnMut(&Pose2, Twist)) -> End {
            let mut reaction = self.react(Some(path), None);
            for _ in 0..20_000 {
                let (twist, end) = reaction;
                let twist = twist.expect("it sends twists while it drives");
                if let Some(end) = end {
                    assert_eq!(twist, Twist::ZERO);
                    assert_eq!(self.react(None, None), (None, None));
                    return end;
                }
                self.drive(twist);
                watch(&self.pose, twist);
                reaction = self.react(None, None);
            }
            panic!("it does not come to an end");
        }
    }

    #[test]
    fn a_new_path_does_not_stop_it() {
        let way = path(&[(0.0, 0.0), (20.0, 0.0)], 0.0);
        for (pause, is_fast) in [(0, true), (5, true), (50, false)] {
            let mut robot = Robot::new(follower(), Pose2::default());
            robot.react(Some(&way), None);
            for _ in 0..100 {
                let twist = robot.react(None, None).0.expect("it drives");
                robot.drive(twist);
            }
            robot.node.give_up();
            for _ in 0..pause {
                let _ = robot.react(None, None);
            }
            let twist = robot.react(Some(&way), None).0.expect("it drives");
            assert_eq!(twist.x > 0.7, is_fast, "{twist:?} after {pause} steps");
        }
    }

    #[test]
    fn the_offset_decays_exponentially() {
        let unhurried = PathFollower { acceleration: 1e6, goal_gain: 0.0, ..follower() };
        let mut robot = Robot::new(unhurried, Pose2::new(0.0, 0.5, 0.0));
        let mut worst: f32 = 0.0;
        robot.follow(&path(&[(0.0, 0.0), (10.0, 0.0)], 0.0), |pose, _| {
            if pose.x < 9.0 {
                worst = worst.max((pose.y - 0.5 * (-2.0 * pose.x).exp()).abs());
            }
        });
        // The first step does not move, the others are 2 cm long.
        assert!(worst < 0.02, "{worst}");
    }

    #[test]
    fn it_reaches_goals_with_their_heading() {
        let ways: [&[(f32, f32)]; 4] = [
            &[(0.0, 0.0), (3.0, 0.0)],
            &[(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)],
            &[(0.1, 0.1)],
            &[(0.0, 0.0), (0.0, 0.0)],
        ];
        for points in ways {
            for heading in [0.0, 1.5, -3.1] {
                let mut robot = Robot::new(follower(), Pose2::new(0.0, -0.2, 2.0));
                let way = path(points, heading);
                let (mut last, mut changes) = (Twist::ZERO, 0.0_f32);
                let end = robot.follow(&way, |_, twist| {
                    changes = changes.max((twist.velocity().norm() - last.velocity().norm()).abs());
                    last = twist;
                });
                assert_eq!(end, End::Reached);
                let missed = robot.pose.position() - way.goal().expect("a goal");
                assert!(missed.norm() <= 0.05, "{missed:?}");
                assert!(wrap_angle(robot.pose.theta - heading).abs() <= 0.05);
                assert!(changes <= 0.02 + 1e-4, "accelerates by {} m/s^2", changes / 0.02);
            }
        }
    }

    #[test]
    fn it_looks_along_the_path_until_it_is_near_the_goal() {
        let mut robot = Robot::new(follower(), Pose2::default());
        robot.follow(&path(&[(0.0, 0.0), (6.0, 0.0)], FRAC_PI_2), |pose, _| {
            assert!(pose.x >= 4.9 || pose.theta.abs() < 1e-3, "{pose:?}");
        });
    }

    #[test]
    fn what_stays_on_the_path_blocks_it() {
        let after = |steps: i64, ranges: &[f32]| {
            let mut scan = Scan { angle_increment: FRAC_PI_2, ..Scan::default() };
            scan.ranges.extend(ranges.iter().copied());
            let mut free = Scan::default();
            free.ranges.push(f32::INFINITY).expect("room");
            let mut robot = Robot::new(follower(), Pose2::default());
            let way = path(&[(0.0, 0.0), (20.0, 0.0)], 0.0);
            let mut end = robot.react(Some(&way), Some(&scan)).1;
            while end.is_none() && robot.step < 150 {
                let scan = if robot.step < steps { &scan } else { &free };
                let (twist, now) = robot.react(None, Some(scan));
                robot.drive(twist.expect("it drives"));
                end = now;
            }
            (end, robot.step)
        };
        assert_eq!(after(1000, &[1.0]), (Some(End::Blocked), 102));
        assert_eq!(after(90, &[1.0]), (None, 150), "it went away");
        assert_eq!(after(1000, &[f32::NAN, 0.5]), (None, 150), "it is beside the path");
        assert_eq!(after(1000, &[5.0]), (None, 150), "it is far away");
    }

    #[test]
    fn a_robot_that_makes_no_way_is_blocked() {
        // At the start, just before the goal, and at the goal in the wrong direction.
        for pose in [Pose2::default(), Pose2::new(2.93, 0.0, 0.0), Pose2::new(3.0, 0.0, 1.0)] {
            let mut robot = Robot::new(follower(), pose);
            let mut end = robot.react(Some(&path(&[(0.0, 0.0), (1.0, 0.0), (3.0, 0.0)], 0.0)), None).1;
            while end.is_none() && robot.step < 200 {
                end = robot.react(None, None).1;
            }
            assert_eq!((end, robot.step), (Some(End::Blocked), 102), "{pose:?}");
        }
    }

    #[test]
    fn it_gives_up_far_from_the_path_and_when_it_is_no_longer_active() {
        let way = path(&[(0.0, 0.0), (3.0, 0.0)], 0.0);
        let mut robot = Robot::new(follower(), Pose2::new(0.0, 1.5, 0.0));
        assert_eq!(robot.react(Some(&way), None), (Some(Twist::ZERO), Some(End::OffPath)));
        for odd in [Pose2::new(f32::NAN, 0.0, 0.0), Pose2::new(0.0, 0.0, f32::INFINITY)] {
            robot.pose = odd;
            assert_eq!(robot.react(Some(&way), None), (Some(Twist::ZERO), None));
        }
        robot.pose = Pose2::default();
        assert!(robot.react(None, None).0.is_some());
        robot.node.give_up();
        assert_eq!(robot.react(None, None), (None, None));
        assert_eq!(robot.react(Some(&Path::default()), None), (None, None));
    }

    #[test]
    fn it_waits_for_a_pose_and_accelerates_again() {
        let mut robot = Robot::new(follower(), Pose2::default());
        robot.react(Some(&path(&[(0.0, 0.0), (9.0, 0.0)], 0.0)), None);
        let drive = |robot: &mut Robot| {
            let twist = robot.react(None, None).0.expect("it drives");
            robot.drive(twist);
            twist.x
        };
        let fast = (0..100).map(|_| drive(&mut robot)).last();
        assert!(fast > Some(0.5));
        let here = core::mem::replace(&mut robot.pose, Pose2::new(f32::NAN, 0.0, 0.0));
        assert!((0..200).all(|_| robot.react(None, None) == (Some(Twist::ZERO), None)), "it is not blocked");
        robot.pose = here;
        let slow: Vec<f32> = (0..3).map(|_| drive(&mut robot)).collect();
        assert!(slow[0] == 0.0 && slow[2] > 0.0 && slow[2] < 0.1, "{slow:?}");
    }

    #[test]
    fn far_from_the_origin_it_stops_and_says_so() {
        let way = path(&[(0.0, 0.0), (3.0, 0.0)], 0.0);
        let mut node = follower();
        let mut ask = |x: f32, path| {
            let (mut a, mut b, mut c) = (None, None, None);
            let [a, b, c] = [&mut a, &mut b, &mut c].map(apex_rt::event);
            node.process(&Ctx::new(Time::ZERO), Some(&Pose2::new(x, 0.0, 0.0)), path, None, a, b, c)
        };
        assert_eq!(ask(5e6, None), Ok(None), "it has no path");
        assert!(ask(0.0, Some(&way)).is_ok_and(|twist| twist.is_some()));
        assert_eq!(ask(5e6, None), Err(FarFromOrigin));
    }

    /// A hall of 8 m by 6 m with posts in it, and the same with all obstacles grown by 20 cm.
    fn posts(random: &mut Random) -> [Grid<Occupancy>; 2] {
        let raster = Raster { resolution: 0.1, width: 80, height: 60, ..Raster::default() };
        let mut map = Grid::new(raster, Occupancy::Free).expect("a small map");
        for cell in map.cells_mut() {
            if random.chance(0.01) {
                *cell = Occupancy::Occupied;
            }
        }
        let (mut distances, mut grown) = (Grid::default(), map.clone());
        DistanceTransform::default().run(&map, |cell| *cell == Occupancy::Occupied, &mut distances);
        grow(&mut grown, &distances, 0.2, &[], 0.0);
        [map, grown]
    }

    #[test]
    fn it_touches_nothing_on_planned_paths() {
        let (mut random, mut planner, mut way) = (Random::new(21), Planner::default(), Path::default());
        let (mut reached, mut length) = (0, 0.0);
        for _ in 0..60 {
            let [map, grown] = posts(&mut random);
            let terrain = Terrain { map: &grown, costs: None, unknown_is_open: false };
            let mut pose = || Pose2::new(random.uniform(0.0, 8.0), random.uniform(0.0, 6.0), random.uniform(-3.0, 3.0));
            let (start, goal) = (pose(), pose());
            if planner.plan(&terrain, &start, &goal, Smoothing { spacing: 0.1, rounds: 30 }, &mut way).is_err() {
                continue;
            }
            let end = Robot::new(follower(), start).follow(&way, |pose, _| {
                assert_eq!(map.at(pose.position()).unwrap_or(&Occupancy::Free), &Occupancy::Free, "{pose:?}");
            });
            assert_eq!(end, End::Reached);
            reached += 1;
            length += way.length();
        }
        assert!(reached > 20 && length > 80.0, "only {reached} paths of {length} m");
    }

    #[test]
    fn whatever_comes_in_what_goes_out_is_finite() {
        let mut random = Random::new(11);
        let odd = [0.0, -0.0, 1e-30, 0.1, -1.0, 3.0, 1e20, f32::MAX, f32::INFINITY, f32::NEG_INFINITY, f32::NAN];
        let mut number = || match random.uniform(0.0, 30.0) as usize {
            i if i < odd.len() => odd[i],
            _ => random.uniform(-1.0, 1.0),
        };
        for _ in 0..20_000 {
            let mut robot = Robot::new(follower(), Pose2::new(number(), number(), number()));
            let points: Vec<(f32, f32)> = (0..5).map(|_| (number(), number())).collect();
            let mut scan = Scan { angle_min: number(), angle_increment: number(), ..Scan::default() };
            scan.ranges.extend([number(), number(), number()]);
            let way = path(&points[..(number().abs() * 5.0).min(5.0) as usize], number());
            for path in [Some(&way), None, None] {
                let (twist, _) = robot.react(path, Some(&scan));
                assert!(twist.is_none_or(|twist| twist.is_finite()), "{twist:?} on {way:?} at {:?}", robot.pose);
                robot.pose.x += 0.1;
            }
        }
    }

    /// Centre line of a race track on a scale of 1:50, or `None` (with a message) if its file is missing.
    fn track(name: &str) -> Option<Path> {
        let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../shared/data/paths");
        if !folder.is_dir() {
            assert!(std::env::var("CI").as_deref() != Ok("true"), "{} is missing", folder.display());
            eprintln!("skipped: {} is missing", folder.display());
            return None;
        }
        let text = fs::read_to_string(folder.join(name)).expect("the track");
        let number = |word: &str| word.parse::<f32>().expect("a number") / 50.0;
        let rows = text.lines().skip(1).map(|line| line.split(',').map(number).collect::<Vec<f32>>());
        let points: Vec<Point2> = rows.map(|row| Point2::new(row[0], row[1])).collect();
        let heading = (points[1] - points[0]).angle();
        Some(Path { points, heading })
    }

    #[test]
    fn it_stays_on_race_tracks() {
        for name in ["Norisring.csv", "Spielberg.csv"] {
            let Some(way) = track(name) else { return };
            let start = Pose2::new(way.points[0].x, way.points[0].y, way.heading);
            let mut robot = Robot::new(follower(), start);
            let (mut worst, mut squares, mut steps) = (0.0_f32, 0.0, 0);
            let end = robot.follow(&way, |pose, _| {
                let to_segment =
                    |ends: &[Point2]| (pose.position() - nearest_on(ends[0], ends[1], pose.position())).norm();
                let offset = way.points.windows(2).map(to_segment).fold(f32::INFINITY, f32::min);
                worst = worst.max(offset);
                squares += offset * offset;
                steps += 1;
            });
            let (seconds, rms) = (0.02 * steps as f32, (squares / steps as f32).sqrt());
            let length = way.length();
            println!("{name}: {length:.1} m in {seconds:.1} s, offset {worst:.3} m at most, {rms:.4} m rms");
            assert_eq!(end, End::Reached);
            assert!(worst < 0.1 && rms < 0.02, "{worst} m at most, {rms} m rms");
        }
    }
}
