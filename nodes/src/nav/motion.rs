//! Motion relative to sensor data, without a map (thesis 8.1.1). These nodes move the robot while they are active.
//! A node that is interrupted sends a twist of zero, then ⊥. One that does not know when to stop sends zero.

use super::{
    Twist,
    latest::{any_far, fresh},
    twist::Halt,
};
use crate::scan::{FarFromOrigin, Point2, Pose2, Scan, wrap_angle};
use apex_rt::{Ctx, Event, Time, node};
use core::f32::consts::PI;
use libm::sqrtf;

/// Minimum speed before a stop, in m/s.
const SLOWEST: f32 = 0.02;
/// Proportional gain of the heading controller: angular velocity per heading error, in 1/s.
const TURN_GAIN: f32 = 2.0;

/// Speed at `distance` m before a stop under constant deceleration, in m/s. It stays above a minimum, so that the robot
/// arrives.
fn braking_speed(distance: f32, speed: f32, deceleration: f32) -> f32 {
    sqrtf(2.0 * deceleration * distance.max(0.0)).clamp(SLOWEST.min(speed), speed)
}

/// Moves a robot by a distance in a direction, relative to its pose at activation, and keeps its heading (thesis
/// 8.1.1).
///
/// `pose` is in any fixed frame, such as that of odometry. `done` comes with a twist of zero. Without a pose that is
/// younger than `max_age`, the robot stands still until there is one. Stops and fails if the pose is more than 100 km
/// from the origin.
#[node]
#[derive(Debug, Clone)]
pub struct MoveRobot {
    /// Distance to move.
    #[param(unit = "m", range = 0.0..=1000.0)]
    distance: f32,
    /// Direction of the movement, counter-clockwise from straight ahead.
    #[param(unit = "rad", default = 0.0, range = -6.3..=6.3)]
    direction: f32,
    /// Maximum speed.
    #[param(unit = "m/s", default = 0.5, range = 0.001..=10.0)]
    speed: f32,
    /// Acceleration and deceleration.
    #[param(unit = "m/s^2", default = 0.5, range = 0.01..=100.0)]
    acceleration: f32,
    /// Maximum age of a pose.
    #[param(unit = "s", default = 0.5, range = 0.01..=60.0, silence)]
    max_age: f32,
    start: Option<Pose2>,
    halt: Halt,
}

#[node]
impl MoveRobot {
    fn process(&mut self, ctx: &Ctx, pose: Option<&Pose2>, done: Event<()>) -> Result<Option<Twist>, FarFromOrigin> {
        if ctx.active() && any_far([pose]) {
            return self.halt.far();
        }
        Ok(self.step(ctx, pose, done))
    }

    fn step(&mut self, ctx: &Ctx, pose: Option<&Pose2>, done: Event<()>) -> Option<Twist> {
        if !ctx.active() {
            return self.halt.rest();
        }
        let Some(pose) = fresh(ctx, pose, self.max_age) else { return self.halt.drive(Twist::ZERO) };
        let start = *self.start.get_or_insert(*pose);
        let goal = start.to_outer(Point2::polar(self.distance, self.direction));
        let course = Point2::polar(1.0, start.theta + self.direction);
        let remaining = course.dot(goal - pose.position());
        if remaining <= 0.0 {
            self.forget();
            done.emit(());
            return self.halt.drive(Twist::ZERO);
        }
        // Counted from a little before the start, so that the robot starts faster than at the minimum speed.
        let travelled = self.distance - remaining;
        let least = travelled.min(remaining) + SLOWEST * SLOWEST / self.acceleration;
        let speed = braking_speed(least, self.speed, self.acceleration);
        let to_goal = pose.to_inner(goal);
        let omega = TURN_GAIN * wrap_angle(start.theta - pose.theta);
        self.halt.drive(Twist::of(to_goal.scaled(speed / to_goal.norm()), omega))
    }

    /// Discards the start pose: the next movement begins at the pose of the robot at that time.
    #[on_activate]
    fn forget(&mut self) {
        self.start = None;
    }
}

