use crate::scan::{Point2, wrap_angle};
use libm::fabsf;

/// A path in the plane, in the frame of the map that it was planned on.
#[derive(Debug, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Path {
    /// Points from the start to the goal, in m.
    pub points: Vec<Point2>,
    /// Heading at the goal, in rad.
    pub heading: f32,
}

/// Orthogonal projection of a position onto a path (thesis fig. 4.8).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Projection {
    /// Segment that contains the projection: index of the point of the path at which it begins.
    pub segment: usize,
    /// Projected point, in m.
    pub point: Point2,
    /// Direction of the path at the projection, in rad (θ_t).
    pub tangent: f32,
    /// Signed distance of the position from the straight line through the segment, in m, positive to the left (x_n).
    pub offset: f32,
    /// Distance of the position from the projected point, in m. It is more than the offset before the beginning of the
    /// segment and behind its end.
    pub distance: f32,
    /// Length of the path from the projection to the goal, in m.
    pub remaining: f32,
    /// Next point that a robot has to come near to: index of the next sharp corner, or of the goal.
    pub stop: usize,
    /// Length of the path from the projection to that point, in m.
    pub to_stop: f32,
}

/// Cosine of the angle, 100°, from which on a corner is sharp: more than a right angle, also after rounding.
const SHARP: f32 = -0.173_648;

impl Path {
    /// The last point, or `None` if the path is empty.
    pub fn goal(&self) -> Option<Point2> {
        self.points.last().copied()
    }

    /// Takes over another path, to follow it. One of a single point leads straight to it.
    pub(super) fn take(&mut self, path: &Self) {
        self.clone_from(path);
        if let [point] = self.points[..] {
            self.points.push(point);
        }
    }

    /// Length of the path from the start to the goal, in m.
    pub fn length(&self) -> f32 {
        length(&self.points)
    }

    /// Projects the position of a robot that was on the segment with the index `from`. The robot leaves a segment once
    /// it is beyond its end. It has to come within `tolerance` m of a sharp corner, and passes the points on the last
    /// piece before a stop, twice that long, together: there it drives straight to the stop.
    ///
    /// So the projection advances with the robot alone. It does not jump to another part of the path that comes near,
    /// leaves no part out, and does not go back to an earlier segment. Beyond a corner, it is at the beginning of the
    /// next segment, so that its tangent leads round the corner.
    ///
    /// Returns `None` if the path has less than two points, or if a coordinate is not finite.
    pub fn project(&self, position: Point2, from: usize, tolerance: f32) -> Option<Projection> {
        let last = self.points.len().checked_sub(2)?;
        let mut segment = from.min(last);
        loop {
            while segment < last && !self.is_sharp(segment + 1) && self.is_beyond(segment, position) {
                segment += 1;
            }
            let projection = self.project_on(position, segment);
            let stop = projection.stop;
            let is_before_stop = segment + 1 == stop;
            if !is_before_stop && projection.to_stop <= 2.0 * tolerance {
                segment = stop - 1;
            } else if is_before_stop && stop <= last && (position - self.points[stop]).norm() <= tolerance {
                segment = stop;
            } else {
                return (projection.distance + projection.remaining).is_finite().then_some(projection);
            }
        }
    }

    /// Projects a position onto a segment.
    fn project_on(&self, position: Point2, segment: usize) -> Projection {
        let (start, end) = (self.points[segment], self.points[segment + 1]);
        let point = nearest_on(start, end, position);
        let tangent = (end - start).angle();
        let goal = self.points.len() - 1;
        let stop = (segment + 1..goal).find(|i| self.is_sharp(*i)).unwrap_or(goal);
        let to_stop = (end - point).norm() + length(&self.points[segment + 1..=stop]);
        Projection {
            segment,
            point,
            tangent,
            offset: Point2::polar(1.0, tangent).perpendicular().dot(position - start),
            distance: (position - point).norm(),
            remaining: to_stop + length(&self.points[stop..]),
            stop,
            to_stop,
        }
    }

    /// Returns `true` if a position is beyond the end of a segment.
    fn is_beyond(&self, segment: usize, position: Point2) -> bool {
        let (start, end) = (self.points[segment], self.points[segment + 1]);
        (position - end).dot(end - start) >= 0.0
    }

    /// Returns `true` if the path turns by more than 100° at a point.
    fn is_sharp(&self, i: usize) -> bool {
        let Some((before, after)) = self.legs(i) else { return false };
        before.dot(after) < SHARP * before.norm() * after.norm()
    }

