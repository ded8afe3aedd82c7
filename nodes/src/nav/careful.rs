use super::Twist;
use crate::{persons::Persons, scan::Pose2};
use apex_rt::node;
use libm::fmaxf;

/// Slows a robot down near persons (thesis 6.8), the more the nearer they are, also behind and beside it.
///
/// `persons` are in the frame of `pose`. Without either, for example before the first scan, the robot keeps to
/// `min_speed`. It still moves with persons beside it: that it stops before them is the task of a safety field.
#[node]
#[derive(Debug, Clone)]
pub struct PersonCaution {
    /// Distance up to which the speed is `min_speed`.
    #[param(unit = "m", default = 0.7, range = 0.0..=100.0)]
    near: f32,
    /// Speed at this distance.
    #[param(unit = "m/s", default = 0.15, range = 0.0..=10.0)]
    min_speed: f32,
    /// Additional speed per metre of distance beyond `near`.
    #[param(unit = "1/s", default = 0.3, range = 0.0..=100.0)]
    gain: f32,
}

#[node]
impl PersonCaution {
    fn process(&mut self, twist: &Twist, pose: Option<&Pose2>, persons: Option<&Persons>) -> Twist {
        let nearest = pose.zip(persons).map(|(pose, persons)| {
            let distances = persons.iter().map(|person| (person.position - pose.position()).norm());
            distances.fold(f32::INFINITY, f32::min)
        });
        let beyond = fmaxf(nearest.unwrap_or(0.0) - self.near, 0.0);
        twist.slowed_to(self.min_speed + self.gain * beyond)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{persons::Person, scan::Point2};
    use apex_rt::Construct;

    #[test]
    fn it_is_slow_near_persons() {
        let mut node = PersonCaution::construct((0.5, 0.2, 0.4));
        let (twist, pose) = (Twist::new(1.0, 0.0, 0.5), Pose2::new(1.0, 1.0, 2.0));
        let mut at = |persons: &[(f32, f32)]| {
            let persons: Persons =
                persons.iter().map(|(x, y)| Person { position: Point2::new(*x, *y), ..Person::default() }).collect();
            node.process(&twist, Some(&pose), Some(&persons))
        };
        assert_eq!(at(&[]), twist);
        assert_eq!(at(&[(9.0, 1.0)]), twist);
        let near = at(&[(9.0, 1.0), (1.0, 2.0)]);
        assert!((near.x - 0.4).abs() < 1e-6 && (near.omega - 0.2).abs() < 1e-6, "{near:?}");
        assert!((at(&[(1.1, 1.0)]).x - 0.2).abs() < 1e-6);
        assert!((node.process(&twist, Some(&pose), None).x - 0.2).abs() < 1e-6);
        assert!((node.process(&twist, None, None).x - 0.2).abs() < 1e-6);
    }
}
