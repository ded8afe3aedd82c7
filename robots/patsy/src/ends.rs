use apex_nodes::{math::normalize_angle, nav::turned, scan::Pose2};
use apex_rt::{Event, node};
use core::f32::consts::{FRAC_PI_2, PI};

/// Chooses the end of a container from which the vehicle approaches it: either of them, but after an approach that
/// failed the other one, as what stands before one end seldom stands before both.
///
/// `pose` is that of the vehicle on the plan, and ⊥ while it is not known. `begin` takes the pose of a container, whose
/// heading is that of a vehicle beneath it that comes from the better end. `first` is its pose with the heading from
/// the end to try first, and `second` from the one that is also possible; both are the same if only one end is left.
/// `failed` tells that an approach failed: it came from the end that fits the heading of the vehicle. The next `begin`
/// of the same container leaves that end out. One failure leaves out one end once: after it either end counts again.
#[node]
#[derive(Debug, Clone)]
pub struct Ends {
    /// Largest distance between two poses of the same container.
    #[param(unit = "m", default = 0.5, range = 0.0..=10.0)]
    same: f32,
    /// Last known pose of the vehicle.
    pose: Option<Pose2>,
    container: Option<Pose2>,
    /// Pose of the container with the heading of the approach that failed.
    tried: Option<Pose2>,
}

#[node]
impl Ends {
    fn process(&mut self, pose: Option<&Pose2>) {
        self.pose = pose.copied().or(self.pose);
    }

    /// The approach to the container failed.
    #[slot]
    fn failed(&mut self) {
        let from = |(container, vehicle): (Pose2, Pose2)| {
            let is_turned = normalize_angle(&(vehicle.theta - container.theta)).abs() > FRAC_PI_2;
            turned(&container, if is_turned { PI } else { 0.0 })
        };
        self.tried = self.container.zip(self.pose).map(from);
    }

    /// Begins with a container.
    #[slot]
    fn begin(&mut self, container: &Pose2, first: Event<Pose2>, second: Event<Pose2>) {
        self.container = Some(*container);
        let is_same = |tried: &Pose2| (tried.position() - container.position()).norm() <= self.same;
        let left = self.tried.take().filter(is_same).map(|tried| turned(&tried, PI));
        first.emit(left.unwrap_or(*container));
        second.emit(left.unwrap_or_else(|| turned(container, PI)));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use apex_rt::{Construct as _, event};

    const CONTAINER: Pose2 = Pose2::new(5.0, 2.0, 0.5);

    /// Headings of the ends that are left, relative to the heading of the container.
    fn begin(node: &mut Ends, container: Pose2) -> [f32; 2] {
        let (mut first, mut second) = (None, None);
        node.begin(&container, event(&mut first), event(&mut second));
        [first, second].map(|end| {
            let end = end.expect("an end");
            assert!((end.position() - container.position()).norm() < 1e-5);
            normalize_angle(&(end.theta - container.theta)).abs()
        })
    }

    /// Begins, fails in an approach with a heading relative to the container, and begins again.
    fn again(heading: f32) -> [f32; 2] {
        let mut node = Ends::construct((0.5,));
        node.process(Some(&Pose2::new(1.0, 1.0, 0.0)));
        begin(&mut node, CONTAINER);
        node.process(Some(&Pose2::new(3.0, 1.0, CONTAINER.theta + heading)));
        node.process(None);
        node.failed();
        begin(&mut node, CONTAINER)
    }

    fn close(ends: [f32; 2], expected: [f32; 2]) -> bool {
        ends.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-5)
    }

    #[test]
    fn after_a_failure_only_the_other_end_is_left() {
        for heading in [0.0, 0.3, -1.2] {
            assert!(close(again(heading), [PI, PI]), "{heading}");
            assert!(close(again(heading + PI), [0.0, 0.0]), "{heading}");
        }
    }

    #[test]
    fn either_end_counts_without_a_failure_and_after_another_one() {
        let mut node = Ends::construct((0.5,));
        node.process(Some(&CONTAINER));
        assert!(close(begin(&mut node, CONTAINER), [0.0, PI]));
        assert!(close(begin(&mut node, CONTAINER), [0.0, PI]), "no way led there");
        node.failed();
        assert!(close(begin(&mut node, Pose2::new(9.0, 2.0, 0.0)), [0.0, PI]), "another container");
        node.failed();
        begin(&mut node, Pose2::new(9.0, 2.0, 0.0));
        assert!(close(begin(&mut node, Pose2::new(9.0, 2.0, 0.0)), [0.0, PI]), "one failure counts once");
    }

    #[test]
    fn without_a_pose_either_end_counts() {
        let mut node = Ends::construct((0.5,));
        begin(&mut node, CONTAINER);
        node.failed();
        assert!(close(begin(&mut node, CONTAINER), [0.0, PI]));
    }
}