/// Drives straight ahead until an obstacle is near (thesis 8.1.1; stations in 4.3.7). `done` comes with a twist of
/// zero.
///
/// The scan is in the frame of the robot. While nothing is measured ahead, the robot stands still, as the distance to
/// stop at is unknown, and while there is no scan that is younger than `max_age`, by its stamp. A `SafetyField` behind
/// this node needs a margin below `distance`; otherwise the robot never gets there.
#[node]
#[derive(Debug, Clone)]
pub struct MoveToObstacle {
    /// Distance between the front of the robot and the obstacle at the end.
    #[param(unit = "m", default = 0.05, range = 0.0..=100.0)]
    distance: f32,
    /// Distance of the robot's front from the origin of its frame.
    #[param(unit = "m", default = 0.3, range = 0.0..=10.0)]
    front: f32,
    /// Half of the width of the strip that counts as ahead.
    #[param(unit = "m", default = 0.3, range = 0.0..=10.0)]
    half_width: f32,
    /// Maximum speed.
    #[param(unit = "m/s", default = 0.2, range = 0.001..=10.0)]
    speed: f32,
    /// Deceleration before the obstacle.
    #[param(unit = "m/s^2", default = 0.5, range = 0.01..=100.0)]
    deceleration: f32,
    /// Maximum age of a scan.
    #[param(unit = "s", default = 0.5, range = 0.01..=60.0, silence)]
    max_age: f32,
    halt: Halt,
}

#[node]
impl MoveToObstacle {
    fn process(&mut self, ctx: &Ctx, scan: Option<&Scan>, done: Event<()>) -> Option<Twist> {
        if !ctx.active() {
            return self.halt.rest();
        }
        let points = fresh(ctx, scan, self.max_age).into_iter().flat_map(Scan::points).map(|(_, p)| p);
        let ahead = points.filter(|p| p.x > 0.0 && p.y.abs() <= self.half_width);
        let Some(nearest) = ahead.map(|p| p.x).reduce(f32::min) else { return self.halt.drive(Twist::ZERO) };
        let gap = nearest - self.front - self.distance;
        if gap <= 0.0 {
            done.emit(());
            return self.halt.drive(Twist::ZERO);
        }
        self.halt.drive(Twist::new(braking_speed(gap, self.speed, self.deceleration), 0.0, 0.0))
    }
}

/// Centres a robot in front of a target, facing it (thesis 8.1.1).
///
/// `target` is the pose of the target in the frame of the robot; the x axis of the target points out of it, towards the
/// viewer. While it is ⊥, the robot stands still; `lost` comes once the target has not been seen for longer than
/// `lost_timeout`. `positioned` comes with a twist of zero.
#[node]
#[derive(Debug, Clone)]
pub struct PositionToTarget {
    /// Distance between the origin of the robot's frame and the target at the end.
    #[param(unit = "m", default = 0.5, range = 0.0..=100.0)]
    distance: f32,
    /// Maximum speed.
    #[param(unit = "m/s", default = 0.3, range = 0.001..=10.0)]
    speed: f32,
    /// Maximum angular velocity.
    #[param(unit = "rad/s", default = 0.8, range = 0.001..=20.0)]
    max_rotation: f32,
    /// Proportional gain: speed per distance to go, and angular velocity per heading error.
    #[param(unit = "1/s", default = 1.0, range = 0.001..=100.0)]
    gain: f32,
    /// Tolerance of the position.
    #[param(unit = "m", default = 0.02, range = 0.0001..=1.0)]
    tolerance: f32,
    /// Tolerance of the heading.
    #[param(unit = "rad", default = 0.03, range = 0.0001..=3.2)]
    heading_tolerance: f32,
    /// Time that the target may be out of sight.
    #[param(unit = "s", default = 2.0, range = 0.0..=600.0)]
    lost_timeout: f32,
    /// Maximum age of the pose of the target.
    #[param(unit = "s", default = 0.5, range = 0.01..=60.0, silence)]
    max_age: f32,
    seen: Option<Time>,
    halt: Halt,
}

#[node]
impl PositionToTarget {
    fn process(
        &mut self,
        ctx: &Ctx,
        target: Option<&Pose2>,
        positioned: Event<()>,
        #[failure] lost: Event<()>,
    ) -> Option<Twist> {
        if !ctx.active() {
            return self.halt.rest();
        }
        let target = fresh(ctx, target, self.max_age);
        let Some(place) = target.map(|target| target.compose(&Pose2::new(self.distance, 0.0, PI))) else {
            if ctx.now().since(*self.seen.get_or_insert(ctx.now())).as_secs_f32() > self.lost_timeout {
                self.forget();
                lost.emit(());
            }
            return self.halt.drive(Twist::ZERO);
        };
        self.seen = Some(ctx.now());
        let distance = place.position().norm();
        if distance <= self.tolerance && place.theta.abs() <= self.heading_tolerance {
            self.forget();
            positioned.emit(());
            return self.halt.drive(Twist::ZERO);
        }
        let factor = self.gain.min(self.speed / distance.max(f32::MIN_POSITIVE));
        let omega = (self.gain * place.theta).clamp(-self.max_rotation, self.max_rotation);
        self.halt.drive(Twist::of(place.position().scaled(factor), omega))
    }

