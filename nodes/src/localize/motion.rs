use crate::{math::Random, scan::Pose2};

/// Errors of odometry: variances grow with distance and rotation, so that the number of steps does not matter (Thrun,
/// Burgard, Fox 2005, 5.4).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MotionNoise {
    /// Standard deviation of the position after 1 m, in m.
    pub slip: f32,
    /// Standard deviation of the heading after 1 m, in rad.
    pub veer: f32,
    /// Standard deviation of the heading after a turn of 1 rad, in rad.
    pub skid: f32,
}

impl MotionNoise {
    /// Moves a pose by `step` and a random error.
    #[must_use]
    pub fn moved(&self, pose: &Pose2, step: &Pose2, random: &mut Random) -> Pose2 {
        let (way, turn) = (step.position().norm(), step.theta.abs());
        // Half a turn moves the position as far as 1 m, because the robot does not turn about its origin exactly.
        let slip = self.slip * (way + 0.3 * turn).sqrt();
        let heading = (self.veer * self.veer * way + self.skid * self.skid * turn).sqrt();
        let error = Pose2::new(random.normal(slip), random.normal(slip), random.normal(heading));
        pose.compose(&Pose2 { x: step.x + error.x, y: step.y + error.y, theta: step.theta + error.theta })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_do_not_depend_on_the_number_of_steps() {
        let noise = MotionNoise { slip: 0.1, veer: 0.1, skid: 0.1 };
        let mut random = Random::new(1);
        let mut spread = |steps: usize| {
            let step = Pose2::new(1.0 / steps as f32, 0.0, 0.0);
            let ends: Vec<Pose2> = (0..4000)
                .map(|_| (0..steps).fold(Pose2::default(), |pose, _| noise.moved(&pose, &step, &mut random)))
                .collect();
            let mean = |of: fn(&Pose2) -> f32| ends.iter().map(of).sum::<f32>() / ends.len() as f32;
            (mean(|p| p.x), mean(|p| (p.x - 1.0).powi(2)).sqrt(), mean(|p| p.theta.powi(2)).sqrt())
        };
        for steps in [1, 10] {
            let (x, slip, veer) = spread(steps);
            assert!(
                (x - 1.0).abs() < 0.01 && (slip - 0.1).abs() < 0.01 && (veer - 0.1).abs() < 0.01,
                "{x} {slip} {veer}"
            );
        }
        assert_eq!(noise.moved(&Pose2::new(1.0, 2.0, 0.5), &Pose2::default(), &mut random), Pose2::new(1.0, 2.0, 0.5));
    }
}
