use super::{bins::Bins, particle::Particle};
use crate::scan::{Point2, Pose2, UncertainPose, wrap_angle};

/// Radius of a cluster of particles, in m and rad.
const RADIUS: f32 = 1.0;
const ANGLE: f32 = 0.6;

/// Agreement of an estimated pose with the particles and with the last scan.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct PoseFit {
    /// Weight of the cluster among all particles, from 0 to 1.
    pub share: f32,
    /// Share of the beams that agree with the map at the pose.
    pub hits: f32,
    /// Share of the beams that pass through walls of the map at the pose.
    pub beyond: f32,
    /// Number of particles.
    pub particles: u32,
}

/// Particles that are near to one another.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Cluster {
    /// Their mean and covariance.
    pub estimate: UncertainPose,
    /// Their weight among all particles, from 0 to 1.
    pub share: f32,
}

impl Cluster {
    /// The heaviest one of particles whose weights have the sum 1.
    pub fn heaviest(particles: &[Particle], bins: &mut Bins) -> Self {
        bins.clear();
        let mut heaviest = (0.0, Pose2::default());
        for particle in particles {
            let weight = bins.add(particle, particle.weight);
            if weight > heaviest.0 {
                heaviest = (weight, particle.pose);
            }
        }
        let estimate = UncertainPose { pose: heaviest.1, ..UncertainPose::default() };
        let mut cluster = Self { estimate, share: 0.0 };
        for _ in 0..3 {
            cluster.recentre(particles);
        }
        cluster
    }

    /// Moves the pose to the mean of the particles around it.
    fn recentre(&mut self, particles: &[Particle]) {
        let middle = self.estimate.pose;
        let near = |p: &&Particle| {
            let offset = p.pose.position() - middle.position();
            offset.norm_squared() < RADIUS * RADIUS && turn(p, &middle).abs() < ANGLE
        };
        let (mut sum, mut mean) = (0.0, [0.0; 3]);
        let mut squares = [[0.0; 3]; 3];
        for particle in particles.iter().filter(near) {
            let Point2 { x, y } = particle.pose.position() - middle.position();
            let offset = [x, y, turn(particle, &middle)];
            sum += particle.weight;
            for i in 0..3 {
                mean[i] += particle.weight * offset[i];
                for j in 0..3 {
                    squares[i][j] += particle.weight * offset[i] * offset[j];
                }
            }
        }
        if sum <= 0.0 {
            return;
        }
        mean = mean.map(|value| value / sum);
        let covariance = core::array::from_fn(|i| core::array::from_fn(|j| squares[i][j] / sum - mean[i] * mean[j]));
        let pose = Pose2::new(middle.x + mean[0], middle.y + mean[1], wrap_angle(middle.theta + mean[2]));
        *self = Self { estimate: UncertainPose { pose, covariance }, share: sum.min(1.0) };
    }
}

/// Difference of headings in [−π, π] rad.
fn turn(particle: &Particle, pose: &Pose2) -> f32 {
    wrap_angle(particle.pose.theta - pose.theta)
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f32::consts::PI;

    #[test]
    fn the_heaviest_cluster_counts() {
        let mut particles = vec![];
        for i in 0..100 {
            let side = if i % 2 == 0 { 0.1 } else { -0.1 };
            // The heading is at the seam.
            let theta = if i % 2 == 0 { PI - 0.05 } else { 0.05 - PI };
            particles.push(Particle { pose: Pose2::new(3.0 + side, 1.0, theta), weight: 0.007 });
            particles.push(Particle { pose: Pose2::new(9.0, 5.0, 0.0), weight: 0.003 });
        }
        let Cluster { estimate, share } = Cluster::heaviest(&particles, &mut Bins::new(200));
        assert!((estimate.pose.x - 3.0).abs() < 1e-3 && (estimate.pose.theta.abs() - PI).abs() < 1e-3, "{estimate:?}");
        assert!((share - 0.7).abs() < 1e-3 && (estimate.deviation() - 0.1).abs() < 1e-3, "{share} {estimate:?}");
        assert!((estimate.covariance[2][2] - 0.0025).abs() < 1e-4, "{estimate:?}");
        assert_eq!(Cluster::heaviest(&[], &mut Bins::new(4)), Cluster::default());
    }
}
