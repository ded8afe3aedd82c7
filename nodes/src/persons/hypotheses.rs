use super::{
    Detections, MAX_DETECTIONS, MAX_PERSONS, Motion, Person, Persons,
    choice::Choice,
    leaf::{Leaf, MAX_DEPTH, MAX_HYPOTHESES},
};
use apex_rt::Time;
use heapless::Vec;

/// Maximum number of hypotheses about one person.
pub const MAX_BRANCHES: usize = 16;

/// Hypotheses of a score below this are dropped: about two missed detections after a first one.
const MIN_SCORE: f32 = -7.0;

/// Hypotheses of persons that are less probably present are dropped.
const MIN_PRESENCE: f32 = 0.01;

/// Errors and detection rate of a sensor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sensor {
    /// Standard deviation of detected positions along each axis, in m.
    pub deviation: f32,
    /// Probability that a person in view is detected, from 0 to 1.
    pub rate: f32,
    /// Density of false detections in a measurement, in 1/m².
    pub clutter: f32,
}

/// Behaviour of persons, and the limits of the hypothesis trees.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Model {
    /// Density of the white noise of accelerations, in m/s^1.5.
    pub acceleration: f32,
    /// Standard deviation of the velocity of a new person along each axis, in m/s.
    pub speed: f32,
    /// Density of new persons in a measurement, in 1/m².
    pub births: f32,
    /// Mean time until a person leaves, in s.
    pub stay: f32,
    /// Time after the last detection at which a person is forgotten, in s.
    pub forget: f32,
    /// Maximum Mahalanobis distance of a detection from its person.
    pub gate: f32,
    /// Maximum difference of the score from the best hypothesis about the same person. The best hypothesis for each
    /// assignment of the newest measurement is kept in any case.
    pub margin: f32,
    /// Number of hypotheses kept about one person, up to [`MAX_BRANCHES`].
    pub branches: usize,
    /// Number of measurements after which an assignment is final, up to [`MAX_DEPTH`].
    pub depth: usize,
}

/// Tracks of persons by many hypotheses (Reid 1979): for each person a tree, whose leaves are Kalman filters that
/// differ in the detections assigned to them (Kurien 1990).
///
/// Of all sets of leaves in which no detection is used twice, the best one is chosen. An assignment of `depth`
/// measurements ago is then final. Trees are pruned by score and by number; nothing allocates.
#[derive(Debug, Clone, Default)]
pub struct Hypotheses {
    leaves: Vec<Leaf, MAX_HYPOTHESES>,
    spare: Vec<Leaf, MAX_HYPOTHESES>,
    choice: Choice,
    stamp: Time,
    persons: u32,
}

impl Hypotheses {
    /// Time of the last measurement.
    pub const fn stamp(&self) -> Time {
        self.stamp
    }

    /// Number of hypotheses.
    pub fn len(&self) -> usize {
        self.leaves.len()
    }

    /// Returns `true` if there are no hypotheses.
    pub fn is_empty(&self) -> bool {
        self.leaves.is_empty()
    }

    /// Forgets all persons.
    pub fn clear(&mut self) {
        self.leaves.clear();
        self.choice.clear();
    }

    /// Updates all persons with a measurement, which must not be older than the last one. Positions that are not finite
    /// are ignored.
    pub fn update(&mut self, detections: &Detections, sensor: &Sensor, model: &Model) {
        self.predict(detections.stamp, model);
        self.spare.clear();
        let mut trees = 0;
        let mut rest = &self.leaves[..];
        while let Some(first) = rest.first() {
            let (tree, others) = rest.split_at(rest.iter().take_while(|leaf| leaf.person == first.person).count());
            rest = others;
            let branches = grow(tree, detections, sensor, model);
            trees += usize::from(!branches.is_empty());
            // What does not fit is dropped: the limit per tree keeps this rare.
            let _ = self.spare.extend_from_slice(&branches[..branches.len().min(MAX_HYPOTHESES - self.spare.len())]);
        }
        self.add_new(detections, sensor, model, trees);
        core::mem::swap(&mut self.leaves, &mut self.spare);
        let depth = model.depth.clamp(1, MAX_DEPTH);
        self.choice.choose(&self.leaves, depth);
        self.settle(depth);
    }

