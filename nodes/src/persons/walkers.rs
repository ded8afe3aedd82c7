use super::Persons;
use crate::scan::{BeamDirections, Pose2, Scan};
use apex_rt::{Out, node};

/// Marks the beams of a scan that end at persons who walk as not measured (NaN): they will be elsewhere when the robot
/// gets there, so that no way has to be planned around them.
///
/// `pose` is that of the scanner in the frame of the persons. Without it, or without persons, the scan is passed on. A
/// node that stops the robot before persons needs the whole scan.
#[node]
#[derive(Debug, Clone)]
pub struct HideWalkers {
    /// Velocity from which on a person walks.
    #[param(unit = "m/s", default = 0.3, range = 0.0..=10.0)]
    walking: f32,
    /// Distance from a person up to which beams end at that person, with both legs in a step.
    #[param(unit = "m", default = 0.45, range = 0.0..=10.0)]
    radius: f32,
    directions: BeamDirections,
}

#[node]
impl HideWalkers {
    fn process(&mut self, scan: &Scan, pose: Option<&Pose2>, persons: Option<&Persons>, rest: &mut Out<Scan>) {
        let rest = rest.get_mut();
        rest.clone_from(scan);
        let Some((pose, persons)) = pose.filter(|pose| pose.is_usable()).zip(persons) else { return };
        for person in persons.iter().filter(|person| person.velocity.norm() >= self.walking) {
            let place = pose.to_inner(person.position);
            for (beam, point) in self.directions.points(scan) {
                if (point - place).norm_squared() <= self.radius * self.radius {
                    rest.ranges[beam] = f32::NAN;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{persons::Person, scan::Point2};
    use apex_rt::Construct;
    use core::f32::consts::FRAC_PI_2;

    /// Number of beams of four, which end 2 m away, that are left with a person ahead of a scanner who has a velocity.
    fn left(velocity: f32, pose: Option<Pose2>) -> usize {
        let mut scan = Scan { angle_increment: FRAC_PI_2, range_max: 20.0, ..Scan::default() };
        scan.ranges.extend([2.0; 4]);
        let at = Pose2::new(1.0, 2.0, FRAC_PI_2).to_outer(Point2::new(2.1, 0.2));
        let person = Person { position: at, velocity: Point2::new(0.0, velocity), ..Person::default() };
        let persons: Persons = core::iter::once(person).collect();
        let mut rest = Out::new();
        HideWalkers::construct((0.3, 0.45)).process(&scan, pose.as_ref(), Some(&persons), &mut rest);
        rest.get().expect("a scan").points().count()
    }

    #[test]
    fn who_walks_is_hidden_and_who_stands_is_not() {
        let pose = Pose2::new(1.0, 2.0, FRAC_PI_2);
        assert_eq!([left(0.8, Some(pose)), left(-0.8, Some(pose)), left(0.1, Some(pose))], [3, 3, 4]);
        assert_eq!([left(0.8, None), left(0.8, Some(Pose2::new(f32::NAN, 0.0, 0.0)))], [4, 4]);
        assert_eq!(left(f32::NAN, Some(pose)), 4);
    }
}