    /// Restarts the time that the target may be out of sight.
    #[on_activate]
    fn forget(&mut self) {
        self.seen = None;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use apex_rt::Construct;
    use core::f32::consts::FRAC_PI_2;

    fn active(step: i64) -> Ctx {
        Ctx::new(Time::from_millis(20 * step)).of_node(true)
    }

    fn drive(pose: &Pose2, twist: Twist) -> Pose2 {
        let moved = twist.velocity().scaled(0.02);
        pose.compose(&Pose2::new(moved.x, moved.y, 0.02 * twist.omega))
    }

    #[test]
    fn a_robot_moves_by_a_distance() {
        for (direction, distance) in [(0.0, 2.0), (PI, 1.0), (0.7, 0.01), (-FRAC_PI_2, 0.0)] {
            let mut node = MoveRobot::construct((distance, direction, 0.5, 0.5, 0.5));
            let start = Pose2::new(1.0, 2.0, 0.3);
            let (mut pose, mut last, mut done) = (start, 0.0, None);
            for step in 0..2000 {
                let twist = node.step(&active(step), Some(&pose), apex_rt::event(&mut done)).expect("it is active");
                let speed = twist.velocity().norm();
                assert!(done.is_some() || (speed <= 0.5 + 1e-5 && (speed - last).abs() < 0.04), "{speed} after {last}");
                if done.is_some() {
                    assert_eq!(twist, Twist::ZERO);
                    break;
                }
                last = speed;
                // A disturbance turns the robot a little.
                pose = drive(&pose, Twist { omega: twist.omega + 0.1, ..twist });
            }
            let missed = pose.position() - start.to_outer(Point2::polar(distance, direction));
            assert!(done.is_some() && missed.norm() < 0.01, "{missed:?}");
        }
    }

    #[test]
    fn nothing_moves_what_is_not_active() {
        let ctx = Ctx::new(Time::ZERO);
        let (pose, mut scan) = (Pose2::default(), Scan::default());
        scan.ranges.push(1.0).expect("there is room");
        let mut on = MoveRobot::construct((1.0, 0.0, 0.5, 0.5, 0.5));
        assert_eq!(on.step(&ctx, Some(&pose), Event::unconnected()), None);
        let mut ahead = MoveToObstacle::construct((0.05, 0.3, 0.3, 0.2, 0.5, 0.5));
        assert_eq!(ahead.process(&ctx, Some(&scan), Event::unconnected()), None);
        let mut position = PositionToTarget::construct((0.5, 0.3, 0.8, 1.0, 0.02, 0.03, 2.0, 0.5));
        assert_eq!(position.process(&ctx, Some(&pose), Event::unconnected(), Event::unconnected()), None);
    }

    #[test]
    fn a_motion_that_is_interrupted_ends_with_a_twist_of_zero() {
        let (rest, pose) = (Ctx::new(Time::ZERO), Pose2::default());
        let mut node = MoveRobot::construct((1.0, 0.0, 0.5, 0.5, 0.5));
        let mut twist = |ctx: &Ctx, pose: Option<&Pose2>| node.step(ctx, pose, Event::unconnected());
        assert!(twist(&active(0), Some(&pose)).is_some_and(|twist| twist.x > 0.0));
        assert_eq!([twist(&rest, None), twist(&rest, Some(&pose))], [Some(Twist::ZERO), None]);
    }

    #[test]
    fn without_a_pose_the_robot_stands_and_goes_on_afterwards() {
        let mut node = MoveRobot::construct((1.0, 0.0, 0.5, 0.5, 0.5));
        let mut speed = |step, pose: Option<Pose2>| {
            node.step(&active(step), pose.as_ref(), Event::unconnected()).expect("it is active").x
        };
        let at = |x| Some(Pose2::new(x, 0.0, 0.0));
        assert!(speed(0, at(0.0)) > 0.0);
        assert_eq!([speed(1, None), speed(2, at(f32::NAN)), speed(3, at(5e6))], [0.0; 3]);
        assert!(speed(4, at(0.5)) > 0.4, "it is half way");
        let old = active(100).since(Time::from_millis(1500));
        assert_eq!(node.step(&old, Some(&Pose2::default()), Event::unconnected()), Some(Twist::ZERO));
    }

    #[test]
    fn a_robot_drives_up_to_a_wall() {
        let mut node = MoveToObstacle::construct((0.05, 0.3, 0.3, 0.2, 0.5, 0.5));
        let (mut x, mut done) = (0.0, None);
        for step in 0..1000 {
            // A wall at 2 m, and an object beside the robot.
            let stamp = active(step).now();
            let mut scan = Scan { angle_min: -0.5, angle_increment: 0.05, range_max: 10.0, stamp, ..Scan::default() };
            scan.ranges.extend((0..21).map(|i| (2.0 - x) / libm::cosf(-0.5 + 0.05 * i as f32)));
            scan.ranges[20] = 0.7;
            let twist = node.process(&active(step), Some(&scan), apex_rt::event(&mut done)).expect("it is active");
            if done.is_some() {
                break;
            }
            x += 0.02 * twist.x;
        }
        assert!(done.is_some() && (1.65..1.655).contains(&x), "{x}");
    }

    #[test]
    fn a_robot_that_sees_no_wall_stands() {
        let mut scan = Scan { angle_increment: 0.05, ..Scan::default() };
        let mut node = MoveToObstacle::construct((0.05, 0.3, 0.3, 0.2, 0.5, 0.5));
        let mut stands = |ms, scan: Option<&Scan>| {
            let ctx = Ctx::new(Time::from_millis(ms)).of_node(true);
            node.process(&ctx, scan, Event::unconnected()) == Some(Twist::ZERO)
        };
        assert!(stands(0, None) && stands(0, Some(&scan)));
        scan.ranges.push(f32::NAN).expect("there is room");
        assert!(stands(0, Some(&scan)));
        scan.ranges[0] = 3.0;
        assert!(!stands(400, Some(&scan)) && stands(500, Some(&scan)), "the scan is too old");
        scan.stamp = Time::from_millis(1500);
        assert!(stands(900, Some(&scan)) && !stands(1100, Some(&scan)), "the scan is from the future");
    }

    #[test]
    fn a_robot_is_centred_before_its_target() {
        // The target faces along −x of the world, towards a robot that comes from there.
        let target = Pose2::new(3.0, 1.0, PI);
        let mut node = PositionToTarget::construct((0.5, 0.3, 0.8, 1.0, 0.02, 0.03, 2.0, 0.5));
        let (mut pose, mut positioned) = (Pose2::new(1.5, 0.3, -0.6), None);
        for step in 0..1000 {
            let seen = target.relative_to(&pose);
            let twist = node
                .process(&active(step), Some(&seen), apex_rt::event(&mut positioned), Event::unconnected())
                .expect("it is active");
            assert!(twist.velocity().norm() <= 0.3 + 1e-6 && twist.omega.abs() <= 0.8);
            pose = drive(&pose, twist);
            if positioned.is_some() {
                break;
            }
        }
        assert!(positioned.is_some());
        assert!((pose.position() - Point2::new(2.5, 1.0)).norm() <= 0.02 && pose.theta.abs() <= 0.03, "{pose:?}");
    }

    #[test]
    fn a_target_out_of_sight_is_lost_after_a_while() {
        let mut node = PositionToTarget::construct((0.5, 0.3, 0.8, 1.0, 0.02, 0.03, 2.0, 0.5));
        let mut react = |step, target: Option<Pose2>| {
            let mut lost = None;
            let twist = node.process(&active(step), target.as_ref(), Event::unconnected(), apex_rt::event(&mut lost));
            (twist == Some(Twist::ZERO), lost.is_some())
        };
        assert_eq!(react(0, None), (true, false));
        assert_eq!(react(90, Some(Pose2::new(2.0, 0.0, PI))), (false, false));
        assert_eq!(react(190, Some(Pose2::new(f32::NAN, 0.0, PI))), (true, false));
        assert_eq!(react(191, None), (true, true));
        assert_eq!(react(192, None), (true, false));
    }
}
