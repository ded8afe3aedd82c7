use super::{Twist, path::nearest_on};
use crate::{
    persons::Persons,
    scan::{Point2, Pose2},
};
use apex_rt::node;
use libm::fmaxf;

/// Slows a robot down near persons (thesis 6.8), the more the nearer they are, also behind and beside it.
///
/// Distances are those from the origin of the robot, or with a `trailer` from the line between both axes. `persons`,
/// `pose` and `trailer` are in one frame. Without persons or a pose, for example before the first scan, the robot keeps
/// to `min_speed`. It still moves with persons beside it: that it stops before them is the task of a safety field.
#[node]
#[derive(Debug, Clone)]
pub struct PersonCaution {
    /// Distance up to which the speed is `min_speed`.
    #[param(unit = "m", default = 0.7, range = 0.0..=100.0)]
    near: f32,
    /// Speed at this distance.
    #[param(unit = "m/s", default = 0.15, range = 0.0..=10.0)]
    min_speed: f32,
    /// Speed at this distance if the person stands, at least `min_speed`. Table legs look like the legs of a person who
    /// stands.
    #[param(unit = "m/s", default = 0.15, range = 0.0..=10.0)]
    standing_speed: f32,
    /// Velocity from which on a person walks.
    #[param(unit = "m/s", default = 0.3, range = 0.0..=10.0)]
    walking: f32,
    /// Additional speed per metre of distance beyond `near`.
    #[param(unit = "1/s", default = 0.3, range = 0.0..=100.0)]
    gain: f32,
}

#[node]
impl PersonCaution {
    fn process(
        &mut self,
        twist: &Twist,
        pose: Option<&Pose2>,
        trailer: Option<&Pose2>,
        persons: Option<&Persons>,
    ) -> Twist {
        let Some((pose, persons)) = pose.zip(persons) else { return twist.slowed_to(self.min_speed) };
        let ends = [pose, trailer.unwrap_or(pose)].map(|pose| pose.position());
        let speeds = persons.iter().map(|person| {
            let walks = person.velocity.norm() >= self.walking;
            let least = if walks { self.min_speed } else { fmaxf(self.min_speed, self.standing_speed) };
            least + self.gain * fmaxf(distance(person.position, ends) - self.near, 0.0)
        });
        twist.slowed_to(speeds.fold(f32::INFINITY, f32::min))
    }
}

/// Distance of a point from the line between two others.
fn distance(point: Point2, [a, b]: [Point2; 2]) -> f32 {
    (point - nearest_on(a, b, point)).norm()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{persons::Person, scan::Point2};
    use apex_rt::Construct;

    #[test]
    fn it_is_slow_near_persons() {
        let mut node = PersonCaution::construct((0.5, 0.2, 0.2, 0.3, 0.4));
        let (twist, pose) = (Twist::new(1.0, 0.0, 0.5), Pose2::new(1.0, 1.0, 2.0));
        let mut at = |persons: &[(f32, f32)]| {
            let persons: Persons =
                persons.iter().map(|(x, y)| Person { position: Point2::new(*x, *y), ..Person::default() }).collect();
            node.process(&twist, Some(&pose), None, Some(&persons))
        };
        assert_eq!(at(&[]), twist);
        assert_eq!(at(&[(9.0, 1.0)]), twist);
        let near = at(&[(9.0, 1.0), (1.0, 2.0)]);
        assert!((near.x - 0.4).abs() < 1e-6 && (near.omega - 0.2).abs() < 1e-6, "{near:?}");
        assert!((at(&[(1.1, 1.0)]).x - 0.2).abs() < 1e-6);
        assert!((node.process(&twist, Some(&pose), None, None).x - 0.2).abs() < 1e-6);
        assert!((node.process(&twist, None, None, None).x - 0.2).abs() < 1e-6);
    }

    #[test]
    fn persons_beside_the_trailer_are_near() {
        let mut node = PersonCaution::construct((0.5, 0.2, 0.2, 0.3, 0.4));
        let (twist, pose, trailer) = (Twist::new(1.0, 0.0, 0.0), Pose2::default(), Pose2::new(-0.7, 0.0, 0.0));
        let persons: Persons =
            core::iter::once(Person { position: Point2::new(-0.6, 0.7), ..Person::default() }).collect();
        let mut speed = |trailer| node.process(&twist, Some(&pose), trailer, Some(&persons)).x;
        assert!((speed(Some(&trailer)) - 0.28).abs() < 1e-6);
        assert!(speed(None) > 0.36);
    }

    #[test]
    fn persons_who_stand_are_passed_faster() {
        let mut node = PersonCaution::construct((0.5, 0.1, 0.3, 0.2, 0.4));
        let mut speed = |velocity: f32| {
            let velocity = Point2::new(0.0, velocity);
            let persons: Persons = core::iter::once(Person { velocity, ..Person::default() }).collect();
            node.process(&Twist::new(1.0, 0.0, 0.0), Some(&Pose2::default()), None, Some(&persons)).x
        };
        assert_eq!([speed(0.1), speed(-0.5)], [0.3, 0.1]);
    }
}
