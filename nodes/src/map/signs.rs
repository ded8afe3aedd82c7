use crate::scan::{Point2, Pose2};
use apex_rt::{Event, Out, node};

/// Maximum number of signs of a map.
pub const MAX_SIGNS: usize = 64;

/// Signs of a map, in the order of their first sightings.
pub type Signs = heapless::Vec<Sign, MAX_SIGNS>;

/// Estimated pose of a sign: a Gaussian over its position and a von Mises distribution over its orientation (thesis
/// 4.3.2).
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Sign {
    /// Class of the sign.
    pub class: u32,
    /// Number of sightings.
    pub count: u32,
    /// Mean of the positions, in m, in the frame of the map.
    pub mean: Point2,
    /// Sums of the squared deviations from the mean along x and along y, and of their products, in m².
    scatter: [f32; 3],
    /// Sums of the cosines and sines of the orientations.
    directions: Point2,
}

impl Sign {
    /// Creates a sign with one sighting.
    pub fn new(class: u32, pose: &Pose2) -> Self {
        let directions = Point2::polar(1.0, pose.theta);
        Self { class, count: 1, mean: pose.position(), scatter: [0.0; 3], directions }
    }

    /// Adds a sighting (Welford 1962).
    pub fn add(&mut self, pose: &Pose2) {
        self.count = self.count.saturating_add(1);
        let before = pose.position() - self.mean;
        self.mean = self.mean + before.scaled(1.0 / self.count as f32);
        let after = pose.position() - self.mean;
        let squares = [before.x * after.x, before.y * after.y, before.x * after.y];
        self.scatter.iter_mut().zip(squares).for_each(|(sum, square)| *sum += square);
        self.directions = self.directions + Point2::polar(1.0, pose.theta);
    }

    /// Mean position and most likely orientation (thesis eq. 4.1).
    pub fn pose(&self) -> Pose2 {
        Pose2::new(self.mean.x, self.mean.y, self.directions.angle())
    }

    /// Covariance of the position: along x, along y, and between both, in m². Zeros before the second sighting.
    pub fn covariance(&self) -> [f32; 3] {
        self.scatter.map(|sum| sum / self.count.saturating_sub(1).max(1) as f32)
    }

    /// Agreement of the orientations: 1 if all are equal, 0 if they cancel out. The concentration of the von Mises
    /// distribution grows with it.
    pub fn agreement(&self) -> f32 {
        self.directions.norm() / self.count as f32
    }
}

/// Maps the signs that a robot sees (thesis 4.3.2), robust to false detections. A sighting belongs to the nearest sign
/// of its class within `gate` and `turn`; otherwise it is a new sign.
///
/// Sends the whole map after each sighting. In a full map, a new sign replaces the one with the fewest sightings. A
/// sighting that is not finite is ignored.
#[node]
#[derive(Debug, Clone)]
pub struct SignMap {
    /// Maximum distance of a sighting from the mean of its sign.
    #[param(unit = "m", default = 0.75, range = 0.0..=100.0)]
    gate: f32,
    /// Maximum rotation of a sighting relative to its sign.
    #[param(unit = "rad", default = 0.8, range = 0.0..=3.15)]
    turn: f32,
    signs: Signs,
}

#[node]
impl SignMap {
    /// Adds a sighting. `sign` is the pose of the sign in the frame of the robot, `robot` the pose of the robot in the
    /// frame of the map.
    fn process(&mut self, class: &u32, sign: &Pose2, robot: &Pose2, signs: &mut Out<Signs>) {
        let pose = robot.compose(sign);
        if [pose.x, pose.y, pose.theta].iter().all(|x| x.is_finite()) {
            self.add(*class, &pose);
        }
        signs.get_mut().clone_from(&self.signs);
    }

    fn add(&mut self, class: u32, pose: &Pose2) {
        let distance = |sign: &Sign| (sign.mean - pose.position()).norm();
        let near = |sign: &&mut Sign| {
            let turn = sign.pose().relative_to(pose).theta.abs();
            sign.class == class && distance(sign) <= self.gate && turn <= self.turn
        };
        match self.signs.iter_mut().filter(near).min_by(|a, b| distance(a).total_cmp(&distance(b))) {
            Some(sign) => sign.add(pose),
            None => {
                if self.signs.is_full() {
                    let weakest = (0..self.signs.len()).min_by_key(|i| self.signs[*i].count);
                    weakest.map(|i| self.signs.remove(i));
                }
                // Cannot fail: there is room now.
                let _ = self.signs.push(Sign::new(class, pose));
            }
        }
    }
}

