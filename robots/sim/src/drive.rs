use crate::Footprint;
use apex_nodes::{
    math::normalize_angle,
    nav::{Articulated, Twist},
    scan::{Point2, Pose2},
};

/// Limits of the motors of a base.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// Maximum speed, in m/s.
    pub speed: f32,
    /// Maximum change of the velocity, in m/s².
    pub acceleration: f32,
    /// Maximum angular velocity, in rad/s.
    pub turn: f32,
    /// Maximum change of the angular velocity, in rad/s².
    pub turn_acceleration: f32,
}

/// Base that moves in all directions and turns at the same time: three or four omni wheels.
#[derive(Debug, Clone, PartialEq)]
pub struct Omnidirectional {
    /// Pose in the world.
    pub pose: Pose2,
    /// Velocity in the frame of the base.
    pub twist: Twist,
    /// Limits of the motors.
    pub limits: Limits,
}

/// Base with two driven wheels on one axis: it moves along its x axis only.
#[derive(Debug, Clone, PartialEq)]
pub struct Differential {
    /// Pose of the middle of the axis in the world.
    pub pose: Pose2,
    /// Velocity in the frame of the base; y is 0.
    pub twist: Twist,
    /// Limits of the motors. The speed is that of each wheel.
    pub limits: Limits,
    /// Distance between the wheels, in m.
    pub track: f32,
}

/// A [`Differential`] base that pulls a trailer with one axis (off-axle hitching; Lamiraux et al. 1998).
#[derive(Debug, Clone, PartialEq)]
pub struct Tractor {
    /// Tractor.
    pub base: Differential,
    /// Heading of the trailer in the world, in rad.
    pub trailer: f32,
    /// Shape of both.
    pub shape: Articulated,
}

impl Omnidirectional {
    /// Moves for `dt` s, as close to `command` as possible. Components of a command that are not finite count as 0.
    pub fn step(&mut self, command: &Twist, dt: f32) {
        let limits = &self.limits;
        let velocity = shortened(Point2::new(finite(command.x), finite(command.y)), limits.speed);
        let change = shortened(velocity - self.twist.velocity(), limits.acceleration * dt);
        let omega = towards(self.twist.omega, finite(command.omega), limits.turn, limits.turn_acceleration * dt);
        self.twist = Twist::of(self.twist.velocity() + change, omega);
        self.pose = moved(&self.pose, &self.twist, dt);
    }
}

impl Differential {
    /// Moves for `dt` s, as close to `command` as possible; sideways motion is ignored. If a wheel would exceed the
    /// speed limit, both wheels are slowed down by the same factor, so that the curve is unchanged.
    pub fn step(&mut self, command: &Twist, dt: f32) {
        let limits = &self.limits;
        let half_track = 0.5 * self.track;
        let (x, omega) = (finite(command.x), finite(command.omega));
        let wheel = x.abs() + (omega * half_track).abs();
        let slower = if wheel > limits.speed { limits.speed / wheel } else { 1.0 };
        self.twist = Twist {
            x: towards(self.twist.x, x * slower, limits.speed, limits.acceleration * dt),
            y: 0.0,
            omega: towards(self.twist.omega, omega * slower, limits.turn, limits.turn_acceleration * dt),
        };
        self.pose = moved(&self.pose, &self.twist, dt);
    }
}

impl Tractor {
    /// Creates a tractor that stands at a pose, with its trailer straight behind.
    pub const fn straight(pose: Pose2, shape: Articulated, limits: Limits) -> Self {
        let base = Differential { pose, twist: Twist::ZERO, limits, track: shape.width };
        Self { base, trailer: pose.theta, shape }
    }

    /// Areas of tractor and trailer.
    pub fn footprints(&self) -> [Footprint; 2] {
        Footprint::of(&self.shape, &self.base.pose, self.trailer)
    }

    /// Moves for `dt` s; the trailer follows.
    pub fn step(&mut self, command: &Twist, dt: f32) {
        self.base.step(command, dt);
        let Twist { x, omega, .. } = self.base.twist;
        let turn = self.shape.trailer_rotation(x, omega, self.base.pose.theta - self.trailer);
        self.trailer = normalize_angle(&(self.trailer + turn * dt));
    }

