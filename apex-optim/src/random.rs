use core::f64::consts::TAU;

/// Stream of pseudo-random numbers (SplitMix64; Steele, Lea, Flood 2014). Not for cryptography.
///
/// Implemented here, so that the stream of a seed never changes with the version of a library or with the platform.
#[derive(Debug, Clone, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Random {
    state: u64,
}

impl Random {
    /// Creates the stream of a seed.
    pub const fn new(seed: u64) -> Self {
        Self { state: seed }
    }

    /// Next 64 random bits.
    pub const fn bits(&mut self) -> u64 {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Random number, uniform in [0, 1).
    pub fn unit(&mut self) -> f64 {
        // The upper 53 bits: the precision of an `f64`.
        (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Random number, uniform in [`low`, `high`).
    pub fn uniform(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * self.unit() as f32
    }

    /// Random number, normally distributed with mean 0 and the given standard deviation.
    pub fn normal(&mut self, sigma: f32) -> f32 {
        sigma * self.standard_normal() as f32
    }

    /// Random number in double precision, normally distributed with mean 0 and standard deviation 1 (Box and Muller
    /// 1958).
    pub fn standard_normal(&mut self) -> f64 {
        // 1 − u is in (0, 1], so that its logarithm is finite.
        let radius = libm::sqrt(-2.0 * libm::log(1.0 - self.unit()));
        radius * libm::cos(TAU * self.unit())
    }

    /// Random whole number below `end`, which is not 0.
    pub const fn below(&mut self, end: u64) -> u64 {
        self.bits() % end
    }

    /// Returns `true` with the given probability.
    pub fn chance(&mut self, probability: f32) -> bool {
        self.unit() < f64::from(probability)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::vec::Vec;

    #[test]
    fn the_stream_is_the_published_one() {
        // First outputs for seed 0 of the reference implementation.
        let mut random = Random::new(0);
        assert_eq!([random.bits(), random.bits()], [0xe220_a839_7b1d_cdaf, 0x6e78_9e6a_a1b9_65f4]);
    }

    #[test]
    fn moments_are_right() {
        let mut random = Random::new(7);
        let n = 100_000;
        let normal: Vec<f64> = (0..n).map(|_| f64::from(random.normal(2.0))).collect();
        let mean = normal.iter().sum::<f64>() / f64::from(n);
        let variance = normal.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / f64::from(n);
        assert!(mean.abs() < 0.03 && (variance - 4.0).abs() < 0.08, "{mean} {variance}");
        let hits = (0..n).filter(|_| random.chance(0.25)).count();
        assert!((hits as f64 / f64::from(n) - 0.25).abs() < 0.01);
        assert!((0..n).all(|_| (-1.0..3.0).contains(&random.uniform(-1.0, 3.0))));
        assert!((0..n).all(|_| random.below(3) < 3));
    }
}
