use super::VisibilityTable;
use crate::scan::{BeamDirections, Point2, Pose2, Scan};
use core::f32::consts::TAU;

/// Maximum number of beams of a scan that are compared with the map.
pub(super) const MOST_BEAMS: usize = 128;
/// Number of steps of the tabulated density per standard deviation, and in total.
const STEPS: f32 = 16.0;
const DENSITIES: usize = 64;
/// Number of beams that are computed with side by side, in the lanes of vector registers.
const LANES: usize = 8;

/// Density of a measured range given the range in the map (Thrun, Burgard, Fox 2005, 6.3): hits with normally
/// distributed errors, objects in front of the map, and random measurements. Beams without an echo are not used.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BeamModel {
    /// Standard deviation of a hit, in m: of the measurement and of the map.
    pub sigma: f32,
    /// Share of beams that hit the map.
    pub hit: f32,
    /// Share of beams that hit an object which is not on the map. The others are random.
    pub short: f32,
    /// Mean distance of such objects, in m.
    pub short_range: f32,
}

/// Measured beams in the frame of the robot, their origin at the scanner.
#[derive(Debug, Clone, Default)]
struct BeamLanes {
    /// Number of beams; the other lanes are not used.
    count: usize,
    /// Directions, as unit vectors and as angles.
    x: [f32; LANES],
    y: [f32; LANES],
    angle: [f32; LANES],
    range: [f32; LANES],
    /// Density of objects in front of the map.
    short: [f32; LANES],
}

/// Selected beams of a scan, with all that does not depend on the pose.
#[derive(Debug, Clone)]
pub(super) struct Beams {
    lanes: heapless::Vec<BeamLanes, { MOST_BEAMS / LANES }>,
    scanner: Point2,
    /// Density of hits by the magnitude of the error, in steps of σ / 16, and 0 for larger errors.
    hits: [f32; DENSITIES + 1],
    steps_per_metre: f32,
    random: f32,
    sigma: f32,
}

/// Agreement of a scan with the map at one pose: shares of the beams.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Agreement {
    /// Beams that hit the map.
    pub hits: f32,
    /// Beams that pass through a wall of the map.
    pub beyond: f32,
}

impl Beams {
    pub fn new(model: &BeamModel, widened: f32) -> Self {
        let sigma = model.sigma * widened;
        let peak = model.hit / (sigma * TAU.sqrt());
        let density = |step: usize| peak * (-0.5 * (step as f32 / STEPS).powi(2)).exp();
        let hits = core::array::from_fn(|step| if step < DENSITIES { density(step) } else { 0.0 });
        Self {
            lanes: heapless::Vec::new(),
            scanner: Point2::default(),
            hits,
            steps_per_metre: STEPS / sigma,
            random: 0.0,
            sigma,
        }
    }

    /// Takes every n-th measured beam, `count` at most. Scans in a row should begin at different beams.
    pub fn select(
        &mut self,
        model: &BeamModel,
        scan: &Scan,
        directions: &mut BeamDirections,
        mount: &Pose2,
        count: usize,
        turn: usize,
    ) {
        self.scanner = mount.position();
        self.lanes.clear();
        let measured = (0..scan.ranges.len()).filter(|&beam| scan.range(beam).is_some()).count();
        let stride = measured.div_ceil(count.clamp(1, MOST_BEAMS)).max(1);
        // Denser where other beams of the same scan are: the middle of each stride in turn.
        let first = (turn * (stride / 2 + 1)) % stride;
        let mut farthest = 1.0_f32;
        let turned = Pose2 { x: 0.0, y: 0.0, ..*mount }.transform();
        for (beam, point) in directions.points(scan).skip(first).step_by(stride) {
            let range = scan.ranges[beam];
            let angle = mount.theta + scan.angle(beam);
            let at = turned.to_outer(point);
            let short = model.short / model.short_range * (-range / model.short_range).exp();
            farthest = farthest.max(range);
            self.push(at.scaled(1.0 / range), angle, range, short);
        }
        self.random = (1.0 - model.hit - model.short).max(1e-3) / farthest;
    }

    fn push(&mut self, direction: Point2, angle: f32, range: f32, short: f32) {
        if self.lanes.last().is_none_or(|lanes| lanes.count == LANES) {
            // A scan has no more beams than fit: the stride is large enough.
            let _ = self.lanes.push(BeamLanes::default());
        }
        let Some(lanes) = self.lanes.last_mut().filter(|lanes| lanes.count < LANES) else { return };
        let i = lanes.count;
        (lanes.x[i], lanes.y[i], lanes.angle[i]) = (direction.x, direction.y, angle);
        (lanes.range[i], lanes.short[i], lanes.count) = (range, short, i + 1);
    }

    pub fn len(&self) -> usize {
        self.lanes.iter().map(|lanes| lanes.count).sum()
    }

