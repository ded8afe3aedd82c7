use crate::{
    perception::Perceive,
    world::{Options, State},
};
use apex_nodes::{
    cloud::{Label, RingCloud},
    frames::{Pose3, Rotation},
    scan::{Point2, Pose2},
};
use apex_rt::Time;
use apex_sim::{
    Limits, Random,
    outdoor::{RingScanner, Sample, SkidBase, SkidShape, Surface, Walker},
};
use std::{
    fmt,
    time::{Duration, Instant},
};

/// Number of turns on a track, and distance between them, in m.
const TURNS: usize = 60;
const APART: f32 = 20.0;
/// Speed of the robot, in m/s, and greatest errors of its inclination, in rad.
const SPEED: f32 = 2.2;
const TILT_NOISE: f32 = 0.004;

/// Points by what they are and what they were taken for, and the computing time of perception.
#[derive(Debug, Clone, Default)]
pub struct Accuracy {
    /// Seed of the country.
    pub seed: u64,
    /// Counts by surface, in the order of [`SURFACES`]: taken for ground, for an obstacle, for a ditch.
    counts: [[u64; 3]; SURFACES.len()],
    /// Computing times of the turns.
    times: Vec<Duration>,
}

/// Surfaces that are counted, with their names.
const SURFACES: [(Surface, &str); 7] = [
    (Surface::Ground, "ground"),
    (Surface::Grass, "grass"),
    (Surface::Ditch, "ditch"),
    (Surface::Rock, "rock"),
    (Surface::Trunk, "trunk"),
    (Surface::Leaves, "leaves"),
    (Surface::Person, "person"),
];

/// Measures the detection of obstacles on the terrain of a seed, on turns along the track, and its computing time.
pub fn accuracy(seed: u64) -> Accuracy {
    let state = State::new(&Options { seed, ..Options::default() });
    let (terrain, track) = (&state.terrain, &state.track);
    let mut random = state.stream(20);
    let mut scanner = RingScanner::default();
    let (mut turn, mut truth) = (RingCloud::default(), vec![]);
    let mut result = Accuracy { seed, ..Accuracy::default() };
    let mut program = Box::new(Perceive::new());
    let mut now = Time::from_secs(1);
    for number in 0..TURNS {
        let s = 10.0 + APART * number as f32;
        let limits = Limits { speed: 3.0, acceleration: 3.0, turn: 3.0, turn_acceleration: 3.0 };
        // Poses of the robot during the turn.
        let samples: Vec<Sample> = (0..=10)
            .map(|i| {
                let along = s + 0.01 * SPEED * i as f32;
                let (here, ahead) = (track.way(along), track.way(along + 0.5));
                let pose = Pose2::new(here.x, here.y, (ahead - here).angle());
                Sample { pose, attitude: SkidBase::new(pose, limits, SkidShape::SUMMIT, terrain).attitude }
            })
            .collect();
        let runner = track.way(s + 4.0 + random.uniform(0.0, 6.0));
        let people = [Walker { position: runner, velocity: Point2::default() }];
        for sample in [samples[0], samples[5]] {
            put_pose(&mut program, &sample, &mut random);
            let _ = program.inputs().turn.put(RingCloud::default());
            program.react(now);
            now += Duration::from_millis(50);
        }
        scanner.measure(terrain, &samples, &people, now, &mut random, &mut turn, &mut truth);
        put_pose(&mut program, &samples[10], &mut random);
        let _ = program.inputs().turn.put(turn.clone());
        let began = Instant::now();
        program.react(now);
        result.times.push(began.elapsed());
        if let Some(labels) = &program.outputs().labels {
            for (surface, label) in truth.iter().zip(&labels.labels) {
                result.count(*surface, *label);
            }
        }
        // The next turn is elsewhere.
        *program = Perceive::new();
        now += Duration::from_millis(100);
    }
    result
}

