use crate::frames::Rotation;

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
    /// Weston: Strapdown Inertial Navigation Technology, 2004, 3.6.3). `None` if it is not a number, faster than a
    /// gyroscope measures, or the robot stands on its front or its back.
    pub fn turn_rate(&self) -> Option<f64> {
        let ([roll, pitch], [_, y, z]) = (self.inclination(), self.angular_velocity);
        let ((sin, cos), level) = (libm::sincos(roll), libm::cos(pitch));
        let rate = (y * sin + z * cos) / level;
        (level > STEEPEST && rate.abs() <= FASTEST).then_some(rate)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
}
