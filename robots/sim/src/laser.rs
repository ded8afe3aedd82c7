use crate::{Random, World};
use apex_nodes::scan::{MAX_BEAMS, Point2, Pose2, Scan};
use core::f32::consts::{PI, TAU};

/// Simulated plane laser scanner that faces forward.
#[derive(Debug, Clone, PartialEq)]
pub struct Laser {
    /// Angle between the first and the last beam, in rad, centred about the x axis of the scanner.
    pub field_of_view: f32,
    /// Angle between consecutive beams, in rad.
    pub resolution: f32,
    /// Minimum range, in m.
    pub range_min: f32,
    /// Maximum range, in m.
    pub range_max: f32,
    /// Standard deviation of a range, in m.
    pub noise: f32,
    /// Probability that a beam measures nothing.
    pub dropout: f32,
    /// Time of a turn of the mirror, in s, in which the scanner may move on; 0 if all beams measure at once.
    pub turn: f32,
}

/// The safety scanner of the thesis (6.6): an [`S300`](Laser::S300).
impl Default for Laser {
    fn default() -> Self {
        Self::S300
    }
}

impl Laser {
    /// A SICK LMS100: 270° at 0.5°, up to 20 m, with a statistical error of 12 mm.
    pub const LMS100: Self = Self {
        field_of_view: 1.5 * PI,
        resolution: PI / 360.0,
        range_min: 0.05,
        range_max: 20.0,
        noise: 0.012,
        dropout: 0.005,
        turn: 0.0,
    };

    /// A SICK TiM551: 270° at 1°, up to 10 m, with a statistical error of 20 mm.
    pub const TIM551: Self = Self { resolution: PI / 180.0, range_max: 10.0, noise: 0.02, ..Self::LMS100 };

    /// A SICK S300, a safety scanner: 270° at 0.5°, up to 30 m.
    pub const S300: Self = Self { range_max: 30.0, noise: 0.01, ..Self::LMS100 };

    /// Number of beams, at most [`MAX_BEAMS`].
    pub fn beams(&self) -> usize {
        let intervals = libm::roundf(self.field_of_view / self.resolution);
        // A cast of NaN or of a negative number gives 0.
        (intervals as usize).saturating_add(1).min(MAX_BEAMS)
    }

    /// Replaces `scan` by a measurement at `pose`; the stamp is unchanged. A beam without an echo measures infinity.
    pub fn measure(&self, world: &World, pose: &Pose2, random: &mut Random, scan: &mut Scan) {
        self.sweep(world, |_| *pose, random, scan);
    }

    /// As [`measure`](Self::measure) for a scanner that moves while its mirror turns: `pose_at` gives its pose at a
    /// time after the first beam, in s. The scan is bent by the motion. The world stands still.
    pub fn sweep(&self, world: &World, pose_at: impl Fn(f32) -> Pose2, random: &mut Random, scan: &mut Scan) {
        scan.angle_min = -0.5 * self.field_of_view;
        scan.angle_increment = self.resolution;
        scan.range_min = self.range_min;
        scan.range_max = self.range_max;
        scan.time_increment = self.turn * self.resolution / TAU;
        scan.ranges.clear();
        for beam in 0..self.beams() {
            let pose = pose_at(beam as f32 * scan.time_increment);
            let direction = Point2::polar(1.0, pose.theta + scan.angle(beam));
            let range = world.cast(pose.position(), direction).map_or(f32::INFINITY, |r| r + random.normal(self.noise));
            let lost = random.chance(self.dropout) || range > self.range_max;
            let full = scan.ranges.push(if lost { f32::INFINITY } else { range });
            debug_assert!(full.is_ok(), "there are at most as many beams as fit");
        }
    }

