use apex_nodes::{
    math::normalize_angle,
    nav::Twist,
    scan::{Point2, Pose2},
};

/// What the motors of a base can do.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// The highest speed, in m/s.
    pub speed: f32,
    /// The highest change of the velocity, in m/s².
    pub acceleration: f32,
    /// The highest turn rate, in rad/s.
    pub turn: f32,
    /// The highest change of the turn rate, in rad/s².
    pub turn_acceleration: f32,
}

/// A base that moves in all directions and turns at the same time: three or four omni wheels.
#[derive(Debug, Clone, PartialEq)]
pub struct Omnidirectional {
    /// Where it is in the world.
    pub pose: Pose2,
    /// How it moves, in its own frame.
    pub twist: Twist,
    /// What it can do.
    pub limits: Limits,
}

/// A base with two driven wheels on one axis: it moves along its x axis only.
#[derive(Debug, Clone, PartialEq)]
pub struct Differential {
    /// Where the middle of its axis is in the world.
    pub pose: Pose2,
    /// How it moves, in its own frame; y is 0.
    pub twist: Twist,
    /// What it can do. The speed is that of each wheel.
    pub limits: Limits,
    /// Distance of the wheels, in m.
    pub track: f32,
}

/// A [`Differential`] base that pulls a trailer with one axis (off-axle hitching; Lamiraux et al. 1998).
#[derive(Debug, Clone, PartialEq)]
pub struct Tractor {
    /// What pulls.
    pub base: Differential,
    /// Heading of the trailer in the world, in rad.
    pub trailer: f32,
    /// From the axis of the tractor back to the hitch, in m.
    pub hitch: f32,
    /// From the hitch back to the axis of the trailer, in m.
    pub drawbar: f32,
}

impl Omnidirectional {
    /// Moves for `dt` s, as near to `command` as it can. What is not finite in a command is 0.
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
    /// Moves for `dt` s, as near to `command` as it can: sideways it cannot. Where both wheels together cannot do what
    /// is asked for, both are slowed down by the same factor, so that the curve stays.
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
    /// Moves for `dt` s; the trailer follows.
    pub fn step(&mut self, command: &Twist, dt: f32) {
        self.base.step(command, dt);
        let Twist { x, omega, .. } = self.base.twist;
        let (sin, cos) = libm::sincosf(self.base.pose.theta - self.trailer);
        let turn = (x * sin - self.hitch * omega * cos) / self.drawbar;
        self.trailer = normalize_angle(&(self.trailer + turn * dt));
    }

    /// Where the middle of the axis of the trailer is in the world.
    pub fn trailer_pose(&self) -> Pose2 {
        let hitch = self.base.pose.to_outer(Point2::new(-self.hitch, 0.0));
        let axis = hitch - Point2::polar(self.drawbar, self.trailer);
        Pose2::new(axis.x, axis.y, self.trailer)
    }
}

/// Where a constant twist leads from `pose` in `dt` s (to second order).
fn moved(pose: &Pose2, twist: &Twist, dt: f32) -> Pose2 {
    let middle = Pose2 { theta: pose.theta + 0.5 * twist.omega * dt, ..*pose };
    let position = middle.to_outer(twist.velocity().scaled(dt));
    Pose2::new(position.x, position.y, normalize_angle(&(pose.theta + twist.omega * dt)))
}

/// A value that is asked to become `wanted`, at most `highest`, and changes by `step` at most.
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
        let mut tractor = Tractor { base, trailer: -FRAC_PI_2, hitch: 0.2, drawbar: 0.8 };
        assert!((tractor.trailer_pose().y - 0.8).abs() < 1e-6 && (tractor.trailer_pose().x + 0.2).abs() < 1e-6);
        for _ in 0..1000 {
            tractor.step(&Twist::new(1.0, 0.0, 0.0), 0.01);
        }
        assert!(tractor.trailer.abs() < 1e-3, "{}", tractor.trailer);
        assert!((tractor.base.pose.x - tractor.trailer_pose().x - 1.0).abs() < 1e-3);
    }
}
