use crate::{
    frames::{Pose3, Rotation},
    scan::Pose2,
};
use apex_rt::{Ctx, Time, node};

/// Fastest turn that counts as measured, in rad/s: more than the 2000°/s of usual gyroscopes.
const FASTEST: f64 = 40.0;
/// Cosine of the steepest pitch at which a heading is defined well enough.
const STEEPEST: f64 = 0.1;

/// Measurement of an inertial sensor: inclination and angular velocity, in the frame of the robot (x forward, y left,
/// z up). In recordings it is a `sensor_msgs/msg/Imu`. A heading in it, of a compass, is not used.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Inertial {
    /// Orientation. That of a sensor that does not know it is [`Rotation::NONE`]: the robot counts as level.
    pub rotation: Rotation,
    /// Angular velocity about x, y and z, in rad/s.
    pub angular_velocity: [f64; 3],
}

impl Inertial {
    /// Measurement of a gyroscope alone, about the vertical axis, in rad/s.
    pub const fn level(turn_rate: f64) -> Self {
        Self { rotation: Rotation::NONE, angular_velocity: [0.0, 0.0, turn_rate] }
    }

    /// Roll and pitch, in rad, as [`Rotation::from_rpy`] has them.
    pub fn inclination(&self) -> [f64; 2] {
        // The last row of the rotation matrix: −sin pitch, sin roll cos pitch, cos roll cos pitch.
        let [_, _, [x, y, z]] = self.rotation.matrix();
        [libm::atan2(y, z), libm::asin((-x).clamp(-1.0, 1.0))]
    }

    /// Rate of the heading, in rad/s: ψ' = (ω_y sin φ + ω_z cos φ) / cos θ, with the roll φ and the pitch θ (Titterton,
    /// Weston: Strapdown Inertial Navigation Technology, 2004, 3.6.3). `None` if it is no number, faster than a
    /// gyroscope measures, or the robot stands on its front or its back.
    pub fn turn_rate(&self) -> Option<f64> {
        let ([roll, pitch], [_, y, z]) = (self.inclination(), self.angular_velocity);
        let ((sin, cos), level) = (libm::sincos(roll), libm::cos(pitch));
        let rate = (y * sin + z * cos) / level;
        (level > STEEPEST && rate.abs() <= FASTEST).then_some(rate)
    }
}

/// Pose in space from a pose in the plane and the inclination that an inertial sensor measures, which may come at
/// another rate: the last one counts. The heading is that of the pose, the height is 0. Without an inclination for
/// longer than `max_age` it is ⊥.
#[node]
#[derive(Debug, Clone, Default)]
pub struct TiltPose {
    /// Time for which an inclination counts.
    #[param(unit = "s", default = 0.5, range = 0.0..=3600.0)]
    max_age: f32,
    last: Option<(Time, [f64; 2])>,
}

#[node]
impl TiltPose {
    fn process(&mut self, ctx: &Ctx, pose: &Pose2) -> Option<Pose3> {
        let (then, [roll, pitch]) = self.last?;
        if ctx.now().since(then).as_secs_f32() > self.max_age {
            return None;
        }
        let rotation = Rotation::from_rpy(roll, pitch, f64::from(pose.theta));
        Some(Pose3::new([f64::from(pose.x), f64::from(pose.y), 0.0], rotation))
    }

    /// Measurement of the inertial sensor.
    #[slot]
    fn inertial(&mut self, ctx: &Ctx, inertial: &Inertial) {
        self.last = Some((ctx.now(), inertial.inclination()));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use apex_rt::Construct;

    #[test]
    fn the_rate_of_the_heading_is_that_of_the_rotation() {
        let [roll, pitch, yaw] = [|t: f64| 0.3 * t, |t: f64| 0.2 - 0.5 * t, |t: f64| 1.0 + 0.7 * t];
        let at = |t: f64| Rotation::from_rpy(roll(t), pitch(t), yaw(t));
        let (t, h) = (0.4, 1e-6);
        // The small rotation in the frame of the robot is half of its vector.
        let [x, y, z, _] = at(t).inverse().then(at(t + h)).quaternion();
        let inertial = Inertial { rotation: at(t), angular_velocity: [x, y, z].map(|c| 2.0 * c / h) };
        let rate = inertial.turn_rate().expect("a rate");
        assert!((rate - 0.7).abs() < 1e-5, "{rate}");
        let [a, b] = inertial.inclination();
        assert!((a - roll(t)).abs() < 1e-12 && (b - pitch(t)).abs() < 1e-12);
    }

    #[test]
    fn what_is_no_rate_is_none() {
        for odd in [f64::NAN, f64::INFINITY, -1e9] {
            assert_eq!(Inertial::level(odd).turn_rate(), None);
        }
        let upright = Inertial { rotation: Rotation::from_rpy(0.0, 1.57, 0.0), ..Inertial::level(1.0) };
        assert_eq!(upright.turn_rate(), None);
    }

    #[test]
    fn a_tilted_pose_keeps_its_heading() {
        let mut node = TiltPose::construct((0.5,));
        let (pose, at) = (Pose2::new(1.0, 2.0, 0.5), |ms| Ctx::new(Time::from_millis(ms)));
        assert_eq!(node.process(&at(0), &pose), None);
        let rotation = Rotation::from_rpy(0.1, -0.2, 3.0);
        node.inertial(&at(10), &Inertial { rotation, ..Inertial::default() });
        let tilted = node.process(&at(500), &pose).expect("a pose");
        let expected = Rotation::from_rpy(0.1, -0.2, 0.5).quaternion();
        assert!(tilted.rotation.quaternion().into_iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12));
        assert_eq!(tilted.position(), [1.0, 2.0, 0.0]);
        assert_eq!(node.process(&at(520), &pose), None, "it is too old");
    }
}
