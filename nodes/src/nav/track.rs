//! Poses of stationary objects seen from a moving robot.

use super::latest::is_young;
use crate::{
    math::normalize_angle,
    scan::{FarFromOrigin, Pose2},
};
use apex_rt::{Ctx, Time, node};
use core::f32::consts::PI;

/// Tracks the pose of a stationary object relative to the moving robot (thesis 8.1.1: a filter of the target).
///
/// `robot` is the pose of the robot in any fixed frame, such as that of odometry. `seen` is the detected pose in the
/// frame of the robot, and ⊥ between detections. The output is in the frame of the robot. Detections near each other
/// are averaged; one farther away than `gate` replaces the mean. The output is ⊥ once the last detection is as old as
/// `max_age`, and while `robot` is not known. Fails on a pose that is more than 100 km from the origin.
#[node]
#[derive(Debug, Clone)]
pub struct TrackPose {
    /// Time for which the pose stays known without a detection.
    #[param(unit = "s", default = 1.0, range = 0.01..=600.0)]
    max_age: f32,
    /// Weight of a new detection in the mean.
    #[param(default = 0.4, range = 0.01..=1.0)]
    share: f32,
    /// Maximum distance from the mean. A detection farther away belongs to another object.
    #[param(unit = "m", default = 0.3, range = 0.0..=100.0)]
    gate: f32,
    /// Mean in the frame of `robot`, and the time of the last detection.
    known: Option<(Pose2, Time)>,
}

#[node]
impl TrackPose {
    fn process(&mut self, ctx: &Ctx, robot: &Pose2, seen: Option<&Pose2>) -> Result<Option<Pose2>, FarFromOrigin> {
        if robot.is_far() || seen.is_some_and(Pose2::is_far) {
            return Err(FarFromOrigin);
        }
        Ok(self.track(ctx, robot, seen))
    }

    fn track(&mut self, ctx: &Ctx, robot: &Pose2, seen: Option<&Pose2>) -> Option<Pose2> {
        if !robot.is_finite() {
            return None;
        }
        if let Some(seen) = seen.filter(|pose| pose.is_usable()) {
            self.known = Some((self.mean(robot.compose(seen)), ctx.stamp()));
        }
        self.known = self.known.filter(|(_, stamp)| is_young(ctx, *stamp, self.max_age));
        self.known.map(|(pose, _)| pose.relative_to(robot))
    }

    fn mean(&self, seen: Pose2) -> Pose2 {
        let Some((mean, _)) = self.known else { return seen };
        let change = seen.position() - mean.position();
        if change.norm() > self.gate {
            return seen;
        }
        let place = mean.position() + change.scaled(self.share);
        let turn = normalize_angle(&(seen.theta - mean.theta));
        Pose2::new(place.x, place.y, normalize_angle(&(mean.theta + self.share * turn)))
    }

    /// Forgets the tracked object.
    #[slot]
    fn reset(&mut self) {
        self.known = None;
    }
}

/// Pose at a distance before an object, facing it. `pose` is the pose of the object, whose x axis points towards the
/// viewer.
#[node]
pub fn stand_before(pose: &Pose2, #[param(unit = "m", default = 1.0, range = 0.0..=100.0)] distance: f32) -> Pose2 {
    pose.compose(&Pose2::new(distance, 0.0, PI))
}

#[cfg(test)]
mod tests {
    use super::*;
    use apex_rt::Construct;

    fn at(ms: i64) -> Ctx {
        Ctx::new(Time::from_millis(ms))
    }

    fn close(a: Option<Pose2>, b: Pose2) -> bool {
        let turn = |a: Pose2| normalize_angle(&(a.theta - b.theta)).abs();
        a.is_some_and(|a| (a.position() - b.position()).norm() < 1e-5 && turn(a) < 1e-5)
    }

    #[test]
    fn a_thing_stays_where_it_is_while_the_robot_moves() {
        let mut node = TrackPose::construct((1.0, 0.4, 0.3));
        assert_eq!(node.track(&at(0), &Pose2::default(), None), None);
        let thing = Pose2::new(2.0, 1.0, 3.0);
        assert!(close(node.track(&at(0), &Pose2::default(), Some(&thing)), thing));
        let robot = Pose2::new(0.5, -0.2, 0.7);
        assert!(close(node.track(&at(400), &robot, None), thing.relative_to(&robot)));
        assert!(node.track(&at(999), &robot, None).is_some());
        assert_eq!(node.track(&at(1000), &robot, None), None, "it is too old");
    }

    #[test]
    fn sightings_are_averaged_unless_they_are_far_apart() {
        let mut node = TrackPose::construct((1.0, 0.5, 0.3));
        let mut see = |ms, x, theta| node.track(&at(ms), &Pose2::default(), Some(&Pose2::new(x, 0.0, theta)));
        see(0, 1.0, 3.1);
        assert!(close(see(40, 1.2, -3.1), Pose2::new(1.1, 0.0, PI)), "also where angles wrap around");
        assert!(close(see(80, 2.0, 1.0), Pose2::new(2.0, 0.0, 1.0)));
    }

    #[test]
    fn what_is_no_number_is_not_seen() {
        let mut node = TrackPose::construct((1.0, 0.5, 0.3));
        let nan = Pose2::new(f32::NAN, 0.0, 0.0);
        assert_eq!(node.track(&at(0), &Pose2::default(), Some(&nan)), None);
        node.track(&at(0), &Pose2::default(), Some(&Pose2::default()));
        assert_eq!(node.track(&at(0), &nan, None), None);
        node.reset();
        assert_eq!(node.track(&at(0), &Pose2::default(), None), None);
    }

    #[test]
    fn who_stands_before_something_looks_at_it() {
        let place = stand_before(&Pose2::new(1.0, 2.0, 0.5 * PI), 0.5);
        assert!(
            close(Some(place), Pose2::new(1.0, 2.5, 1.5 * PI)) || close(Some(place), Pose2::new(1.0, 2.5, -0.5 * PI))
        );
    }
}