    /// Moves all persons on to a time and drops those that were not seen for long.
    fn predict(&mut self, stamp: Time, model: &Model) {
        let seconds = stamp.since(self.stamp).as_secs_f32();
        let stays = libm::expf(-seconds / model.stay.max(f32::MIN_POSITIVE));
        self.leaves.retain_mut(|leaf| {
            leaf.presence *= stays;
            let known = stamp.since(leaf.seen).as_secs_f32() <= model.forget;
            if known {
                leaf.motion = leaf.motion.after(seconds, model.acceleration);
            }
            known
        });
        self.stamp = stamp;
    }

    /// Adds a tree for each detection, as it may be of a new person.
    fn add_new(&mut self, detections: &Detections, sensor: &Sensor, model: &Model, trees: usize) {
        let free = MAX_PERSONS.saturating_sub(trees);
        let new = finite(detections).take(free);
        for (number, position) in new {
            let mut trail = [0; MAX_DEPTH];
            trail[0] = number;
            self.persons = self.persons.wrapping_add(1);
            let leaf = Leaf {
                person: self.persons,
                motion: Motion::begin(position, sensor.deviation, model.speed),
                score: log_ratio(model.births, sensor.clutter),
                presence: 1.0,
                seen: detections.stamp,
                trail,
            };
            if self.spare.push(leaf).is_err() {
                break;
            }
        }
    }

    /// Drops the leaves that contradict the oldest chosen assignments.
    fn settle(&mut self, depth: usize) {
        let oldest = depth - 1;
        let mut used = [None; MAX_DETECTIONS + 1];
        // Persons are numbered in order, so that each can be found by bisection.
        let mut settled: Vec<(u32, u8), MAX_PERSONS> = Vec::new();
        for leaf in self.choice.leaves(&self.leaves) {
            let number = leaf.trail[oldest];
            // Cannot fail: there are at most `MAX_PERSONS` trees.
            let _ = settled.push((leaf.person, number));
            if number > 0 {
                used[usize::from(number)] = Some(leaf.person);
            }
        }
        let keeps = |leaf: &Leaf| {
            let number = leaf.trail[oldest];
            match settled.binary_search_by_key(&leaf.person, |(person, _)| *person) {
                Ok(at) => settled[at].1 == number,
                Err(_) => number == 0 || used[usize::from(number)].is_none(),
            }
        };
        self.spare.clear();
        self.spare.extend(self.leaves.iter().filter(|leaf| keeps(leaf)).copied());
        self.choice.renumber(&self.leaves, keeps);
        core::mem::swap(&mut self.leaves, &mut self.spare);
    }

    /// Writes the persons of the best hypothesis at a time: those with at least this score that are present with at
    /// least this probability.
    pub fn persons(&self, now: Time, model: &Model, score: f32, presence: f32, persons: &mut Persons) {
        persons.clear();
        let seconds = now.since(self.stamp).as_secs_f32().min(model.forget);
        let stays = libm::expf(-seconds / model.stay.max(f32::MIN_POSITIVE));
        let known = |leaf: &&Leaf| {
            let age = now.since(leaf.seen).as_secs_f32();
            leaf.score >= score && leaf.presence * stays >= presence && age <= model.forget
        };
        persons.extend(self.choice.leaves(&self.leaves).filter(known).map(|leaf| {
            let motion = leaf.motion.after(seconds, model.acceleration);
            Person {
                id: leaf.person,
                position: motion.position,
                velocity: motion.velocity,
                deviation: motion.deviation(),
                presence: leaf.presence * stays,
            }
        }));
    }
}

/// Detections with finite positions, with their numbers from 1.
fn finite(detections: &Detections) -> impl Iterator<Item = (u8, crate::scan::Point2)> + '_ {
    let numbered = detections.positions.iter().enumerate().map(|(i, position)| (i as u8 + 1, *position));
    numbered.filter(|(_, position)| position.x.is_finite() && position.y.is_finite())
}