/// Looks up the pose of the sign of a class in a map (thesis 8.1.1): the one with the most sightings. If no sign has
/// enough sightings, or without a map, the output is ⊥, and `unknown` gives the class.
///
/// Signs may be misclassified: a sign does not count if another sign at the same place has more sightings.
#[node]
#[derive(Debug, Clone)]
pub struct MapLookup {
    /// Minimum number of sightings. A sign with fewer may be a false detection.
    #[param(default = 3, range = 1..=1_000_000)]
    min_count: u32,
    /// Maximum distance between two signs at the same place.
    #[param(unit = "m", default = 0.75, range = 0.0..=100.0)]
    place: f32,
}

#[node]
impl MapLookup {
    fn process(&mut self, class: &u32, signs: Option<&Signs>, unknown: Event<u32>) -> Option<Pose2> {
        let signs = signs.map_or(&[][..], |signs| signs);
        let known = signs.iter().filter(|sign| sign.class == *class && sign.count >= self.min_count);
        let is_other = |a: &Sign, b: &Sign| (a.mean - b.mean).norm() <= self.place && b.count > a.count;
        let right = known.filter(|sign| !signs.iter().any(|other| is_other(sign, other)));
        // The first one of equals.
        let best = right.rev().max_by_key(|sign| sign.count).map(Sign::pose);
        if best.is_none() {
            unknown.emit(*class);
        }
        best
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Random;
    use apex_rt::Construct;
    use core::f32::consts::PI;

    fn lookup(class: u32, signs: &Signs) -> (Option<Pose2>, Option<u32>) {
        let mut unknown = None;
        let pose = MapLookup::construct((3, 0.75)).process(&class, Some(signs), apex_rt::event(&mut unknown));
        (pose, unknown)
    }

    /// Sightings from random places, with noise; every fifth one is false.
    fn explore(map: &mut SignMap, truth: &[(u32, Pose2)], random: &mut Random) -> Signs {
        let mut out = Out::new();
        for i in 0..200 {
            let (class, sign) = truth[i % truth.len()];
            let robot = Pose2::new(random.uniform(-3.0, 3.0), random.uniform(-3.0, 3.0), random.uniform(-PI, PI));
            let noisy =
                Pose2::new(sign.x + random.normal(0.1), sign.y + random.normal(0.05), sign.theta + random.normal(0.1));
            let wrong = Pose2::new(random.uniform(-6.0, 6.0), random.uniform(-6.0, 6.0), random.uniform(-PI, PI));
            let seen = if i % 5 == 4 { wrong } else { noisy };
            map.process(&class, &seen.relative_to(&robot), &robot, &mut out);
        }
        out.get().cloned().expect("a map")
    }

    #[test]
    fn signs_are_found_among_false_detections() {
        // One of them faces along −x, where angles wrap.
        let truth = [(1, Pose2::new(5.0, 0.0, PI)), (2, Pose2::new(0.0, 5.0, -1.6)), (3, Pose2::new(-5.0, 1.0, 0.1))];
        let signs = explore(&mut SignMap::construct((0.75, 0.8)), &truth, &mut Random::new(4));
        for (class, expected) in truth {
            let (pose, unknown) = lookup(class, &signs);
            let error = pose.expect("a sign").relative_to(&expected);
            assert!(error.position().norm() < 0.1 && error.theta.abs() < 0.1 && unknown.is_none(), "{error:?}");
            let best = signs.iter().filter(|s| s.class == class).max_by_key(|s| s.count).expect("a sign");
            let [x, y, _] = best.covariance();
            assert!((x.sqrt() - 0.1).abs() < 0.04 && (y.sqrt() - 0.05).abs() < 0.04, "{x} {y}");
            assert!(best.agreement() > 0.98);
        }
        assert_eq!(lookup(4, &signs), (None, Some(4)));
    }

    #[test]
    fn a_full_map_forgets_the_weakest() {
        let mut map = SignMap::construct((0.1, 0.8));
        let mut out = Out::new();
        for i in 0..3 * MAX_SIGNS {
            map.process(&7, &Pose2::new(0.0, 0.0, 0.0), &Pose2::default(), &mut out);
            map.process(&7, &Pose2::new(1.0 + i as f32, 0.0, 0.0), &Pose2::default(), &mut out);
        }
        map.process(&7, &Pose2::new(f32::NAN, 0.0, 0.0), &Pose2::default(), &mut out);
        let signs = out.get().expect("a map");
        assert_eq!((signs.len(), lookup(7, signs)), (MAX_SIGNS, (Some(Pose2::default()), None)));
        assert!(signs.iter().all(|s| s.mean.x.is_finite()));
    }
}
