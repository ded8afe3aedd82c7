use super::{VisibilityTable, particle::Particle};
use crate::{
    math::Random,
    scan::{Point2, Pose2, Scan},
};
use core::f32::consts::{PI, TAU};

/// Number of headings that are compared at a position.
const HEADINGS: usize = 72;
const STEP: f32 = TAU / HEADINGS as f32;
/// Steps of the tabulated score per m, and their number on each side of a hit.
const SCORES_PER_METRE: f32 = 20.0;
const SCORES: i32 = 40;

/// Settings of the search for the pose of the robot on the whole map.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SearchSettings {
    /// Standard deviation of a hit, in m: also of the distance to the nearest position that is tried.
    pub sigma: f32,
    /// Weight of the scan: 1 if the errors of its beams were independent.
    pub trust: f32,
}

/// Search for the pose of the robot on the whole map by one scan. At a position, the ranges of the map in all
/// directions are looked up once and compared with the scan at all headings.
#[derive(Debug, Clone)]
pub(super) struct Search {
    settings: SearchSettings,
    /// Direction and range of beams in multiples of the step of headings.
    beams: heapless::Vec<(usize, f32), HEADINGS>,
    directions: [(Point2, f32); HEADINGS],
    /// Logarithm of the density by the error, from the largest negative one on.
    scores: [f32; 2 * SCORES as usize + 1],
    scanner: Pose2,
}

impl Search {
    pub fn new(settings: SearchSettings) -> Self {
        let score = |i: usize| {
            let error = (i as i32 - SCORES) as f32 / SCORES_PER_METRE / settings.sigma;
            // A beam that ends in front of the map has hit an object; one that passes through a wall is worse.
            let other = if error < 0.0 { 0.1 } else { 0.03 };
            ((-0.5 * error * error).exp() + other).ln()
        };
        let direction = |i: usize| (Point2::polar(1.0, i as f32 * STEP), i as f32 * STEP);
        Self {
            settings,
            beams: heapless::Vec::new(),
            directions: core::array::from_fn(direction),
            scores: core::array::from_fn(score),
            scanner: Pose2::default(),
        }
    }

    /// Takes the beams of a scan whose directions are multiples of the step.
    pub fn select(&mut self, scan: &Scan, mount: &Pose2) {
        self.scanner = Pose2::default().relative_to(mount);
        self.beams.clear();
        for direction in 0..HEADINGS {
            let angle = direction as f32 * STEP;
            if let Some(range) = scan.beam_towards(angle).and_then(|beam| scan.range(beam)) {
                let _ = self.beams.push((direction, range));
            }
        }
    }

    /// Random pose of the robot inside of the building with a heading drawn by the agreement with the scan. Its weight
    /// is the logarithm of the mean density over all headings. Returns `None` if the map has no inside.
    pub fn draw(&self, table: &VisibilityTable, random: &mut Random) -> Option<Particle> {
        let cells = table.inside().len() as u64;
        let corner = table.inside_at((random.bits() % cells.max(1)) as usize)?;
        let cell = table.settings().cell;
        let at = corner + Point2::new(random.uniform(0.0, cell), random.uniform(0.0, cell));
        let view = table.view(at)?;
        let ranges = self.directions.map(|(direction, angle)| view.range(direction, angle));
        let mut weights = core::array::from_fn::<f32, HEADINGS, _>(|heading| self.score(&ranges, heading));
        let best = weights.iter().copied().fold(f32::MIN, f32::max);
        weights.iter_mut().for_each(|weight| *weight = (*weight - best).exp());
        let sum: f32 = weights.iter().sum();
        let mut left = random.uniform(0.0, sum);
        let drawn = weights.iter().position(|weight| {
            left -= weight;
            left < 0.0
        });
        let theta = drawn.unwrap_or(0) as f32 * STEP + random.uniform(-0.5, 0.5) * STEP;
        let scanner = Pose2::new(at.x, at.y, if theta > PI { theta - TAU } else { theta });
        Some(Particle { pose: scanner.compose(&self.scanner), weight: best + sum.ln() })
    }

    /// Logarithm of the density of the scan at a heading.
    fn score(&self, ranges: &[f32; HEADINGS], heading: usize) -> f32 {
        let sum: f32 = self
            .beams
            .iter()
            .map(|&(direction, range)| {
                let expected = ranges[(heading + direction) % HEADINGS];
                let step = ((range - expected) * SCORES_PER_METRE).clamp(-(SCORES as f32), SCORES as f32);
                self.scores[(step as i32 + SCORES) as usize]
            })
            .sum();
        self.settings.trust * sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::localize::{TableSettings, table::tests::maze};

    #[test]
    fn the_best_of_many_poses_is_near_the_true_one() {
        let table = VisibilityTable::build(&maze(5, 12), TableSettings::default(), |_| ()).expect("a table");
        let (robot, mount) = (Pose2::new(14.0, 6.0, 1.0), Pose2::new(0.4, 0.2, 0.3));
        let scanner = robot.compose(&mount);
        let mut scan = Scan { angle_min: -2.35, angle_increment: 4.7 / 270.0, ..Scan::default() };
        scan.ranges.extend((0..271).map(|beam| {
            let angle = scanner.theta + scan.angle_min + beam as f32 * scan.angle_increment;
            table.view(scanner.position()).map_or(f32::NAN, |view| view.range(Point2::polar(1.0, angle), angle))
        }));
        let mut search = Search::new(SearchSettings { sigma: 0.3, trust: 1.0 });
        search.select(&scan, &mount);
        let mut random = Random::new(1);
        let found =
            (0..5000).filter_map(|_| search.draw(&table, &mut random)).max_by(|a, b| a.weight.total_cmp(&b.weight));
        let error = found.expect("a pose").pose.relative_to(&robot);
        assert!(error.position().norm() < 0.4 && error.theta.abs() < 0.15, "{error:?}");
    }
}
