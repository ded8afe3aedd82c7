use crate::scan::Point2;
use libm::{fabsf, remainderf};

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
    /// Signed distance of the position from the path, in m, positive to the left (x_n).
    pub offset: f32,
    /// Length of the path from the projection to the goal, in m.
    pub remaining: f32,
}

impl Path {
    /// The last point, or `None` if the path is empty.
    pub fn goal(&self) -> Option<Point2> {
        self.points.last().copied()
    }

    /// Length of the path from the start to the goal, in m.
    pub fn length(&self) -> f32 {
        length(&self.points)
    }

    /// Projects a position onto the nearest point of the path, searched on `reach` m of the path from the point with
    /// the index `from` on. So a robot stays on its part of a path that comes back to itself.
    ///
    /// Returns `None` if the path has no points there, or if a coordinate is not finite.
    pub fn project(&self, position: Point2, from: usize, reach: f32) -> Option<Projection> {
        let from = from.min(self.points.len().saturating_sub(2));
        let mut nearest: Option<(f32, usize, Point2)> = None;
        let mut passed = 0.0;
        for (segment, ends) in self.points.windows(2).enumerate().skip(from) {
            let point = nearest_on(ends[0], ends[1], position);
            let distance = (position - point).norm_squared();
            if distance.is_finite() && nearest.is_none_or(|(least, ..)| distance < least) {
                nearest = Some((distance, segment, point));
            }
            passed += (ends[1] - ends[0]).norm();
            if passed > reach {
                break;
            }
        }
        let (_, segment, point) = nearest?;
        let end = self.points[segment + 1];
        let along = end - self.points[segment];
        let side = along.perpendicular().dot(position - point);
        let offset = (position - point).norm().copysign(side);
        let remaining = (end - point).norm() + length(&self.points[segment + 1..]);
        remaining.is_finite().then_some(Projection { segment, point, tangent: along.angle(), offset, remaining })
    }

    /// Total turning of the path within `reach` m after a projection, in rad, regardless of the side: the sum over the
    /// curvatures of its points, each multiplied by the length of path that the point stands for.
    pub fn turning(&self, projection: &Projection, reach: f32) -> f32 {
        let mut passed = 0.0;
        let mut turning = 0.0;
        let mut last = projection.point;
        for (i, point) in self.points.iter().enumerate().skip(projection.segment + 1) {
            passed += (*point - last).norm();
            if passed > reach {
                break;
            }
            turning += fabsf(self.curvature(i)) * self.share(i);
            last = *point;
        }
        turning
    }

    /// Curvature at a point, in rad/m, positive to the left: the angle between the segments before and after it,
    /// divided by the length of path that the point stands for. It is 0 at both ends and where points coincide.
    pub fn curvature(&self, i: usize) -> f32 {
        let around = i.checked_sub(1).and_then(|first| self.points.get(first..)).and_then(|rest| rest.first_chunk());
        let Some([before, at, after]) = around else { return 0.0 };
        let (a, b) = (*at - *before, *after - *at);
        if a.norm_squared() == 0.0 || b.norm_squared() == 0.0 {
            return 0.0;
        }
        remainderf(b.angle() - a.angle(), core::f32::consts::TAU) / self.share(i)
    }

    /// Length of path that a point stands for, in m: half of the two segments at the point.
    fn share(&self, i: usize) -> f32 {
        0.5 * length(&self.points[i.saturating_sub(1)..(i + 2).min(self.points.len())])
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
        let left = path.project(Point2::new(0.5, 0.25), 0, 10.0).expect("a point");
        assert_eq!((left.segment, left.point, left.tangent), (0, Point2::new(0.5, 0.0), 0.0));
        assert_eq!((left.offset, left.remaining, path.length()), (0.25, 4.5, 5.0));
        let right = path.project(Point2::new(2.5, 1.0), 0, 10.0).expect("a point");
        assert_eq!((right.segment, right.tangent, right.offset, right.remaining), (1, FRAC_PI_2, -0.5, 2.0));
    }

    #[test]
    fn a_robot_stays_on_its_part_of_the_path() {
        // There and back, 10 cm apart.
        let path = path(&[(0.0, 0.0), (5.0, 0.0), (5.0, 0.1), (0.0, 0.1)]);
        let at = Point2::new(1.0, 0.08);
        assert_eq!(path.project(at, 0, 2.0).map(|p| p.segment), Some(0));
        assert_eq!(path.project(at, 0, 20.0).map(|p| p.segment), Some(2));
        assert_eq!(path.project(at, 2, 2.0).map(|p| p.segment), Some(2));
        assert_eq!(path.project(at, 99, 2.0).map(|p| p.segment), Some(2));
    }

    #[test]
    fn odd_paths_have_no_projection_and_no_curvature() {
        for odd in [path(&[]), path(&[(1.0, 1.0)]), path(&[(0.0, 0.0), (f32::NAN, 0.0)])] {
            assert_eq!(odd.project(Point2::default(), 0, 1.0), None);
            assert_eq!((odd.curvature(0), odd.curvature(1), odd.curvature(usize::MAX)), (0.0, 0.0, 0.0));
        }
        let point = path(&[(1.0, 1.0), (1.0, 1.0), (1.0, 1.0)]);
        assert_eq!(point.project(Point2::default(), 0, 1.0).map(|p| p.remaining), Some(0.0));
        assert_eq!(point.curvature(1), 0.0);
        assert_eq!(path(&[(0.0, 0.0), (1.0, 0.0)]).project(Point2::new(f32::NAN, 0.0), 0, 1.0), None);
    }

    #[test]
    fn a_circle_has_the_curvature_of_its_radius() {
        let circle =
            Path { points: (0..=100).map(|i| Point2::polar(4.0, 0.5 * PI * i as f32 / 100.0)).collect(), heading: 0.0 };
        assert!((1..100).all(|i| (circle.curvature(i) - 0.25).abs() < 1e-3));
        let start = circle.project(Point2::new(4.0, 0.0), 0, 1.0).expect("a point");
        // 2 m of the circle are half a radian.
        assert!((circle.turning(&start, 2.0) - 0.5).abs() < 0.02);
        assert!((circle.turning(&start, 100.0) - FRAC_PI_2).abs() < 0.02);
    }
}