    /// Point at a distance along the path after a projection, in m, or before it if that is negative. Beyond its ends
    /// the path goes on straight.
    pub fn ahead(&self, projection: &Projection, distance: f32) -> Point2 {
        let (before, after) = self.points.split_at(projection.segment + 1);
        let direction = Point2::polar(1.0, projection.tangent);
        if distance < 0.0 {
            along(projection.point, direction.scaled(-1.0), before.iter().rev(), -distance)
        } else {
            along(projection.point, direction, after.iter(), distance)
        }
    }

    /// Total turning of the path within `reach` m after a projection and before its stop, in rad, regardless of the
    /// side.
    pub fn turning(&self, projection: &Projection, reach: f32) -> f32 {
        let mut passed = 0.0;
        let mut turning = 0.0;
        let mut last = projection.point;
        for (i, point) in self.points.iter().enumerate().take(projection.stop).skip(projection.segment + 1) {
            passed += (*point - last).norm();
            if passed > reach {
                break;
            }
            turning += fabsf(self.turn(i));
            last = *point;
        }
        turning
    }

    /// Angle by which the path turns at a point, in rad, positive to the left. It is 0 at both ends. Of points that
    /// coincide, it is that of the first one.
    pub fn turn(&self, i: usize) -> f32 {
        let Some((before, after)) = self.legs(i) else { return 0.0 };
        wrap_angle(after.angle() - before.angle())
    }

    /// Segment that ends at a point, and the next one that has a length.
    fn legs(&self, i: usize) -> Option<(Point2, Point2)> {
        let at = *self.points.get(i)?;
        let before = at - self.points[i.checked_sub(1)?];
        if before == Point2::default() {
            return None;
        }
        let next = self.points[i + 1..].iter().find(|point| **point != at)?;
        Some((before, *next - at))
    }
}

impl Clone for Path {
    fn clone(&self) -> Self {
        Self { points: self.points.clone(), heading: self.heading }
    }

    /// Same as [`clone`](Self::clone), but reuses the allocated storage.
    fn clone_from(&mut self, other: &Self) {
        self.points.clone_from(&other.points);
        self.heading = other.heading;
    }
}

/// Point at a distance from `from` on the way through `points`, which goes on straight beyond the last one: in
/// `direction` if there is none.
fn along<'a>(
    from: Point2,
    mut direction: Point2,
    points: impl Iterator<Item = &'a Point2>,
    mut distance: f32,
) -> Point2 {
    let mut at = from;
    for point in points {
        let way = *point - at;
        let length = way.norm();
        if length >= distance {
            return at + way.scaled(distance / length.max(f32::MIN_POSITIVE));
        }
        if length > 0.0 {
            direction = way.scaled(1.0 / length);
        }
        (at, distance) = (*point, distance - length);
    }
    at + direction.scaled(distance)
}

fn length(points: &[Point2]) -> f32 {
    points.windows(2).map(|ends| (ends[1] - ends[0]).norm()).sum()
}

