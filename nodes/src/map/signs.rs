use crate::scan::{Point2, Pose2};
use apex_rt::{Event, Out, node};

/// Maximum number of signs of a map.
pub const MAX_SIGNS: usize = 64;

/// Signs of a map, in the order of their first sightings.
pub type Signs = heapless::Vec<Sign, MAX_SIGNS>;

/// Maximum number of views that a place remembers.
const MAX_VIEWS: usize = 24;

/// Estimated class and pose of a sign: a Gaussian over its position and a von Mises distribution over its orientation
/// (thesis 4.3.2).
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Sign {
    /// Class of the sign.
    pub class: u32,
    /// Number of sightings with this class.
    pub count: u32,
    /// Number of sightings of this place with other classes.
    pub against: u32,
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
        Self { class, count: 1, against: 0, mean: pose.position(), scatter: [0.0; 3], directions }
    }

    /// Adds a sighting of the sign's class.
    pub fn add(&mut self, pose: &Pose2) {
        self.count = self.count.saturating_add(1);
        self.place(pose);
    }

    /// Adds a sighting of another class at the place of the sign: the place is the better known for it, the class is
    /// the less certain.
    pub fn oppose(&mut self, pose: &Pose2) {
        self.against = self.against.saturating_add(1);
        self.place(pose);
    }

    /// Adds the pose of a sighting that has been counted (Welford 1962).
    fn place(&mut self, pose: &Pose2) {
        let before = pose.position() - self.mean;
        self.mean = self.mean + before.scaled(1.0 / self.sightings() as f32);
        let after = pose.position() - self.mean;
        let squares = [before.x * after.x, before.y * after.y, before.x * after.y];
        self.scatter.iter_mut().zip(squares).for_each(|(sum, square)| *sum += square);
        self.directions = self.directions + Point2::polar(1.0, pose.theta);
    }

    /// Number of sightings of any class.
    const fn sightings(&self) -> u32 {
        self.count.saturating_add(self.against)
    }

    /// Sightings with the class of the sign minus those with other classes; 0 if the others are more.
    pub const fn support(&self) -> u32 {
        self.count.saturating_sub(self.against)
    }

    /// Mean position and most likely orientation (thesis eq. 4.1).
    pub fn pose(&self) -> Pose2 {
        Pose2::new(self.mean.x, self.mean.y, self.directions.angle())
    }

    /// Covariance of the position: along x, along y, and between both, in m². Zeros before the second sighting.
    pub fn covariance(&self) -> [f32; 3] {
        self.scatter.map(|sum| sum / self.sightings().saturating_sub(1).max(1) as f32)
    }

    /// Agreement of the orientations: 1 if all are equal, 0 if they cancel out. The concentration of the von Mises
    /// distribution grows with it.
    pub fn agreement(&self) -> f32 {
        self.directions.norm() / self.sightings() as f32
    }
}

/// Latest sighting of a place from one point of view.
#[derive(Debug, Clone, Copy)]
struct View {
    /// Position of the robot, in the frame of the map.
    from: Point2,
    /// Seen class and pose, the latter in the frame of the map.
    class: u32,
    pose: Pose2,
}

/// Place where signs were seen.
#[derive(Debug, Clone)]
struct Place {
    /// Views in the order in which they were first taken.
    views: heapless::Vec<View, MAX_VIEWS>,
    sign: Sign,
}

impl Place {
    fn new(view: View) -> Self {
        let sign = Sign::new(view.class, &view.pose);
        Self { views: core::iter::once(view).collect(), sign }
    }

    /// Takes a view in place of an earlier one from the same point, or else in place of the oldest one if there are too
    /// many.
    fn see(&mut self, view: View, is_same: impl Fn(&View, Point2) -> bool) {
        let mean = self.sign.mean;
        match self.views.iter_mut().find(|other| is_same(other, mean)) {
            Some(same) => *same = view,
            None => {
                if self.views.is_full() {
                    self.views.remove(0);
                }
                // Cannot fail: there is room now.
                let _ = self.views.push(view);
            }
        }
        self.sign = self.judge();
    }

