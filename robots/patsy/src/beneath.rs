use apex_nodes::scan::Pose2;
use apex_rt::{Event, node};

/// Looks whether a vehicle is still beneath a container: where it has set a load down, so that it can lift it again, or
/// where it was held.
///
/// `trailer` is the pose of the trailer's axis in a fixed frame such as that of odometry. At `check`, `still` comes if
/// it is within `distance` of that at the last `mark`, and `gone` otherwise, also without these poses.
#[node]
#[derive(Debug, Clone)]
pub struct Beneath {
    /// Largest distance from the marked place: the lift takes a load that is 12 cm away.
    #[param(unit = "m", default = 0.08, range = 0.0..=10.0)]
    distance: f32,
    trailer: Option<Pose2>,
    marked: Option<Pose2>,
}

#[node]
impl Beneath {
    fn process(&mut self, trailer: Option<&Pose2>) {
        self.trailer = trailer.copied();
    }

    /// Remembers the place.
    #[slot]
    fn mark(&mut self) {
        self.marked = self.trailer;
    }

    /// Compares the present place with it.
    #[slot]
    fn check(&mut self, still: Event<()>, gone: Event<()>) {
        let moved = self.marked.zip(self.trailer).map(|(marked, now)| (now.position() - marked.position()).norm());
        if moved.is_some_and(|moved| moved <= self.distance) { still.emit(()) } else { gone.emit(()) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use apex_rt::{Construct as _, event};

    #[test]
    fn it_knows_if_the_vehicle_has_moved() {
        let mut node = Beneath::construct((0.08,));
        let is_still = |node: &mut Beneath, trailer: Option<Pose2>| {
            node.process(trailer.as_ref());
            let (mut still, mut gone) = (None, None);
            node.check(event(&mut still), event(&mut gone));
            assert_ne!(still, gone);
            still.is_some()
        };
        let at = |x: f32| Some(Pose2::new(x, 1.0, 0.3));
        assert!(!is_still(&mut node, at(2.0)), "nothing is marked");
        node.mark();
        assert_eq!([at(2.05), at(1.95), at(2.1), None].map(|now| is_still(&mut node, now)), [true, true, false, false]);
    }
}
