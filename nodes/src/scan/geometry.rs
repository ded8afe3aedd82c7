use apex_rt::Units;
use core::{
    f32::consts::{PI, TAU},
    fmt,
    ops::{Add, Sub},
};

/// Point or vector in the plane, in m.
#[derive(Debug, Clone, Copy, PartialEq, Default, Units)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Point2 {
    /// Forward coordinate, in m.
    #[unit("m")]
    pub x: f32,
    /// Coordinate to the left, in m.
    #[unit("m")]
    pub y: f32,
}

impl Point2 {
    /// Creates the point (`x`, `y`).
    pub const fn new(x: f32, y: f32) -> Self {
        Self { x, y }
    }

    /// Creates the point at `range` m in the direction `angle` rad.
    pub fn polar(range: f32, angle: f32) -> Self {
        Self::new(range * libm::cosf(angle), range * libm::sinf(angle))
    }

    /// Square of the distance from the origin, in m².
    #[inline]
    pub const fn norm_squared(self) -> f32 {
        self.x * self.x + self.y * self.y
    }

    /// Distance from the origin, in m.
    #[inline]
    pub fn norm(self) -> f32 {
        libm::sqrtf(self.norm_squared())
    }

    /// Direction seen from the origin, in (−π, π] rad.
    pub fn angle(self) -> f32 {
        libm::atan2f(self.y, self.x)
    }

    /// Scalar product.
    #[inline]
    pub const fn dot(self, other: Self) -> f32 {
        self.x * other.x + self.y * other.y
    }

    /// Vector multiplied by `factor`.
    #[inline]
    #[must_use]
    pub const fn scaled(self, factor: f32) -> Self {
        Self::new(self.x * factor, self.y * factor)
    }

    /// Vector rotated by 90° counter-clockwise.
    #[inline]
    #[must_use]
    pub const fn perpendicular(self) -> Self {
        Self::new(-self.y, self.x)
    }
}

impl Add for Point2 {
    type Output = Self;
    #[inline]
    fn add(self, other: Self) -> Self {
        Self::new(self.x + other.x, self.y + other.y)
    }
}

impl Sub for Point2 {
    type Output = Self;
    #[inline]
    fn sub(self, other: Self) -> Self {
        Self::new(self.x - other.x, self.y - other.y)
    }
}

/// Error of a pose that is too far from the origin to compute with, for example in UTM coordinates
/// (see [`Pose2::is_usable`]).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FarFromOrigin;

impl fmt::Display for FarFromOrigin {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(
            "a pose is more than 100 km from the origin of its frame, where an `f32` has no centimetres: \
             shift the origin to the place of work, before the pose becomes an `f32`",
        )
    }
}

impl core::error::Error for FarFromOrigin {}

/// Pose in the plane: position and orientation of a frame in an outer frame.
#[derive(Debug, Clone, Copy, PartialEq, Default, Units)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Pose2 {
    /// Forward position, in m.
    #[unit("m")]
    pub x: f32,
    /// Position to the left, in m.
    #[unit("m")]
    pub y: f32,
    /// Heading, counter-clockwise from the x axis, in rad.
    #[unit("rad")]
    pub theta: f32,
}

impl Pose2 {
    /// Creates the pose (`x`, `y`, `theta`).
    pub const fn new(x: f32, y: f32, theta: f32) -> Self {
        Self { x, y, theta }
    }

    /// Position: the origin of the frame.
    pub const fn position(&self) -> Point2 {
        Point2::new(self.x, self.y)
    }

    /// Returns `true` if all components are finite.
    pub const fn is_finite(&self) -> bool {
        self.x.is_finite() && self.y.is_finite() && self.theta.is_finite()
    }

    /// Returns `true` if all components are numbers, and at most 100,000 m or rad: an `f32` has steps of 8 mm there,
    /// and does not have centimetres farther away.
    pub const fn is_usable(&self) -> bool {
        const FARTHEST: f32 = 1e5;
        self.x.abs() <= FARTHEST && self.y.abs() <= FARTHEST && self.theta.abs() <= FARTHEST
    }

    /// Returns `true` if all components are numbers, but too large to compute with. The error of a node that gets such
    /// a pose is [`FarFromOrigin`].
    pub const fn is_far(&self) -> bool {
        self.is_finite() && !self.is_usable()
    }

    /// Transformation of many points between this frame and the outer frame.
    pub fn transform(&self) -> Transform2 {
        let (sin, cos) = libm::sincosf(self.theta);
        Transform2 { origin: self.position(), sin, cos }
    }

    /// Transforms a point from this frame to the outer frame.
    pub fn to_outer(&self, point: Point2) -> Point2 {
        self.transform().to_outer(point)
    }

    /// Transforms a point from the outer frame to this frame (thesis eq. 6.17).
    pub fn to_inner(&self, point: Point2) -> Point2 {
        self.transform().to_inner(point)
    }

    /// Returns `true` if a point of the outer frame is in a box of this length and width, in m, whose middle has this
    /// pose.
    pub(crate) fn is_in_box(&self, point: Point2, length: f32, width: f32) -> bool {
        let p = self.to_inner(point);
        libm::fabsf(p.x) <= 0.5 * length && libm::fabsf(p.y) <= 0.5 * width
    }

