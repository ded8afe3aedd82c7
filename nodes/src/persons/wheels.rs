use super::Legs;
use crate::scan::{Containers, Point2, Pose2};
use apex_rt::{Out, node};

/// Drops legs that are the wheels of containers: castors look like legs, but stand in the area of a container.
///
/// `pose` is that of the scanner in the frame of the containers. Without a finite pose, or without containers, all legs
/// are passed on.
#[node]
#[derive(Debug, Clone)]
pub struct DropWheels {
    /// Length of the area of a container, with the play of its castors.
    #[param(unit = "m", default = 1.4, range = 0.0..=100.0)]
    length: f32,
    /// Width of this area.
    #[param(unit = "m", default = 0.9, range = 0.0..=100.0)]
    width: f32,
}

#[node]
impl DropWheels {
    fn process(&mut self, legs: &Legs, pose: &Pose2, containers: Option<&Containers>, rest: &mut Out<Legs>) {
        let rest = rest.get_mut();
        rest.clone_from(legs);
        if let Some(containers) = containers.filter(|_| pose.is_usable()) {
            rest.list.retain(|leg| !self.is_wheel(pose.to_outer(leg.position), containers));
        }
    }

    fn is_wheel(&self, leg: Point2, containers: &Containers) -> bool {
        containers.poses.iter().any(|container| container.is_in_box(leg, self.length, self.width))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::persons::Leg;
    use apex_rt::Construct;

    #[test]
    fn castors_are_no_legs() {
        let mut containers = Containers::default();
        containers.poses.push(Pose2::new(2.0, 0.0, 0.0)).expect("room");
        // A castor, and a leg beside the container.
        let places = [Point2::new(1.45, 0.3), Point2::new(1.5, 0.8)];
        let left = |pose: Pose2, containers: Option<&Containers>| {
            let (mut legs, mut rest) = (Legs::default(), Out::new());
            for place in places {
                legs.list.push(Leg { position: pose.to_inner(place), probability: 1.0 }).expect("room");
            }
            DropWheels::construct((1.4, 0.9)).process(&legs, &pose, containers, &mut rest);
            rest.get().expect("legs").list.len()
        };
        for pose in [Pose2::default(), Pose2::new(1.0, 0.5, 0.4)] {
            assert_eq!([left(pose, None), left(pose, Some(&containers))], [2, 1]);
        }
        assert_eq!(left(Pose2::new(f32::NAN, 0.0, 0.0), Some(&containers)), 2);
    }
}
