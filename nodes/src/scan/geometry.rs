use core::{
    f32::consts::{PI, TAU},
    ops::{Add, Sub},
};

/// A point or vector in the plane, in metres.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Point2 {
    /// Forward.
    pub x: f32,
    /// Left.
    pub y: f32,
}

impl Point2 {
    /// The point (`x`, `y`).
    pub const fn new(x: f32, y: f32) -> Self {
        Self { x, y }
    }

    /// The point at `range` m in the direction `angle` rad.
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

    /// The vector times `factor`.
    #[inline]
    #[must_use]
    pub const fn scaled(self, factor: f32) -> Self {
        Self::new(self.x * factor, self.y * factor)
    }

    /// The vector turned by 90° counter-clockwise.
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

/// A pose in the plane: where a frame lies in another one.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Pose2 {
    /// Forward, in m.
    pub x: f32,
    /// Left, in m.
    pub y: f32,
    /// Heading, counter-clockwise from the x axis, in rad.
    pub theta: f32,
}

impl Pose2 {
    /// The pose (`x`, `y`, `theta`).
    pub const fn new(x: f32, y: f32, theta: f32) -> Self {
        Self { x, y, theta }
    }

    /// The origin of the frame.
    pub const fn position(&self) -> Point2 {
        Point2::new(self.x, self.y)
    }

    /// Whether all is finite.
    pub const fn is_finite(&self) -> bool {
        self.x.is_finite() && self.y.is_finite() && self.theta.is_finite()
    }

    /// A point given in this frame, in the outer frame.
    pub fn to_outer(&self, point: Point2) -> Point2 {
        let (sin, cos) = libm::sincosf(self.theta);
        self.position() + Point2::new(cos * point.x - sin * point.y, sin * point.x + cos * point.y)
    }

    /// A point given in the outer frame, in this frame (thesis eq. 6.17).
    pub fn to_inner(&self, point: Point2) -> Point2 {
        let (sin, cos) = libm::sincosf(self.theta);
        let d = point - self.position();
        Point2::new(cos * d.x + sin * d.y, cos * d.y - sin * d.x)
    }

    /// The pose of a frame that is given in this frame, in the outer frame.
    #[must_use]
    pub fn compose(&self, inner: &Self) -> Self {
        let position = self.to_outer(inner.position());
        Self::new(position.x, position.y, wrap_angle(self.theta + inner.theta))
    }

    /// This pose, seen from the frame `reference`, both given in the same frame.
    #[must_use]
    pub fn relative_to(&self, reference: &Self) -> Self {
        let position = reference.to_inner(self.position());
        Self::new(position.x, position.y, wrap_angle(self.theta - reference.theta))
    }
}

/// The same angle in [−π, π] rad.
fn wrap_angle(angle: f32) -> f32 {
    let wrapped = libm::remainderf(angle, TAU);
    wrapped.clamp(-PI, PI)
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f32::consts::FRAC_PI_2;

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
    fn relative_to_undoes_compose() {
        let (a, b) = (Pose2::new(1.0, -2.0, 3.0), Pose2::new(0.5, 0.25, 1.5));
        let back = a.compose(&b).relative_to(&a);
        assert!(close(back.position(), b.position()) && (back.theta - b.theta).abs() < 1e-5);
        assert!(a.compose(&b).theta.abs() <= PI);
    }
}