fn log_ratio(numerator: f32, denominator: f32) -> f32 {
    libm::logf(numerator.max(f32::MIN_POSITIVE) / denominator.max(f32::MIN_POSITIVE))
}

/// Leaves of a tree after a measurement.
fn grow(tree: &[Leaf], detections: &Detections, sensor: &Sensor, model: &Model) -> Vec<Leaf, MAX_BRANCHES> {
    let mut branches = Branches::default();
    for leaf in tree {
        let rate = if detections.view.contains(leaf.motion.position) { sensor.rate } else { 0.0 };
        branches.add(leaf.missed(rate));
        for (number, position) in finite(detections) {
            let (squared, density) = leaf.motion.likelihood(position, sensor.deviation);
            if squared <= model.gate * model.gate {
                let mut child = leaf.child(number);
                child.score += log_ratio(leaf.presence * sensor.rate * density, sensor.clutter);
                child.presence = 1.0;
                child.seen = detections.stamp;
                child.motion = leaf.motion.measured(position, sensor.deviation);
                branches.add(child);
            }
        }
    }
    branches.pruned(model)
}

/// Leaves of a tree while it grows.
///
/// The best leaf for each assignment of the newest measurement is kept first. If only scores counted, all leaves might
/// use the same detection, and another person who needs it would leave none to choose.
#[derive(Default)]
struct Branches {
    /// Best leaf for each newest assignment.
    heads: Vec<Leaf, MAX_BRANCHES>,
    /// Further leaves, best first.
    rest: Vec<Leaf, MAX_BRANCHES>,
}

impl Branches {
    fn add(&mut self, leaf: Leaf) {
        let beaten = match self.heads.iter_mut().find(|head| head.trail[0] == leaf.trail[0]) {
            Some(head) if leaf.score > head.score => core::mem::replace(head, leaf),
            Some(_) => leaf,
            None => match self.heads.push(leaf) {
                Ok(()) => return,
                Err(leaf) => leaf,
            },
        };
        // After equal ones, so that the order is that of creation.
        let at = self.rest.partition_point(|other| other.score.total_cmp(&beaten.score).is_ge());
        // A leaf that is worse than all others of a full list is dropped.
        if at < MAX_BRANCHES {
            self.rest.truncate(MAX_BRANCHES - 1);
            // Cannot fail: one place is free.
            let _ = self.rest.insert(at, beaten);
        }
    }

