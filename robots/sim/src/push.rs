use apex_nodes::{
    math::normalize_angle,
    scan::{Point2, Pose2},
};

/// Pose of a body that rolls freely, after it was pushed by `way` at the point `at`, all in m and in one frame.
///
/// `gyration` is its radius of gyration in m: a push beside the middle turns the body the more, and moves it the less,
/// the longer the lever is in comparison.
pub fn pushed(body: &Pose2, at: Point2, way: Point2, gyration: f32) -> Pose2 {
    let length = way.norm();
    if length <= 0.0 || gyration <= 0.0 {
        return *body;
    }
    let along = way.scaled(1.0 / length);
    let arm = at - body.position();
    // Positive if the push turns the body counter-clockwise.
    let lever = along.dot(arm.perpendicular());
    let inertia = gyration * gyration + lever * lever;
    let middle = body.position() + way.scaled(gyration * gyration / inertia);
    Pose2::new(middle.x, middle.y, normalize_angle(&(body.theta + length * lever / inertia)))
}

#[cfg(test)]
mod tests {
    use super::*;

    const BODY: Pose2 = Pose2::new(2.0, 1.0, 0.3);

    #[test]
    fn a_push_through_the_middle_only_moves_a_body() {
        let after = pushed(&BODY, Point2::new(1.0, 1.0), Point2::new(0.1, 0.0), 0.4);
        assert!((after.x - 2.1).abs() < 1e-6 && after.y == 1.0, "{after:?}");
        assert!((after.theta - BODY.theta).abs() < 1e-6, "{after:?}");
    }

    #[test]
    fn a_push_beside_the_middle_turns_a_body() {
        // Forward at its right side: to the left, that is, counter-clockwise.
        let right = pushed(&BODY, Point2::new(1.0, 0.6), Point2::new(0.1, 0.0), 0.4);
        let left = pushed(&BODY, Point2::new(1.0, 1.4), Point2::new(0.1, 0.0), 0.4);
        assert!((right.theta - 0.3 - 0.125).abs() < 1e-5 && (left.theta - 0.3 + 0.125).abs() < 1e-5, "{right:?}");
        assert!((right.x - 2.05).abs() < 1e-5 && right.y == 1.0, "half of the push moves it: {right:?}");
    }

    #[test]
    fn the_point_that_is_pushed_goes_as_far_as_the_push() {
        let (at, way) = (Point2::new(1.2, 0.5), Point2::new(0.001, 0.002));
        let after = pushed(&BODY, at, way, 0.4);
        let moved = after.to_outer(BODY.to_inner(at)) - at;
        let along = way.scaled(1.0 / way.norm());
        assert!((moved.dot(along) - way.norm()).abs() < 1e-5, "{moved:?}");
    }

    #[test]
    fn no_push_changes_nothing() {
        assert_eq!(pushed(&BODY, Point2::new(1.0, 0.0), Point2::default(), 0.4), BODY);
    }
}
