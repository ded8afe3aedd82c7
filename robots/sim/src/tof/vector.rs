//! Vectors of three coordinates, in m: x forward, y left, z up.

/// Vector, or position.
pub type V3 = [f32; 3];

pub fn add(a: V3, b: V3) -> V3 {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

pub fn sub(a: V3, b: V3) -> V3 {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub fn scale(a: V3, s: f32) -> V3 {
    a.map(|x| x * s)
}

pub fn dot(a: V3, b: V3) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub fn norm(a: V3) -> f32 {
    libm::sqrtf(dot(a, a))
}

/// The vector with length 1. A vector of length 0 stays.
pub fn unit(a: V3) -> V3 {
    scale(a, 1.0 / norm(a).max(f32::MIN_POSITIVE))
}

/// Rotation about the z axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Turn {
    sin: f32,
    cos: f32,
}

impl Turn {
    /// Rotation by an angle, in rad.
    pub fn new(angle: f32) -> Self {
        let (sin, cos) = libm::sincosf(angle);
        Self { sin, cos }
    }

    /// A vector after the rotation.
    pub fn of(&self, a: V3) -> V3 {
        [a[0] * self.cos - a[1] * self.sin, a[0] * self.sin + a[1] * self.cos, a[2]]
    }
}