    /// Leaves that are left after pruning by score and by number.
    fn pruned(mut self, model: &Model) -> Vec<Leaf, MAX_BRANCHES> {
        // A missed detection leaves all detections to other persons, so that it comes first.
        self.heads.sort_unstable_by(|a, b| (b.trail[0] == 0).cmp(&(a.trail[0] == 0)).then(b.score.total_cmp(&a.score)));
        let best = self.heads.iter().map(|leaf| leaf.score).fold(f32::MIN, f32::max);
        let near = self.rest.iter().filter(|leaf| leaf.score >= best - model.margin);
        let kept = self.heads.iter().chain(near).filter(|l| l.score >= MIN_SCORE && l.presence >= MIN_PRESENCE);
        kept.take(model.branches.clamp(1, MAX_BRANCHES)).copied().collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{math::Random, scan::Point2};
    use std::vec;

    const SENSOR: Sensor = Sensor { deviation: 0.1, rate: 0.8, clutter: 0.005 };

    const MODEL: Model = Model {
        acceleration: 0.5,
        speed: 1.0,
        births: 0.001,
        stay: 20.0,
        forget: 3.0,
        gate: 3.5,
        margin: 8.0,
        branches: 8,
        depth: 5,
    };

    fn detections(tick: i64, positions: &[(f32, f32)]) -> Detections {
        let positions = positions.iter().map(|(x, y)| Point2::new(*x, *y)).collect();
        Detections { stamp: Time::from_millis(400 * tick), positions, ..Detections::default() }
    }

    fn persons(hypotheses: &Hypotheses, score: f32) -> std::vec::Vec<Person> {
        let mut persons = Persons::new();
        hypotheses.persons(hypotheses.stamp(), &MODEL, score, 0.4, &mut persons);
        persons.to_vec()
    }

    #[test]
    fn persons_who_cross_keep_their_numbers() {
        let mut hypotheses = Hypotheses::default();
        let mut random = Random::new(3);
        let mut ids = std::vec::Vec::new();
        for tick in 0..40 {
            let x = -4.0 + 0.2 * tick as f32;
            let truth = [(x, 0.05 * x), (-x, 0.3 - 0.05 * x)];
            let mut seen: std::vec::Vec<(f32, f32)> =
                truth.iter().map(|(x, y)| (x + random.normal(0.05), y + random.normal(0.05))).collect();
            if tick % 2 == 1 {
                seen.reverse();
            }
            if tick % 5 == 4 {
                seen.pop();
            }
            hypotheses.update(&detections(tick, &seen), &SENSOR, &MODEL);
            let tracked = persons(&hypotheses, 2.0);
            if tick > 5 {
                assert_eq!(tracked.len(), 2, "tick {tick}: {tracked:?}");
                ids.push(truth.map(|(x, y)| {
                    let distance = |p: &&Person| (p.position - Point2::new(x, y)).norm();
                    tracked.iter().min_by(|a, b| distance(a).total_cmp(&distance(b))).map(|p| p.id)
                }));
            }
        }
        assert_eq!(ids.first(), ids.last());
    }

    #[test]
    fn one_detection_is_no_person_and_who_left_is_forgotten() {
        let mut hypotheses = Hypotheses::default();
        hypotheses.update(&detections(0, &[(1.0, 1.0)]), &SENSOR, &MODEL);
        assert_eq!(persons(&hypotheses, 2.0), vec![]);
        for tick in 1..10 {
            hypotheses.update(&detections(tick, &[(1.0, 1.0)]), &SENSOR, &MODEL);
        }
        assert_eq!(persons(&hypotheses, 2.0).len(), 1);
        for tick in 10..30 {
            hypotheses.update(&detections(tick, &[]), &SENSOR, &MODEL);
        }
        assert!(hypotheses.is_empty() && persons(&hypotheses, 2.0).is_empty());
    }

    #[test]
    fn a_person_out_of_view_is_not_missed() {
        let mut hypotheses = Hypotheses::default();
        for tick in 0..6 {
            hypotheses.update(&detections(tick, &[(1.0, 1.0)]), &SENSOR, &MODEL);
        }
        let mut blind = hypotheses.clone();
        for tick in 6..9 {
            let mut empty = detections(tick, &[]);
            hypotheses.update(&empty, &SENSOR, &MODEL);
            empty.view.range = 0.5;
            blind.update(&empty, &SENSOR, &MODEL);
        }
        assert_eq!((persons(&hypotheses, 2.0).len(), persons(&blind, 2.0).len()), (0, 1));
    }

    #[test]
    fn crowds_beyond_all_limits_do_no_harm() {
        let mut hypotheses = Hypotheses::default();
        let mut random = Random::new(1);
        for tick in 0..30 {
            let mut seen: std::vec::Vec<(f32, f32)> =
                (0..MAX_DETECTIONS).map(|_| (random.uniform(-2.0, 2.0), random.uniform(-2.0, 2.0))).collect();
            seen[3] = (f32::NAN, 1.0);
            seen[4] = (f32::INFINITY, f32::NEG_INFINITY);
            hypotheses.update(&detections(tick, &seen), &SENSOR, &MODEL);
            assert!(hypotheses.len() <= MAX_HYPOTHESES);
        }
        let tracked = persons(&hypotheses, f32::MIN);
        assert!(tracked.len() <= MAX_PERSONS && tracked.iter().all(|p| p.position.norm().is_finite()));
        assert!(tracked.windows(2).all(|w| w[0].id < w[1].id));
        hypotheses.update(&detections(1 << 40, &[]), &SENSOR, &MODEL);
        assert!(hypotheses.is_empty());
    }
}