/// Point of the segment from `a` to `b` that is nearest to a position.
pub(super) fn nearest_on(a: Point2, b: Point2, position: Point2) -> Point2 {
    let along = b - a;
    let t = (position - a).dot(along) / along.norm_squared();
    // NaN if both ends coincide.
    if t.is_nan() { a } else { a + along.scaled(t.clamp(0.0, 1.0)) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f32::consts::{FRAC_PI_2, PI};

    fn path(points: &[(f32, f32)]) -> Path {
        Path { points: points.iter().map(|&(x, y)| Point2::new(x, y)).collect(), heading: 0.0 }
    }

    #[test]
    fn projections_are_orthogonal() {
        let path = path(&[(0.0, 0.0), (2.0, 0.0), (2.0, 3.0)]);
        let left = path.project(Point2::new(0.5, 0.25), 0, 0.1).expect("a point");
        assert_eq!((left.segment, left.point, left.tangent), (0, Point2::new(0.5, 0.0), 0.0));
        assert_eq!((left.offset, left.distance, left.remaining, path.length()), (0.25, 0.25, 4.5, 5.0));
        let right = path.project(Point2::new(2.5, 1.0), 0, 0.1).expect("a point");
        assert_eq!((right.segment, right.tangent, right.remaining), (1, FRAC_PI_2, 2.0));
        assert!((right.offset + 0.5).abs() < 1e-6);
        // Before the beginning, on the line through the first segment.
        let before = path.project(Point2::new(-1.0, 0.0), 0, 0.1).expect("a point");
        assert_eq!((before.segment, before.offset, before.distance, before.remaining), (0, 0.0, 1.0, 5.0));
    }

    #[test]
    fn a_robot_stays_on_its_part_of_the_path() {
        // There and back, 10 cm apart.
        let path = path(&[(0.0, 0.0), (5.0, 0.0), (5.0, 0.1), (0.0, 0.1)]);
        let at = Point2::new(1.0, 0.08);
        for (from, segment) in [(0, 0), (1, 1), (2, 2), (99, 2)] {
            assert_eq!(path.project(at, from, 0.1).map(|p| p.segment), Some(segment));
        }
        // Beside the end of the way there, beyond that of the way across.
        assert_eq!(path.project(Point2::new(5.1, 0.3), 0, 0.1).map(|p| p.segment), Some(2));
    }

    #[test]
    fn a_segment_is_left_at_its_end_however_long_it_is() {
        let path = path(&[(0.0, 0.0), (20.0, 0.0), (20.0, 20.0)]);
        let segment = |x, y| path.project(Point2::new(x, y), 0, 0.1).map(|p| (p.segment, p.point.x));
        assert_eq!(segment(19.9, 0.3), Some((0, 19.9)));
        assert_eq!(segment(20.1, 0.3), Some((1, 20.0)));
    }

    #[test]
    fn a_sharp_corner_is_passed_within_the_tolerance() {
        // The corner stands there twice.
        let path = path(&[(0.0, 0.0), (1.0, 0.0), (1.0, 0.0), (0.0, 0.1), (0.0, 5.0)]);
        let at = |x, y| path.project(Point2::new(x, y), 0, 0.05).expect("a point");
        for (x, y) in [(0.5, 0.05), (0.94, 0.0), (1.1, 0.0), (1.0, 0.06)] {
            let (segment, stop) = (at(x, y).segment, at(x, y).stop);
            assert_eq!((segment, stop), (0, 1), "({x}, {y})");
        }
        assert!((at(0.94, 0.0).to_stop - 0.06).abs() < 1e-6);
        for (x, y) in [(0.96, 0.0), (1.04, 0.0), (1.0, -0.04)] {
            assert_eq!((at(x, y).segment, at(x, y).stop), (2, 4), "({x}, {y})");
        }
        // Beyond the corner, the tangent leads back.
        assert!(at(1.04, 0.0).tangent > FRAC_PI_2);
        // The turn at the second corner is less than a right angle.
        assert!((path.turn(3) + 1.471).abs() < 1e-3 && path.turn(2) == 0.0 && path.turn(1) > 3.0);
    }

    #[test]
    fn odd_paths_have_no_projection_and_do_not_turn() {
        for odd in [path(&[]), path(&[(1.0, 1.0)]), path(&[(0.0, 0.0), (f32::NAN, 0.0)])] {
            assert_eq!(odd.project(Point2::default(), 0, 0.1), None);
            assert_eq!((odd.turn(0), odd.turn(1), odd.turn(usize::MAX)), (0.0, 0.0, 0.0));
        }
        let point = path(&[(1.0, 1.0), (1.0, 1.0), (1.0, 1.0)]);
        assert_eq!(point.project(Point2::default(), 0, 0.1).map(|p| p.remaining), Some(0.0));
        assert_eq!(point.turn(1), 0.0);
        assert_eq!(path(&[(0.0, 0.0), (1.0, 0.0)]).project(Point2::new(f32::NAN, 0.0), 0, 0.1), None);
    }

    #[test]
    fn a_circle_turns_by_the_angle_of_its_arc() {
        let circle =
            Path { points: (0..=100).map(|i| Point2::polar(4.0, 0.5 * PI * i as f32 / 100.0)).collect(), heading: 0.0 };
        assert!((1..100).all(|i| (circle.turn(i) - 0.005 * PI).abs() < 1e-3));
        let start = circle.project(Point2::new(4.0, 0.0), 0, 0.1).expect("a point");
        // 2 m of the circle are half a radian.
        assert!((circle.turning(&start, 2.0) - 0.5).abs() < 0.02);
        assert!((circle.turning(&start, 100.0) - FRAC_PI_2).abs() < 0.02);
    }
}
