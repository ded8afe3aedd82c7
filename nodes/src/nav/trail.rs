use super::Path;
use crate::{
    persons::Person,
    scan::{Point2, Pose2},
};
use apex_rt::{Event, Out, node};
use libm::fminf;

/// Uncertainty of a person's place up to which the person is seen there, in m.
const SEEN: f32 = 0.4;

/// Remembers the way of a person who is followed: where the person went, a vehicle of the same width can go, too.
///
/// `person` is the person now, or ⊥. Only places at which the person is seen belong to the way, those of which the
/// standard deviation is at most 0.4 m. `trail` is the way, in the frame of the person, with points at least `spacing`
/// apart. It begins again with another place more than `jump` away, and has its last `length` only.
///
/// `recall` triggers `last` with the person as it was seen last, standing still there. It triggers `there` if no person
/// was seen, and if the robot, by its `pose`, is within `near` of that place already.
#[node]
#[derive(Debug, Clone)]
pub struct PersonTrail {
    /// Distance between points.
    #[param(unit = "m", default = 0.4, range = 0.05..=10.0)]
    spacing: f32,
    /// Length of the way that is remembered.
    #[param(unit = "m", default = 40.0, range = 1.0..=500.0)]
    length: f32,
    /// Distance of a place from the last one from which on it belongs to another way.
    #[param(unit = "m", default = 12.0, range = 0.5..=100.0)]
    jump: f32,
    /// Distance from the place where the person was seen last at which a robot is there.
    #[param(unit = "m", default = 2.0, range = 0.0..=100.0)]
    near: f32,
    path: Path,
    last: Option<Person>,
    here: Option<Point2>,
}

#[node]
impl PersonTrail {
    fn process(&mut self, person: Option<&Person>, pose: Option<&Pose2>, trail: &mut Out<Path>) {
        self.here = pose.filter(|pose| pose.is_usable()).map(|pose| pose.position()).or(self.here);
        if let Some(person) = person.filter(|person| is_seen(person)) {
            self.add(person.position);
            self.last = Some(Person { velocity: Point2::default(), ..*person });
        }
        trail.get_mut().clone_from(&self.path);
    }

    fn add(&mut self, place: Point2) {
        let points = &mut self.path.points;
        let Some(last) = points.last().copied() else {
            points.push(place);
            return;
        };
        let way = place - last;
        let distance = way.norm();
        if distance > self.jump {
            points.clear();
            points.push(place);
        } else if distance >= self.spacing {
            // Where the person was hidden, the way between is taken to be straight.
            let count = (distance / self.spacing) as usize;
            points.extend((1..=count).map(|i| last + way.scaled(i as f32 / count as f32)));
            self.path.heading = way.angle();
        }
        let most = fminf(self.length / self.spacing, 10_000.0) as usize + 1;
        points.drain(..points.len().saturating_sub(most));
    }

    /// Tells where the person was seen last.
    #[slot]
    fn recall(&mut self, last: Event<Person>, there: Event<()>) {
        let is_far = |person: &Person| self.here.is_none_or(|here| (person.position - here).norm() > self.near);
        match self.last.filter(is_far) {
            Some(person) => last.emit(person),
            None => there.emit(()),
        }
    }
}

/// Returns `true` for a person whose place is known. False for NaN.
fn is_seen(person: &Person) -> bool {
    (person.position.x + person.position.y).is_finite() && person.deviation <= SEEN
}

#[cfg(test)]
mod tests {
    use super::*;
    use apex_rt::{Construct, event};

    fn see(node: &mut PersonTrail, x: f32, y: f32, deviation: f32) -> Path {
        let mut trail = Out::new();
        let person =
            Person { position: Point2::new(x, y), velocity: Point2::new(1.0, 0.0), deviation, ..Person::default() };
        node.process(Some(&person), Some(&Pose2::default()), &mut trail);
        node.process(None, None, &mut trail);
        trail.get().cloned().expect("a trail")
    }

    #[test]
    fn a_trail_is_where_the_person_was_seen() {
        let mut node = PersonTrail::construct((0.4, 4.0, 3.0, 2.0));
        let (mut last, mut there) = (None, None);
        node.recall(event(&mut last), event(&mut there));
        assert!(last.is_none() && there.is_some(), "no person was seen");
        (0..30).for_each(|i| {
            see(&mut node, 0.1 * i as f32, 0.0, 0.1);
        });
        // A place that is predicted, and one that is not a number.
        see(&mut node, 4.0, 9.0, 1.5);
        let trail = see(&mut node, f32::NAN, 0.0, 0.1);
        assert!(trail.points.len() >= 7 && trail.points.iter().all(|p| p.y == 0.0), "{trail:?}");
        there = None;
        node.recall(event(&mut last), event(&mut there));
        assert!(there.is_none());
        let last = last.expect("a person");
        assert!((last.position.x - 2.9).abs() < 1e-5 && last.velocity == Point2::default());
        let mut unseen = None;
        node.process(None, Some(&Pose2::new(2.0, 0.0, 0.0)), &mut Out::new());
        node.recall(event(&mut unseen), event(&mut there));
        assert!(unseen.is_none() && there.is_some(), "the robot is there");
        // Behind a tree: the gap is filled, and the beginning is forgotten.
        let trail = see(&mut node, 5.0, 0.8, 0.1);
        let gaps = trail.points.windows(2).map(|pair| (pair[1] - pair[0]).norm());
        assert!(gaps.fold(0.0, f32::max) < 0.6 && trail.length() <= 4.5, "{} m", trail.length());
        let trail = see(&mut node, 20.0, 0.0, 0.1);
        assert_eq!(trail.points, [Point2::new(20.0, 0.0)]);
    }
}
