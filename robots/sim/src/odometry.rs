use crate::Random;
use apex_nodes::{nav::Twist, scan::Pose2};

/// Error model of wheel odometry. Variances grow with distance and rotation, so that the number of steps does not
/// matter (Thrun, Burgard, Fox 2005, 5.4).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OdometryNoise {
    /// Measured distance per metre, in m.
    pub scale: f32,
    /// Error of the heading per metre, in rad.
    pub veer: f32,
    /// Variance along the direction of motion, in m² per m and in m² per rad.
    pub along: [f32; 2],
    /// Variance across the direction of motion, in m² per m and in m² per rad.
    pub across: [f32; 2],
    /// Variance of the heading, in rad² per m and in rad² per rad.
    pub heading: [f32; 2],
}

/// Wheel odometry: a pose that drifts away.
#[derive(Debug, Clone, PartialEq)]
pub struct Odometry {
    noise: OdometryNoise,
    random: Random,
    pose: Pose2,
}

impl OdometryNoise {
    /// Wheels without errors.
    pub const NONE: Self = Self { scale: 1.0, veer: 0.0, along: [0.0; 2], across: [0.0; 2], heading: [0.0; 2] };

    /// Pioneer 2 in an office building. Fitted to the wheel odometry of the Intel Research Lab log (D. Hähnel) by the
    /// example `fit_odometry`, with the 510 reference poses of that log. The model includes the errors of the
    /// references of some centimetres, so that real wheels are slightly better.
    pub const PIONEER: Self = Self {
        scale: 1.037,
        veer: -0.062,
        along: [0.0019, 0.0040],
        across: [0.0011, 0.0019],
        heading: [0.0045, 0.0021],
    };

    /// The same wheels with errors multiplied by `factor`.
    #[must_use]
    pub fn times(&self, factor: f32) -> Self {
        let variances = |of: [f32; 2]| of.map(|variance| variance * factor * factor);
        Self {
            scale: 1.0 + factor * (self.scale - 1.0),
            veer: factor * self.veer,
            along: variances(self.along),
            across: variances(self.across),
            heading: variances(self.heading),
        }
    }
}

impl Odometry {
    /// Starts at the origin of its own frame.
    pub const fn new(noise: OdometryNoise, seed: u64) -> Self {
        Self { noise, random: Random::new(seed), pose: Pose2::new(0.0, 0.0, 0.0) }
    }

    /// Measures wheels that slip while something holds the base: a share of what the motors are told for `dt` s. Values
    /// that are not finite count as 0. Returns the odometry.
    pub fn slip(&mut self, command: &Twist, share: f32, dt: f32) -> Pose2 {
        let part = |value: f32| if value.is_finite() { value * share * dt } else { 0.0 };
        let wheels = Pose2::new(part(command.x), part(command.y), part(command.omega));
        self.measure(&Pose2::default(), &wheels)
    }

    /// Measures a movement of the base from one pose of the world to another, with a rotation of less than half a turn.
    /// Returns the odometry.
    pub fn measure(&mut self, from: &Pose2, to: &Pose2) -> Pose2 {
        let Self { noise, random, .. } = self;
        let step = to.relative_to(from);
        let (way, turn) = (step.position().norm(), step.theta.abs());
        let mut error = |[by_way, by_turn]: [f32; 2]| random.normal(libm::sqrtf(by_way * way + by_turn * turn));
        let (along, across, heading) = (error(noise.along), error(noise.across), error(noise.heading));
        // Along the direction of motion, which need not be the x axis.
        let (sin, cos) = if way > 0.0 { (step.y / way, step.x / way) } else { (0.0, 1.0) };
        let measured = Pose2 {
            x: noise.scale * step.x + cos * along - sin * across,
            y: noise.scale * step.y + sin * along + cos * across,
            theta: step.theta + noise.veer * way + heading,
        };
        self.pose = self.pose.compose(&measured);
        self.pose
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wheels_that_slip_measure_a_share_of_the_command() {
        let mut odometry = Odometry::new(OdometryNoise::NONE, 1);
        for _ in 0..50 {
            odometry.slip(&Twist::new(0.4, 0.0, 0.0), 0.5, 0.02);
        }
        let pose = odometry.slip(&Twist::new(f32::NAN, 0.0, 0.2), 0.5, 1.0);
        assert!((pose.x - 0.2).abs() < 1e-5 && (pose.theta - 0.1).abs() < 1e-5, "{pose:?}");
        assert_eq!(odometry.slip(&Twist::new(1.0, 0.0, 1.0), 0.0, 1.0), pose, "without slip");
    }

    #[test]
    fn without_noise_it_is_exact() {
        let mut odometry = Odometry::new(OdometryNoise::NONE, 1);
        let way = [Pose2::new(3.0, 2.0, 1.0), Pose2::new(3.5, 2.0, 1.5), Pose2::new(3.0, 3.0, -3.0)];
        let last = way.windows(2).map(|w| odometry.measure(&w[0], &w[1])).last().expect("two steps");
        let true_way = way[2].relative_to(&way[0]);
        assert!((last.position() - true_way.position()).norm() < 1e-5 && (last.theta - true_way.theta).abs() < 1e-5);
    }

    /// Errors after one metre in this number of steps: mean and variance of x and of the heading.
    fn after_a_metre(steps: u16) -> [(f32, f32); 2] {
        let ends: Vec<Pose2> = (0..4000)
            .map(|seed| {
                let noise = OdometryNoise { veer: 0.0, ..OdometryNoise::PIONEER };
                let mut odometry = Odometry::new(noise, seed);
                let at = |step: u16| Pose2::new(f32::from(step) / f32::from(steps), 0.0, 0.0);
                (0..steps).map(|step| odometry.measure(&at(step), &at(step + 1))).last().expect("a step")
            })
            .collect();
        [|p: &Pose2| p.x - 1.0, |p: &Pose2| p.theta].map(|of| {
            let mean = ends.iter().map(of).sum::<f32>() / ends.len() as f32;
            (mean, ends.iter().map(|p| (of(p) - mean).powi(2)).sum::<f32>() / ends.len() as f32)
        })
    }

    #[test]
    fn the_error_of_a_metre_does_not_depend_on_the_steps() {
        for steps in [1, 50] {
            let [(x, x_variance), (theta, theta_variance)] = after_a_metre(steps);
            assert!((x - 0.036).abs() < 0.006 && theta.abs() < 0.006, "{steps} steps: {x} {theta}");
            assert!((x_variance / 0.0019 - 1.0).abs() < 0.15, "{steps} steps: {x_variance}");
            assert!((theta_variance / 0.0045 - 1.0).abs() < 0.1, "{steps} steps: {theta_variance}");
        }
    }

    #[test]
    fn errors_can_be_scaled() {
        assert_eq!(OdometryNoise::PIONEER.times(0.0), OdometryNoise::NONE);
        assert_eq!(OdometryNoise::PIONEER.times(2.0).veer, 2.0 * OdometryNoise::PIONEER.veer);
        assert_eq!(OdometryNoise::PIONEER.times(2.0).along[0], 4.0 * OdometryNoise::PIONEER.along[0]);
    }

    #[test]
    fn what_stands_still_does_not_drift() {
        let mut odometry = Odometry::new(OdometryNoise::PIONEER, 3);
        let pose = Pose2::new(1.0, 2.0, 3.0);
        assert!((0..100).all(|_| odometry.measure(&pose, &pose) == Pose2::default()));
    }
}
