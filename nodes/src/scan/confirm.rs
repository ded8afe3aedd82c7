use super::{Container, Pose2};
use apex_rt::node;
use core::f32::consts::{FRAC_PI_2, PI};
use heapless::Deque;

/// Maximum number of remembered detections.
const MAX_DETECTIONS: usize = 32;

/// Confirms a container that is detected repeatedly: passes a detection on if at least `required` of the last
/// `window` scans, this one included, show it at the same pose. Otherwise ⊥.
///
/// Poses are compared in the frame of the scanner, so between two scans the robot must move less than `max_distance`.
/// Opposite headings agree, as a container looks the same from both ends.
#[node]
#[derive(Debug, Clone)]
pub struct ConfirmContainer {
    /// Minimum number of agreeing detections (k of n).
    #[param(default = 3, range = 1..=32)]
    required: usize,
    /// Number of scans in which they have to be (n).
    #[param(default = 5, range = 1..=32)]
    window: usize,
    /// Maximum distance between agreeing detections.
    #[param(unit = "m", default = 0.3, range = 0.0..=10.0)]
    max_distance: f32,
    /// Maximum difference of the headings of agreeing detections.
    #[param(unit = "rad", default = 0.4, range = 0.0..=3.2)]
    max_angle: f32,
    /// Detections in the last scans, the newest at the back.
    last: Deque<Option<Pose2>, MAX_DETECTIONS>,
}

#[node]
impl ConfirmContainer {
    fn process(&mut self, container: Option<&Container>) -> Option<Container> {
        while self.last.len() >= self.window.clamp(1, MAX_DETECTIONS) {
            self.last.pop_front();
        }
        // There is room: the oldest one has just been removed.
        let _ = self.last.push_back(container.map(|container| container.pose));
        let container = *container?;
        let agreeing = self.last.iter().flatten().filter(|pose| self.agree(pose, &container.pose)).count();
        (agreeing >= self.required).then_some(container)
    }

    fn agree(&self, a: &Pose2, b: &Pose2) -> bool {
        let difference = a.relative_to(b);
        let turn = difference.theta.abs();
        let turn = if turn > FRAC_PI_2 { PI - turn } else { turn };
        difference.position().norm() <= self.max_distance && turn <= self.max_angle
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use apex_rt::Construct;

    fn container(x: f32, theta: f32) -> Container {
        Container { pose: Pose2::new(x, 0.0, theta), error: 0.0, inliers: 5, outliers: 0, wheels: 4, model: 0 }
    }

    fn confirmed(required: usize, window: usize, scans: &[Option<Container>]) -> std::vec::Vec<bool> {
        let mut node = ConfirmContainer::construct((required, window, 0.2, 0.2));
        scans.iter().map(|container| node.process(container.as_ref()).is_some()).collect()
    }

    #[test]
    fn enough_of_the_last_detections_have_to_agree() {
        let (here, there) = (Some(container(2.0, 0.0)), Some(container(3.0, 0.0)));
        assert_eq!(confirmed(2, 3, &[here, None, here, None, None, here]), [false, false, true, false, false, false]);
        assert_eq!(confirmed(2, 3, &[here, there, here]), [false, false, true]);
        assert_eq!(confirmed(2, 2, &[here, there, here]), [false; 3]);
        assert_eq!(confirmed(1, 1, &[None, here]), [false, true]);
    }

    #[test]
    fn opposite_headings_agree_and_others_do_not() {
        let at = |theta| Some(container(2.0, theta));
        assert_eq!(confirmed(2, 2, &[at(0.0), at(3.1)]), [false, true]);
        assert_eq!(confirmed(2, 2, &[at(0.0), at(1.0)]), [false, false]);
        assert_eq!(confirmed(2, 2, &[at(f32::NAN), at(f32::NAN)]), [false, false]);
    }

    #[test]
    fn odd_parameters_never_panic() {
        assert_eq!(confirmed(0, 0, &[None, Some(container(1.0, 0.0))]), [false, true]);
        assert_eq!(confirmed(99, 99, &[Some(container(1.0, 0.0)); 40]), [false; 40]);
    }
}