    /// Pose of the middle of the trailer's axis in the world.
    pub fn trailer_pose(&self) -> Pose2 {
        self.shape.trailer(&self.base.pose, self.trailer)
    }
}

/// Pose after moving from `pose` with a constant twist for `dt` s (to second order).
fn moved(pose: &Pose2, twist: &Twist, dt: f32) -> Pose2 {
    let middle = Pose2 { theta: pose.theta + 0.5 * twist.omega * dt, ..*pose };
    let position = middle.to_outer(twist.velocity().scaled(dt));
    Pose2::new(position.x, position.y, normalize_angle(&(pose.theta + twist.omega * dt)))
}

/// Moves a value towards `wanted`, limited to the magnitude `highest` and to a change of `step`.
fn towards(is: f32, wanted: f32, highest: f32, step: f32) -> f32 {
    is + (wanted.clamp(-highest, highest) - is).clamp(-step, step)
}

fn shortened(vector: Point2, longest: f32) -> Point2 {
    let length = vector.norm();
    if length > longest { vector.scaled(longest / length) } else { vector }
}

fn finite(value: f32) -> f32 {
    if value.is_finite() { value } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f32::consts::{FRAC_PI_2, PI};

    const LIMITS: Limits = Limits { speed: 1.5, acceleration: 2.0, turn: 3.0, turn_acceleration: 6.0 };

    #[test]
    fn an_omnidirectional_base_moves_as_it_is_told_within_its_limits() {
        let mut base = Omnidirectional { pose: Pose2::default(), twist: Twist::ZERO, limits: LIMITS };
        base.step(&Twist::new(0.0, 9.0, 0.0), 0.5);
        assert_eq!(base.twist, Twist::new(0.0, 1.0, 0.0), "half a second at 2 m/s²");
        base.step(&Twist::new(0.0, 9.0, 0.0), 0.5);
        assert!((base.twist.y - 1.5).abs() < 1e-6 && (base.pose.y - 1.25).abs() < 1e-6);
        base.step(&Twist::new(f32::NAN, f32::INFINITY, f32::NAN), 10.0);
        assert!(base.twist.velocity().norm() < 1e-6, "no number is no command");
    }

    #[test]
    fn a_circle_closes() {
        let twist = Twist::new(1.0, 0.0, 1.0);
        let mut base = Differential { pose: Pose2::default(), twist, limits: LIMITS, track: 0.4 };
        for _ in 0..1000 {
            base.step(&twist, 2.0 * PI / 1000.0);
        }
        assert!(base.pose.position().norm() < 1e-3 && base.pose.theta.abs() < 1e-3, "{:?}", base.pose);
    }

    #[test]
    fn wheels_that_are_too_slow_keep_the_curve() {
        let mut base = Differential { pose: Pose2::default(), twist: Twist::ZERO, limits: LIMITS, track: 1.0 };
        base.step(&Twist::new(2.0, 1.0, 2.0), 10.0);
        assert!((base.twist.x - 1.0).abs() < 1e-6 && (base.twist.omega - 1.0).abs() < 1e-6 && base.twist.y == 0.0);
    }

    #[test]
    fn a_trailer_comes_into_line() {
        let base = Differential { pose: Pose2::default(), twist: Twist::ZERO, limits: LIMITS, track: 0.5 };
        let mut tractor = Tractor {
            base,
            trailer: -FRAC_PI_2,
            shape: Articulated { hitch: 0.2, drawbar: 0.8, ..Articulated::PATSY },
        };
        assert!((tractor.trailer_pose().y - 0.8).abs() < 1e-6 && (tractor.trailer_pose().x + 0.2).abs() < 1e-6);
        for _ in 0..1000 {
            tractor.step(&Twist::new(1.0, 0.0, 0.0), 0.01);
        }
        assert!(tractor.trailer.abs() < 1e-3, "{}", tractor.trailer);
        assert!((tractor.base.pose.x - tractor.trailer_pose().x - 1.0).abs() < 1e-3);
    }
}