    /// Time from the first beam to the last one, in s.
    pub fn sweep_time(&self) -> f32 {
        self.turn * self.resolution / TAU * self.beams().saturating_sub(1) as f32
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn room() -> World {
        let mut world = World::default();
        world.block(&Pose2::default(), 8.0, 8.0);
        world
    }

    #[test]
    fn without_noise_ranges_are_exact() {
        let laser = Laser { noise: 0.0, dropout: 0.0, ..Laser::default() };
        let mut scan = Scan::default();
        laser.measure(&room(), &Pose2::new(1.0, 0.0, 0.5 * PI), &mut Random::new(1), &mut scan);
        assert_eq!(scan.ranges.len(), 541);
        let ahead = scan.beam_towards(0.0).expect("in view");
        let right = scan.beam_towards(-0.5 * PI).expect("in view");
        assert!((scan.ranges[ahead] - 4.0).abs() < 1e-4 && (scan.ranges[right] - 3.0).abs() < 1e-4);
    }

    #[test]
    fn the_same_seed_gives_the_same_scan() {
        let measure = |seed| {
            let mut scan = Scan::default();
            Laser::default().measure(&room(), &Pose2::default(), &mut Random::new(seed), &mut scan);
            scan
        };
        assert_eq!(measure(3), measure(3));
        assert_ne!(measure(3), measure(4));
    }

    #[test]
    fn noise_and_dropouts_are_as_asked_for() {
        let laser = Laser { noise: 0.02, dropout: 0.1, field_of_view: 0.0, ..Laser::default() };
        let (mut random, mut scan) = (Random::new(5), Scan::default());
        let ranges: Vec<f32> = (0..20_000)
            .map(|_| {
                laser.measure(&room(), &Pose2::default(), &mut random, &mut scan);
                scan.ranges[0]
            })
            .collect();
        let measured: Vec<f32> = ranges.iter().copied().filter(|r| r.is_finite()).collect();
        let rate = 1.0 - measured.len() as f32 / ranges.len() as f32;
        let sigma = (measured.iter().map(|r| (r - 4.0).powi(2)).sum::<f32>() / measured.len() as f32).sqrt();
        assert!((rate - 0.1).abs() < 0.01 && (sigma - 0.02).abs() < 0.001, "{rate} {sigma}");
    }

    /// A wall straight ahead, seen while the scanner turns by 0.2 rad: as if it were bent, and turned on average.
    #[test]
    fn a_wall_is_bent_while_the_scanner_turns() {
        let mut world = World::default();
        world.wall(Point2::new(2.0, -20.0), Point2::new(2.0, 20.0));
        let laser = Laser { noise: 0.0, dropout: 0.0, field_of_view: 2.0, turn: 0.1, ..Laser::default() };
        let sweep = laser.sweep_time();
        let points = |turn: f32| {
            let mut scan = Scan::default();
            let pose = |time: f32| Pose2::new(0.0, 0.0, turn * (time / sweep - 1.0));
            laser.sweep(&world, pose, &mut Random::new(1), &mut scan);
            let at = |beam: usize| Point2::polar(scan.ranges[beam], scan.angle(beam));
            [0, scan.ranges.len() / 2, scan.ranges.len() - 1].map(at)
        };
        // Distance of the middle from the line through both ends.
        let sag = |[a, middle, b]: [Point2; 3]| {
            let along = b - a;
            along.perpendicular().dot(middle - a) / along.norm()
        };
        assert!(sag(points(0.0)).abs() < 1e-4);
        assert!(sag(points(0.2)).abs() > 0.05, "{}", sag(points(0.2)));
        let last = points(0.2)[2];
        assert!((last - points(0.0)[2]).norm() < 1e-4, "the last beam is as at the end");
    }

    #[test]
    fn a_wall_is_as_far_as_at_the_time_of_its_beam() {
        let mut world = World::default();
        world.wall(Point2::new(3.0, -20.0), Point2::new(3.0, 20.0));
        let laser = Laser { noise: 0.0, dropout: 0.0, turn: 0.04, ..Laser::default() };
        let mut scan = Scan::default();
        laser.sweep(&world, |time| Pose2::new(time / 0.03 - 1.0, 0.0, 0.0), &mut Random::new(1), &mut scan);
        let ahead = scan.beam_towards(0.0).expect("in view");
        assert!((scan.ranges[ahead] - 3.5).abs() < 1e-4, "half of the way before the end");
        assert!((laser.sweep_time() - 0.03).abs() < 1e-6);
        assert!((scan.time(540).since(scan.stamp).as_secs_f32() - 0.03).abs() < 1e-5);
    }

    #[test]
    fn odd_scanners_do_not_overflow() {
        for resolution in [0.0, -1.0, f32::NAN, 1e-9] {
            let laser = Laser { resolution, ..Laser::default() };
            assert!(laser.beams() <= MAX_BEAMS);
            laser.measure(&World::default(), &Pose2::default(), &mut Random::new(1), &mut Scan::default());
        }
    }

    #[test]
    fn faster_than_real_time() {
        let start = std::time::Instant::now();
        let (mut random, mut scan) = (Random::new(1), Scan::default());
        for _ in 0..100 {
            Laser::default().measure(&room(), &Pose2::default(), &mut random, &mut scan);
        }
        // The real scanner takes 4 s for 100 scans, at 25 Hz.
        assert!(start.elapsed().as_secs_f64() < 4.0);
    }
}
