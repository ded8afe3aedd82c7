use super::particle::Particle;
use core::f32::consts::PI;

/// Sizes of a bin in m and rad.
const LENGTH: f32 = 0.5;
const ANGLE: f32 = PI / 18.0;

/// Histogram of particles with a fixed number of places: open addressing with linear probing.
#[derive(Debug, Clone, Default)]
pub(super) struct Bins {
    places: Vec<Place>,
    /// Number of the current histogram. Places with another one are empty.
    current: u32,
    count: usize,
}

#[derive(Debug, Clone, Copy, Default)]
struct Place {
    histogram: u32,
    key: [i32; 3],
    weight: f32,
}

impl Bins {
    /// Creates a histogram of up to `capacity` particles.
    pub fn new(capacity: usize) -> Self {
        Self { places: vec![Place::default(); (2 * capacity).next_power_of_two()], current: 1, count: 0 }
    }

    pub fn clear(&mut self) {
        self.count = 0;
        self.current = self.current.wrapping_add(1);
        if self.current == 0 {
            self.places.fill(Place::default());
            self.current = 1;
        }
    }

    /// Number of bins that are not empty.
    pub const fn len(&self) -> usize {
        self.count
    }

    /// Adds a particle with a weight and returns the weight of its bin.
    pub fn add(&mut self, particle: &Particle, weight: f32) -> f32 {
        let pose = &particle.pose;
        let key = [pose.x / LENGTH, pose.y / LENGTH, pose.theta / ANGLE].map(floor);
        let mixed = key.iter().fold(0_u64, |hash, &value| {
            (hash ^ u64::from(value as u32)).wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(29)
        });
        let mask = self.places.len() - 1;
        let mut at = mixed as usize & mask;
        for _ in 0..=mask {
            let place = &mut self.places[at];
            if place.histogram != self.current {
                *place = Place { histogram: self.current, key, weight };
                self.count += 1;
                return weight;
            }
            if place.key == key {
                place.weight += weight;
                return place.weight;
            }
            at = (at + 1) & mask;
        }
        weight
    }
}

/// Largest whole number that is not above a value, without a call of a library.
fn floor(value: f32) -> i32 {
    let whole = value as i32;
    if value < whole as f32 { whole.saturating_sub(1) } else { whole }
}

/// Number of particles for `bins` bins that are not empty, so that with probability 0.99 the divergence of the sampled
/// from the true distribution is below `error` (Fox 2003, equation 7).
pub(super) fn enough_particles(bins: usize, error: f32) -> usize {
    /// Quantile of the standard normal distribution at 0.99.
    const QUANTILE: f32 = 2.326;
    if bins < 2 {
        return 1;
    }
    let k = bins as f32 - 1.0;
    let ninth = 2.0 / (9.0 * k);
    (k / (2.0 * error) * (1.0 - ninth + ninth.sqrt() * QUANTILE).powi(3)).ceil() as usize
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scan::Pose2;

    #[test]
    fn particles_are_counted_by_bin() {
        let mut bins = Bins::new(8);
        let at = |x: f32, theta: f32| Particle { pose: Pose2::new(x, 0.1, theta), weight: 0.0 };
        for _ in 0..3 {
            bins.clear();
            assert_eq!(bins.add(&at(0.1, 0.0), 0.5), 0.5);
            assert_eq!(bins.add(&at(0.2, 0.1), 0.25), 0.75);
            assert_eq!(bins.add(&at(-0.1, 0.0), 0.25), 0.25);
            assert_eq!(bins.add(&at(0.1, -0.1), 0.25), 0.25);
            assert_eq!(bins.len(), 3);
        }
        for i in 0..100 {
            bins.add(&at(i as f32, 0.0), 1.0);
        }
        assert!(bins.len() <= 16, "a full histogram drops bins");
    }

    #[test]
    fn the_number_of_particles_is_that_of_fox() {
        assert_eq!([0, 1].map(|bins| enough_particles(bins, 0.05)), [1, 1]);
        // χ² quantiles at 0.99 with 1, 10 and 100 degrees of freedom are 6.63, 23.21 and 135.8.
        for (bins, chi) in [(2, 6.63), (11, 23.21), (101, 135.8)] {
            let exact = chi / (2.0 * 0.05);
            let particles = enough_particles(bins, 0.05) as f32;
            assert!((particles / exact - 1.0).abs() < 0.03, "{particles} for {exact}");
        }
    }
}