    /// Logarithm of the density of the scan at a pose of the robot.
    #[inline]
    pub fn log_likelihood(&self, table: &VisibilityTable, pose: &Pose2) -> f32 {
        let mut log = 0.0;
        let mut product = 1.0_f64;
        self.compare(table, pose, |lanes, errors| {
            for density in &self.densities(lanes, errors)[..lanes.count] {
                product *= f64::from(*density);
                if product < 1e-200 {
                    log += product.ln();
                    product = 1.0;
                }
            }
        });
        (log + product.ln()) as f32
    }

    /// Densities of beams that differ so much from the map.
    #[inline]
    fn densities(&self, lanes: &BeamLanes, errors: &[f32; LANES]) -> [f32; LANES] {
        core::array::from_fn(|i| {
            let step = errors[i].abs() * self.steps_per_metre;
            let step = if step < DENSITIES as f32 { step as i32 as usize } else { DENSITIES };
            let hit = self.hits.get(step).copied().unwrap_or(0.0);
            let short = if errors[i] < 0.0 { lanes.short[i] } else { 0.0 };
            hit + short + self.random
        })
    }

    pub fn agreement(&self, table: &VisibilityTable, pose: &Pose2) -> Agreement {
        let mut agreement = Agreement::default();
        let share = 1.0 / self.len().max(1) as f32;
        self.compare(table, pose, |lanes, errors| {
            for error in &errors[..lanes.count] {
                if error.abs() <= 3.0 * self.sigma {
                    agreement.hits += share;
                } else if *error > 0.0 {
                    agreement.beyond += share;
                }
            }
        });
        agreement
    }

    /// Calls `each` with all beams and how much farther they reach than in the map, in m.
    // What `each` sums up stays in registers.
    #[inline(always)]
    fn compare(&self, table: &VisibilityTable, pose: &Pose2, mut each: impl FnMut(&BeamLanes, &[f32; LANES])) {
        let (sin, cos) = pose.theta.sin_cos();
        let turn = |p: Point2| Point2::new(cos * p.x - sin * p.y, sin * p.x + cos * p.y);
        let view = table.view(pose.position() + turn(self.scanner));
        for lanes in &self.lanes {
            let mut errors = [f32::NEG_INFINITY; LANES];
            if let Some(view) = view {
                let directions: [Point2; LANES] = core::array::from_fn(|i| turn(Point2::new(lanes.x[i], lanes.y[i])));
                let sectors: [i32; LANES] = core::array::from_fn(|i| view.sector(pose.theta + lanes.angle[i]));
                for i in 0..lanes.count {
                    errors[i] = lanes.range[i] - view.range_in(sectors[i], directions[i]);
                }
            }
            each(lanes, &errors);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::localize::{TableSettings, table::tests::maze};

    const MODEL: BeamModel = BeamModel { sigma: 0.1, hit: 0.6, short: 0.3, short_range: 3.0 };

    /// Density of one beam along the x axis, for a wall at a distance of 10 m.
    fn density(range: f32) -> f32 {
        let table = VisibilityTable::build(&maze(1, 0), TableSettings::default(), |_| ()).expect("a table");
        let mut scan = Scan::default();
        scan.ranges.push(range).expect("room");
        let mut beams = Beams::new(&MODEL, 1.0);
        beams.select(&MODEL, &scan, &mut BeamDirections::default(), &Pose2::default(), 30, 0);
        beams.log_likelihood(&table, &Pose2::new(10.0, 10.2, 0.0)).exp()
    }

    #[test]
    fn the_density_is_that_of_the_mixture() {
        let random = 0.1 / 10.0;
        let hit = |error: f32| 0.6 / (0.1 * TAU.sqrt()) * (-50.0 * error * error).exp();
        let short = |range: f32| 0.1 * (-range / 3.0).exp();
        assert!((density(10.0) - hit(0.0) - random).abs() < 0.05, "{}", density(10.0));
        assert!((density(9.9) / (hit(0.1) + short(9.9) + 0.1 / 9.9) - 1.0).abs() < 0.1, "{}", density(9.9));
        assert!((density(2.0) - short(2.0) - 0.1 / 2.0).abs() < 1e-4, "{}", density(2.0));
        assert!((density(12.0) - 0.1 / 12.0).abs() < 1e-4, "{}", density(12.0));
    }

    #[test]
    fn beams_are_spread_over_the_scan() {
        let mut scan = Scan { angle_min: -2.0, angle_increment: 0.01, ..Scan::default() };
        scan.ranges.extend((0..400).map(|i| if i % 4 == 0 { f32::NAN } else { 2.0 }));
        let mut beams = Beams::new(&MODEL, 1.0);
        for turn in 0..20 {
            for count in [0, 1, 30, 128, 1000] {
                beams.select(&MODEL, &scan, &mut BeamDirections::default(), &Pose2::default(), count, turn);
                let least = if count < 30 { 0 } else { 20 };
                assert!(
                    beams.len() <= count.clamp(1, MOST_BEAMS) && beams.len() >= least,
                    "{} of {count}",
                    beams.len()
                );
            }
            let mean =
                beams.lanes.iter().flat_map(|lanes| &lanes.angle[..lanes.count]).sum::<f32>() / beams.len() as f32;
            assert!(mean.abs() < 0.1, "{mean}");
        }
    }
}