    /// Sign of the class that most views show; of equals, the one of the oldest view.
    fn judge(&self) -> Sign {
        let votes = |class: u32| self.views.iter().filter(|view| view.class == class).count();
        let class = self.views.iter().rev().map(|view| view.class).max_by_key(|class| votes(*class));
        let class = class.unwrap_or(self.sign.class);
        let nothing = [0.0; 3];
        let mut sign =
            Sign { class, count: 0, against: 0, scatter: nothing, directions: Point2::default(), ..self.sign };
        for view in &self.views {
            if view.class == class { sign.add(&view.pose) } else { sign.oppose(&view.pose) }
        }
        sign
    }
}

/// Maps the signs that a robot sees (thesis 4.3.2), robust to false detections. A sighting belongs to the nearest place
/// within `gate` and `turn`, whatever its class; otherwise it is a new place.
///
/// Sightings from one point of view are wrong together: the same thing hides the same part of the sign. Therefore each
/// view of a place counts once, with its latest class, and a view is another one if the robot has moved by `step` or
/// sees the place from a direction that differs by `angle`. A place has the class that most of its views show. It
/// remembers 24 views, so that a wrong class is unlearned when enough others contradict it.
///
/// Sends the whole map after each sighting. In a full map, a new place replaces the one with the fewest views. A
/// sighting that is not finite is ignored.
#[node]
#[derive(Debug, Clone)]
pub struct SignMap {
    /// Maximum distance of a sighting from the mean of its place.
    #[param(unit = "m", default = 0.75, range = 0.0..=100.0)]
    gate: f32,
    /// Maximum rotation of a sighting relative to its place.
    #[param(unit = "rad", default = 0.8, range = 0.0..=3.15)]
    turn: f32,
    /// Distance between two points of view. With 0, each sighting counts.
    #[param(unit = "m", default = 0.2, range = 0.0..=100.0)]
    step: f32,
    /// Angle at the sign between two points of view. With 0, each sighting counts.
    #[param(unit = "rad", default = 0.2, range = 0.0..=3.15)]
    angle: f32,
    places: Vec<Place>,
}

#[node]
impl SignMap {
    /// Adds a sighting. `sign` is the pose of the sign in the frame of the robot, `robot` the pose of the robot in the
    /// frame of the map.
    fn process(&mut self, class: &u32, sign: &Pose2, robot: &Pose2, signs: &mut Out<Signs>) {
        let view = View { from: robot.position(), class: *class, pose: robot.compose(sign) };
        if [view.pose.x, view.pose.y, view.pose.theta].iter().all(|x| x.is_finite()) {
            self.add(view);
        }
        let signs = signs.get_mut();
        signs.clear();
        signs.extend(self.places.iter().map(|place| place.sign));
    }

    fn add(&mut self, view: View) {
        let distance = |place: &Place| (place.sign.mean - view.pose.position()).norm();
        let near = |place: &&mut Place| {
            let turn = place.sign.pose().relative_to(&view.pose).theta.abs();
            distance(place) <= self.gate && turn <= self.turn
        };
        let (step, angle) = (self.step, self.angle);
        let is_same = |other: &View, sign: Point2| {
            let [a, b] = [other, &view].map(|view| view.from - sign);
            let turn = libm::atan2f(a.x * b.y - a.y * b.x, a.dot(b)).abs();
            (a - b).norm() < step && turn < angle
        };
        match self.places.iter_mut().filter(near).min_by(|a, b| distance(a).total_cmp(&distance(b))) {
            Some(place) => place.see(view, is_same),
            None => {
                if self.places.len() == MAX_SIGNS {
                    let weakest = (0..self.places.len()).min_by_key(|i| self.places[*i].views.len());
                    weakest.map(|i| self.places.remove(i));
                }
                self.places.push(Place::new(view));
            }
        }
    }
}

