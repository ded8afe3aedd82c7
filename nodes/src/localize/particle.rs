use crate::{math::Random, scan::Pose2};

/// Hypothesis of the pose of the robot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Particle {
    pub pose: Pose2,
    /// Weight, or its logarithm before it is normalized.
    pub weight: f32,
}

/// Replaces logarithms of weights by weights with the sum 1. Returns the largest logarithm.
pub(super) fn normalize(particles: &mut [Particle]) -> f32 {
    let highest = particles.iter().map(|p| p.weight).fold(f32::MIN, f32::max);
    particles.iter_mut().for_each(|p| p.weight = (p.weight - highest).exp());
    let sum: f32 = particles.iter().map(|p| p.weight).sum();
    particles.iter_mut().for_each(|p| p.weight /= sum);
    highest
}

/// Writes the sum of the weights up to each particle.
pub(super) fn cumulate(particles: &[Particle], sums: &mut Vec<f32>) {
    let mut sum = 0.0;
    sums.clear();
    sums.extend(particles.iter().map(|p| {
        sum += p.weight;
        sum
    }));
}

/// Random particle, drawn by weight. `sums` are those of [`cumulate`].
pub(super) fn drawn(particles: &[Particle], sums: &[f32], random: &mut Random) -> Particle {
    let at = random.uniform(0.0, sums.last().copied().unwrap_or(0.0));
    let index = sums.partition_point(|sum| *sum <= at).min(particles.len().saturating_sub(1));
    particles.get(index).copied().unwrap_or(Particle { pose: Pose2::default(), weight: 0.0 })
}