    /// Transforms a pose from this frame to the outer frame.
    #[must_use]
    pub fn compose(&self, inner: &Self) -> Self {
        let position = self.to_outer(inner.position());
        Self::new(position.x, position.y, wrap_angle(self.theta + inner.theta))
    }

    /// This pose relative to the frame `reference`. Both are given in the same outer frame.
    #[must_use]
    pub fn relative_to(&self, reference: &Self) -> Self {
        let position = reference.to_inner(self.position());
        Self::new(position.x, position.y, wrap_angle(self.theta - reference.theta))
    }

    /// Pose after a part of the way to another one, in a straight line and by the smaller turn: `self` at 0, and `to`
    /// at 1. Both are given in the same outer frame.
    #[must_use]
    pub fn on_way_to(&self, to: &Self, part: f32) -> Self {
        let way = to.relative_to(self);
        self.compose(&Self::new(part * way.x, part * way.y, part * way.theta))
    }
}

/// Transformation of points between the frame of a pose and its outer frame: the sine and the cosine of the heading are
/// computed once.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Transform2 {
    origin: Point2,
    sin: f32,
    cos: f32,
}

impl Transform2 {
    /// Transforms a point from the frame of the pose to the outer frame.
    #[inline]
    pub fn to_outer(&self, point: Point2) -> Point2 {
        let (sin, cos) = (self.sin, self.cos);
        self.origin + Point2::new(cos * point.x - sin * point.y, sin * point.x + cos * point.y)
    }

    /// Transforms a point from the outer frame to the frame of the pose.
    #[inline]
    pub fn to_inner(&self, point: Point2) -> Point2 {
        let (sin, cos) = (self.sin, self.cos);
        let d = point - self.origin;
        Point2::new(cos * d.x + sin * d.y, cos * d.y - sin * d.x)
    }
}

/// Angle wrapped to [−π, π] rad: the remainder of a division by a whole turn.
pub fn wrap_angle(angle: f32) -> f32 {
    let size = angle.abs();
    if size <= PI {
        return angle;
    }
    if size >= 3.0 * PI || angle.is_nan() {
        return libm::remainderf(angle, TAU);
    }
    // Exact, as the remainder is: the angle is between a half and twice of what is subtracted.
    if angle < 0.0 { -(size - TAU) } else { size - TAU }
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f32::consts::FRAC_PI_2;

    #[test]
    fn wrapped_angles_are_remainders() {
        let near = |angle: f32| (-3..=3).map(move |steps| f32::from_bits((angle.to_bits() as i32 + steps) as u32));
        let steps = (0..200_000).map(|i| i as f32 * 1e-4);
        let edges = (1..=8).flat_map(|i| near(i as f32 * FRAC_PI_2)).chain([0.0, 1e9, f32::MAX, f32::INFINITY]);
        for angle in steps.chain(edges).flat_map(|angle| [angle, -angle]) {
            let expected = libm::remainderf(angle, TAU);
            let wrapped = wrap_angle(angle);
            assert!(wrapped.to_bits() == expected.to_bits() || wrapped.is_nan() && expected.is_nan(), "{angle}");
        }
    }

    fn close(a: Point2, b: Point2) -> bool {
        (a - b).norm() < 1e-6
    }

    #[test]
    fn polar_and_back() {
        let p = Point2::polar(2.0, 0.7);
        assert!((p.norm() - 2.0).abs() < 1e-6 && (p.angle() - 0.7).abs() < 1e-6);
    }

    #[test]
    fn frames_transform_there_and_back() {
        let pose = Pose2::new(1.0, 2.0, FRAC_PI_2);
        assert!(close(pose.to_outer(Point2::new(1.0, 0.0)), Point2::new(1.0, 3.0)));
        let p = Point2::new(-0.3, 0.8);
        assert!(close(pose.to_inner(pose.to_outer(p)), p));
    }

    #[test]
    fn what_is_far_away_has_no_centimetres() {
        let at = |x| Pose2::new(x, 0.0, 0.0);
        assert!([0.0, -1e5].into_iter().all(|x| at(x).is_usable() && !at(x).is_far()));
        assert!([1.1e5, -5e6, f32::MAX].into_iter().all(|x| !at(x).is_usable() && at(x).is_far()));
        assert!([f32::NAN, f32::INFINITY].into_iter().all(|x| !at(x).is_usable() && !at(x).is_far()));
        let step = |x: f32| x.next_up() - x;
        assert!(step(1e5) < 0.01 && step(1.4e5) > 0.01, "the border is where the steps are a centimetre");
    }

    #[test]
    fn relative_to_undoes_compose() {
        let (a, b) = (Pose2::new(1.0, -2.0, 3.0), Pose2::new(0.5, 0.25, 1.5));
        let back = a.compose(&b).relative_to(&a);
        assert!(close(back.position(), b.position()) && (back.theta - b.theta).abs() < 1e-5);
        assert!(a.compose(&b).theta.abs() <= PI);
    }
}
