use apex_nodes::{
    math::normalize_angle,
    nav::Articulated,
    scan::{Point2, Pose2},
};
use apex_rt::{Event, node};

/// Looks whether a load may be set down: it is at its destination, and tractor and trailer are in line, so that the
/// vehicle can drive out from beneath it.
///
/// `pose` is that of the tractor on the plan; `odometry` and `trailer` are the poses of the two axes in one frame. At
/// `check`, `right` comes if the load is within the limits, and `askew` otherwise, also without these poses.
#[node]
#[derive(Debug, Clone)]
pub struct Placed {
    /// Largest distance of the load from its destination.
    #[param(unit = "m", default = 0.25, range = 0.0..=10.0)]
    distance: f32,
    /// Largest angle between the load and its destination; its ends are alike.
    #[param(unit = "rad", default = 0.12, range = 0.0..=1.6)]
    turn: f32,
    /// Largest angle between tractor and trailer.
    #[param(unit = "rad", default = 0.1, range = 0.0..=1.6)]
    bend: f32,
    destination: Option<Pose2>,
    /// Pose of the load on the plan, and the angle between tractor and trailer.
    load: Option<(Pose2, f32)>,
}

#[node]
impl Placed {
    fn process(&mut self, pose: Option<&Pose2>, odometry: Option<&Pose2>, trailer: Option<&Pose2>) {
        let hitch = odometry.zip(trailer).map(|(odometry, trailer)| trailer.relative_to(odometry));
        let middle = Pose2::new(Articulated::PATSY.lift(), 0.0, 0.0);
        let load = |(pose, hitch): (&Pose2, Pose2)| (pose.compose(&hitch).compose(&middle), hitch.theta);
        self.load = pose.zip(hitch).map(load);
    }

    /// Sets the destination of the load, on the plan.
    #[slot]
    fn destination(&mut self, destination: &Pose2) {
        self.destination = Some(*destination);
    }

    /// Compares the load with its destination.
    #[slot]
    fn check(&mut self, right: Event<()>, #[failure] askew: Event<()>) {
        let is_right = self.destination.zip(self.load).is_some_and(|(destination, (load, bend))| {
            let Pose2 { x, y, theta } = load.relative_to(&destination);
            let turn = 0.5 * normalize_angle(&(2.0 * theta));
            let is_near = Point2::new(x, y).norm() <= self.distance && turn.abs() <= self.turn;
            is_near && normalize_angle(&bend).abs() <= self.bend
        });
        if is_right { right.emit(()) } else { askew.emit(()) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use apex_rt::{Construct as _, event};
    use core::f32::consts::PI;

    const VEHICLE: Articulated = Articulated::PATSY;

    /// Outcome for a tractor whose axis is `at`, with a trailer that is bent, and a load for the origin.
    fn is_right(at: Pose2, bend: f32) -> bool {
        let mut node = Placed::construct((0.25, 0.09, 0.1));
        let odometry = Pose2::new(7.0, 3.0, 1.0);
        node.destination(&Pose2::default());
        node.process(Some(&at), Some(&odometry), Some(&VEHICLE.trailer(&odometry, odometry.theta - bend)));
        let (mut right, mut askew) = (None, None);
        node.check(event(&mut right), event(&mut askew));
        assert_ne!(right.is_some(), askew.is_some());
        right.is_some()
    }

    #[test]
    fn only_a_straight_load_at_its_destination_is_placed() {
        let x = VEHICLE.axis();
        assert!(is_right(Pose2::new(x, 0.0, 0.0), 0.0) && is_right(Pose2::new(-x - 0.2, 0.05, PI - 0.05), 0.04));
        let wrong = [(x + 0.3, 0.0, 0.0, 0.0), (x, 0.0, 0.2, 0.0), (x, 0.0, 0.0, 0.11), (x, 0.0, 0.0, -0.75)];
        assert!(!wrong.iter().any(|&(x, y, theta, bend)| is_right(Pose2::new(x, y, theta), bend)));
    }

    #[test]
    fn without_poses_nothing_is_placed() {
        let mut node = Placed::construct((0.25, 0.09, 0.1));
        let at = Pose2::default();
        for (pose, trailer) in [(None, Some(&at)), (Some(&at), None)] {
            node.destination(&at);
            node.process(pose, Some(&at), trailer);
            let (mut right, mut askew) = (None, None);
            node.check(event(&mut right), event(&mut askew));
            assert_eq!((right, askew), (None, Some(())));
        }
    }
}