/// Pose of odometry, whose origin is that of the world.
fn put_pose(program: &mut Perceive, sample: &Sample, random: &mut Random) {
    let [roll, pitch] =
        [sample.attitude.roll, sample.attitude.pitch].map(|angle| f64::from(angle + random.normal(TILT_NOISE)));
    let Pose2 { x, y, theta } = sample.pose;
    let rotation = Rotation::from_rpy(roll, pitch, f64::from(theta));
    let _ = program.inputs().odometry.put(Pose3::new([f64::from(x), f64::from(y), 0.0], rotation));
}

impl Accuracy {
    fn count(&mut self, surface: Surface, label: Label) {
        let Some(row) = SURFACES.iter().position(|(known, _)| *known == surface) else { return };
        let column = match label {
            Label::Floor => 0,
            Label::Obstacle | Label::Overhanging => 1,
            Label::Below => 2,
            _ => return,
        };
        self.counts[row][column] += 1;
    }

    /// Number of points of these surfaces that were taken for ground (0), for an obstacle (1), or for a ditch (2).
    fn sum(&self, is: fn(Surface) -> bool, column: usize) -> f64 {
        let rows = SURFACES.iter().zip(&self.counts).filter(|((surface, _), _)| is(*surface));
        rows.map(|(_, counts)| counts[column] as f64).sum()
    }

    /// Precision and recall of the ground, and of obstacles. Points in ditches count for neither.
    pub fn rates(&self) -> [f64; 4] {
        let ground = |column| self.sum(Surface::is_drivable, column);
        let obstacles = |column| self.sum(Surface::is_obstacle, column);
        let part = |right: f64, wrong: f64| right / (right + wrong).max(1.0);
        [
            part(ground(0), obstacles(0)),
            part(ground(0), ground(1) + ground(2)),
            part(obstacles(1), ground(1)),
            part(obstacles(1), obstacles(0) + obstacles(2)),
        ]
    }

    /// Median and largest computing time of a turn.
    pub fn times(&self) -> [Duration; 2] {
        let mut sorted = self.times.clone();
        sorted.sort_unstable();
        let at = |i: usize| sorted.get(i).copied().unwrap_or_default();
        [at(sorted.len() / 2), at(sorted.len().saturating_sub(1))]
    }

    /// Adds the counts and times of another country.
    pub fn add(&mut self, other: &Self) {
        for (sums, counts) in self.counts.iter_mut().zip(&other.counts) {
            for (sum, count) in sums.iter_mut().zip(counts) {
                *sum += count;
            }
        }
        self.times.extend_from_slice(&other.times);
    }

    /// Table of the points by what they are, and what they were taken for.
    pub fn table(&self) -> String {
        let mut text = format!("{:<10}{:>12}{:>10}{:>10}{:>8}\n", "what", "points", "ground", "obstacle", "ditch");
        for ((_, name), counts) in SURFACES.iter().zip(&self.counts) {
            let whole = counts.iter().sum::<u64>();
            let [ground, obstacle, ditch] = counts.map(|count| 100.0 * count as f64 / whole.max(1) as f64);
            text += &format!("{name:<10}{whole:>12}{ground:>8.1} %{obstacle:>8.1} %{ditch:>6.1} %\n");
        }
        text
    }
}

/// Precision and recall, in one line.
impl fmt::Display for Accuracy {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let rates = self.rates().map(|rate| 100.0 * rate);
        let [median, most] = self.times().map(|time| 1e3 * time.as_secs_f64());
        write!(f, "{:>6}", self.seed)?;
        rates.iter().try_for_each(|rate| write!(f, "{rate:>10.2} %"))?;
        write!(f, "{median:>9.2} ms{most:>9.2} ms")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rates_are_those_of_the_counts() {
        let mut accuracy = Accuracy::default();
        let labels = [
            (Surface::Ground, Label::Floor, 8),
            (Surface::Grass, Label::Obstacle, 2),
            (Surface::Rock, Label::Floor, 1),
        ];
        for (surface, label, count) in labels {
            (0..count).for_each(|_| accuracy.count(surface, label));
        }
        (0..3).for_each(|_| accuracy.count(Surface::Person, Label::Obstacle));
        let rates = accuracy.rates();
        assert_eq!(rates, [8.0 / 9.0, 0.8, 0.6, 0.75]);
    }
}
