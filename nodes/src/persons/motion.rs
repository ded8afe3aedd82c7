use crate::scan::Point2;
use core::f32::consts::TAU;

/// Kalman filter of a motion with constant velocity in the plane.
///
/// Noise is the same along both axes, so that both share the covariance of position and velocity.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Motion {
    /// Estimated position, in m.
    pub position: Point2,
    /// Estimated velocity, in m/s.
    pub velocity: Point2,
    /// Variance of the position along an axis, in m².
    variance: f32,
    /// Covariance of position and velocity along an axis, in m²/s.
    covariance: f32,
    /// Variance of the velocity along an axis, in m²/s².
    velocity_variance: f32,
}

impl Motion {
    /// Motion that begins at a measured position with unknown velocity.
    ///
    /// `deviation` is the standard deviation of the measurement in m, `speed` that of velocities in m/s.
    pub const fn begin(position: Point2, deviation: f32, speed: f32) -> Self {
        Self {
            position,
            velocity: Point2::new(0.0, 0.0),
            variance: deviation * deviation,
            covariance: 0.0,
            velocity_variance: speed * speed,
        }
    }

    /// Motion after `seconds`. `acceleration` is the density of the white noise of accelerations, in m/s^1.5.
    #[must_use]
    pub fn after(&self, seconds: f32, acceleration: f32) -> Self {
        let (t, q) = (seconds, acceleration * acceleration);
        Self {
            position: self.position + self.velocity.scaled(t),
            velocity: self.velocity,
            variance: self.variance + t * (2.0 * self.covariance + t * (self.velocity_variance + q * t / 3.0)),
            covariance: self.covariance + t * (self.velocity_variance + q * t / 2.0),
            velocity_variance: self.velocity_variance + q * t,
        }
    }

    /// Motion with a measured position of the given standard deviation, in m.
    #[must_use]
    pub fn measured(&self, position: Point2, deviation: f32) -> Self {
        let sum = self.variance + deviation * deviation;
        if sum <= 0.0 {
            return *self;
        }
        let (gain, velocity_gain) = (self.variance / sum, self.covariance / sum);
        let innovation = position - self.position;
        Self {
            position: self.position + innovation.scaled(gain),
            velocity: self.velocity + innovation.scaled(velocity_gain),
            variance: self.variance * (1.0 - gain),
            covariance: self.covariance * (1.0 - gain),
            velocity_variance: self.velocity_variance - velocity_gain * self.covariance,
        }
    }

    /// Square of the Mahalanobis distance of a measured position, and its probability density, in 1/m².
    pub fn likelihood(&self, position: Point2, deviation: f32) -> (f32, f32) {
        let variance = (self.variance + deviation * deviation).max(f32::MIN_POSITIVE);
        let squared = (position - self.position).norm_squared() / variance;
        (squared, libm::expf(-0.5 * squared) / (TAU * variance))
    }

    /// Standard deviation of the position along an axis, in m.
    pub fn deviation(&self) -> f32 {
        libm::sqrtf(self.variance.max(0.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Random;

    #[test]
    fn a_straight_walk_is_learned() {
        let mut random = Random::new(1);
        let mut motion = Motion::begin(Point2::new(0.0, 0.0), 0.1, 1.5);
        for i in 1..=50 {
            let x = 0.5 * i as f32;
            let seen = Point2::new(x + random.normal(0.1), 2.0 + random.normal(0.1));
            motion = motion.after(0.4, 0.1).measured(seen, 0.1);
        }
        assert!((motion.position - Point2::new(25.0, 2.0)).norm() < 0.15, "{motion:?}");
        assert!((motion.velocity - Point2::new(1.25, 0.0)).norm() < 0.1, "{motion:?}");
        assert!(motion.deviation() < 0.1 && motion.after(2.0, 0.1).deviation() > motion.deviation());
    }

    #[test]
    fn a_weak_measurement_moves_it_less() {
        let motion = Motion::begin(Point2::new(0.0, 0.0), 0.2, 1.0).after(0.5, 0.5);
        let seen = Point2::new(1.0, 0.0);
        assert!(motion.measured(seen, 0.5).position.x < 0.6 * motion.measured(seen, 0.1).position.x);
        let (squared, density) = motion.likelihood(motion.position, 0.1);
        assert!(squared == 0.0 && density > motion.likelihood(seen, 0.1).1);
    }

    #[test]
    fn certainty_does_not_divide_by_zero() {
        let motion = Motion::begin(Point2::new(1.0, 1.0), 0.0, 0.0);
        assert_eq!(motion.measured(Point2::new(3.0, 3.0), 0.0), motion);
        assert!(motion.likelihood(Point2::new(1.0, 1.0), 0.0).1 > 0.0);
    }
}
