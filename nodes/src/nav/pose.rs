use crate::scan::Pose2;
use apex_rt::node;

/// Pose in an outer frame: `inner` is relative to `pose`, and the output is in the frame of `pose`.
#[node]
pub fn compose(pose: &Pose2, inner: &Pose2) -> Pose2 {
    pose.compose(inner)
}

/// Pose relative to another one in the same frame: `pose` in the frame of `reference`.
#[node]
pub fn relative(pose: &Pose2, reference: &Pose2) -> Pose2 {
    pose.relative_to(reference)
}

/// Pose moved along its own heading by `distance`: forward, or back if it is negative. So a robot lines up behind an
/// object with `distance = -2m`.
#[node]
pub fn shift(pose: &Pose2, #[param(unit = "m", range = -1000.0..=1000.0)] distance: f32) -> Pose2 {
    pose.compose(&Pose2::new(distance, 0.0, 0.0))
}

/// Pose turned on the spot by `angle`. So the other end of an object is that of its pose turned by 180°.
#[node]
pub fn turned(pose: &Pose2, #[param(unit = "rad", range = -6.3..=6.3)] angle: f32) -> Pose2 {
    pose.compose(&Pose2::new(0.0, 0.0, angle))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_undoes_the_other() {
        let (a, b) = (Pose2::new(1.0, 2.0, 0.5), Pose2::new(-0.5, 0.3, 1.0));
        let back = relative(&compose(&a, &b), &a);
        assert!((back.position() - b.position()).norm() < 1e-6 && (back.theta - b.theta).abs() < 1e-6);
        let round = relative(&shift(&turned(&a, 0.5), 2.0), &a);
        assert!((round.theta - 0.5).abs() < 1e-6 && (round.position().angle() - 0.5).abs() < 1e-6);
        let behind = relative(&shift(&a, -2.0), &a);
        assert!((behind.x + 2.0).abs() < 1e-6 && behind.y.abs() < 1e-6 && behind.theta == 0.0);
    }
}