/// Looks up the pose of the sign of a class in a map (thesis 8.1.1): the one with the most support, which is the number
/// of its sightings minus that of contradicting ones. If no sign has enough support, or without a map, the output is ⊥,
/// and `unknown` gives the class.
#[node]
#[derive(Debug, Clone)]
pub struct MapLookup {
    /// Minimum support. A sign with less may be a false detection.
    #[param(default = 3, range = 1..=1_000_000)]
    min_count: u32,
}

#[node]
impl MapLookup {
    fn process(&mut self, class: &u32, signs: Option<&Signs>, unknown: Event<u32>) -> Option<Pose2> {
        let signs = signs.map_or(&[][..], |signs| signs);
        let known = signs.iter().filter(|sign| sign.class == *class && sign.support() >= self.min_count);
        // The first one of equals.
        let best = known.rev().max_by_key(|sign| sign.support()).map(Sign::pose);
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
        let pose = MapLookup::construct((3,)).process(&class, Some(signs), apex_rt::event(&mut unknown));
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
        let signs = explore(&mut SignMap::construct((0.75, 0.8, 0.2, 0.2)), &truth, &mut Random::new(4));
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
        let mut map = SignMap::construct((0.1, 0.8, 0.0, 0.0));
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

    /// Map with the default parameters after sightings of a class from places of the robot, of a sign at the origin
    /// that faces along x.
    fn seen(sightings: &[(u32, Point2)]) -> Signs {
        let (mut map, mut out) = (SignMap::construct((0.75, 0.8, 0.2, 0.2)), Out::new());
        for (class, from) in sightings {
            let robot = Pose2::new(from.x, from.y, 0.3);
            map.process(class, &Pose2::default().relative_to(&robot), &robot, &mut out);
        }
        out.get().cloned().unwrap_or_default()
    }

    /// Sightings of a class from a row of places, 0.3 m apart.
    fn row(class: u32, first: usize, count: usize) -> Vec<(u32, Point2)> {
        (first..first + count).map(|i| (class, Point2::new(1.0 + 0.3 * i as f32, 0.0))).collect()
    }

    #[test]
    fn a_sign_that_is_seen_often_from_one_place_is_seen_once() {
        let standing = vec![(4, Point2::new(2.0, 0.0)); 50];
        let signs = seen(&standing);
        assert_eq!((signs.len(), signs[0].count, lookup(4, &signs)), (1, 1, (None, Some(4))));
        assert_eq!(seen(&row(4, 0, 3))[0].count, 3);
        // Near the sign, a small step is another angle.
        let near = |y: f32| (4, Point2::new(0.4, y));
        assert_eq!(seen(&[near(0.0), near(0.05), near(0.15)])[0].count, 2);
    }

    #[test]
    fn the_latest_class_of_a_view_counts() {
        let place = Point2::new(2.0, 0.0);
        let signs = seen(&[(4, place), (4, place), (1, place)]);
        assert_eq!((signs.len(), signs[0].class, signs[0].count, signs[0].against), (1, 1, 1, 0));
    }

    #[test]
    fn a_place_has_one_class_and_unlearns_it() {
        let mut sightings = row(4, 0, 5);
        let known = |sightings: &[(u32, Point2)]| [1, 4].map(|class| lookup(class, &seen(sightings)).0.is_some());
        assert_eq!(known(&sightings), [false, true]);
        sightings.extend(row(1, 5, 3));
        assert_eq!(known(&sightings), [false, false], "it is in doubt");
        assert_eq!(seen(&sightings).len(), 1);
        sightings.extend(row(1, 8, 5));
        assert_eq!(known(&sightings), [true, false]);
        // Even a belief that is as firm as can be.
        let firm = [row(4, 0, 100), row(1, 100, 14)].concat();
        let after = |count: usize| known(&firm[..100 + count]);
        assert_eq!([0, 11, 14].map(after), [[false, true], [false, false], [true, false]]);
    }
}
