use core::fmt;

/// Rotation in space as a quaternion of length 1.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Rotation {
    x: f64,
    y: f64,
    z: f64,
    w: f64,
}

/// Deviation of a quaternion's length from 1 up to which it is a rounded rotation.
const ROUNDED: f64 = 0.01;
/// Deviation of its square up to which it is left as it is, so that a rotation that is read again is the same.
const EXACT: f64 = 1e-12;
/// Cosine of half the angle between two rotations from which on they are joined by a straight line, because the sine of
/// that angle is too small to divide by.
const SAME: f64 = 1.0 - 1e-12;

/// Error of four numbers that are not a rotation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NotARotation {
    /// Length of the quaternion, which is neither 1 nor about 1.
    pub length: f64,
}

impl fmt::Display for NotARotation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let reason = match self.length {
            0.0 => "its sender has not set it",
            length if length.is_finite() => "that of a rotation is 1",
            _ => "it has numbers that are not finite",
        };
        write!(f, "the length of a quaternion is {:.3}: {reason}", self.length)
    }
}

impl core::error::Error for NotARotation {}

impl Default for Rotation {
    fn default() -> Self {
        Self::NONE
    }
}

impl Rotation {
    /// Rotation by nothing.
    pub const NONE: Self = Self { x: 0.0, y: 0.0, z: 0.0, w: 1.0 };

    /// Creates a rotation from a quaternion x i + y j + z k + w, which is normalised.
    ///
    /// # Errors
    /// Its length differs from 1 by more than rounding.
    pub fn new([x, y, z, w]: [f64; 4]) -> Result<Self, NotARotation> {
        let square = x * x + y * y + z * z + w * w;
        let length = libm::sqrt(square);
        if length.is_nan() || libm::fabs(length - 1.0) > ROUNDED {
            return Err(NotARotation { length });
        }
        let factor = if libm::fabs(square - 1.0) <= EXACT { 1.0 } else { 1.0 / length };
        Ok(Self { x: x * factor, y: y * factor, z: z * factor, w: w * factor })
    }

    /// Creates a rotation by `angle` rad about an axis of length 1, counter-clockwise seen from its tip.
    pub fn about([x, y, z]: [f64; 3], angle: f64) -> Self {
        let (sin, cos) = libm::sincos(0.5 * angle);
        Self { x: sin * x, y: sin * y, z: sin * z, w: cos }
    }

    /// Creates a rotation about the fixed axes x (roll), y (pitch) and z (yaw), in this order, as URDF and `tf2` have
    /// it. Angles are in rad.
    pub fn from_rpy(roll: f64, pitch: f64, yaw: f64) -> Self {
        let about = |axis, angle| Self::about(axis, angle);
        about([0.0, 0.0, 1.0], yaw).then(about([0.0, 1.0, 0.0], pitch)).then(about([1.0, 0.0, 0.0], roll))
    }

    /// Quaternion of length 1: x, y, z, w.
    pub const fn quaternion(self) -> [f64; 4] {
        [self.x, self.y, self.z, self.w]
    }

    /// Rotation back.
    #[must_use]
    pub const fn inverse(self) -> Self {
        Self { x: -self.x, y: -self.y, z: -self.z, w: self.w }
    }

    /// Product: `inner` happens first, in the rotated frame.
    #[must_use]
    pub fn then(self, inner: Self) -> Self {
        let (a, b) = (self, inner);
        Self {
            x: a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
            y: a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
            z: a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w,
            w: a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z,
        }
    }

    /// Rotates a vector.
    pub fn turn(self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        // v + 2 w (q × v) + 2 q × (q × v)
        let cross = |[a, b, c]: [f64; 3]| [self.y * c - self.z * b, self.z * a - self.x * c, self.x * b - self.y * a];
        let once = cross([x, y, z]).map(|c| 2.0 * c);
        let twice = cross(once);
        [x + self.w * once[0] + twice[0], y + self.w * once[1] + twice[1], z + self.w * once[2] + twice[2]]
    }

    /// Rows of the rotation matrix.
    pub fn matrix(self) -> [[f64; 3]; 3] {
        let columns = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|axis| self.turn(axis));
        core::array::from_fn(|row| core::array::from_fn(|column| columns[column][row]))
    }

    /// Direction in which the x axis points, seen from above, in rad.
    pub fn heading(self) -> f64 {
        let [x, y, _] = self.turn([1.0, 0.0, 0.0]);
        libm::atan2(y, x)
    }

    /// Rotation on the shortest way to `other`, with constant velocity: this one at 0, the other one at 1.
    #[must_use]
    pub fn towards(self, other: Self, part: f64) -> Self {
        let (a, b) = (self.quaternion(), other.quaternion());
        let dot: f64 = a.iter().zip(b).map(|(a, b)| a * b).sum();
        // Both signs of a quaternion are the same rotation.
        let sign = if dot < 0.0 { -1.0 } else { 1.0 };
        let cos = libm::fabs(dot);
        let (to_a, to_b) = if cos > SAME {
            (1.0 - part, part)
        } else {
            let angle = libm::acos(cos);
            let sine = libm::sin(angle);
            (libm::sin((1.0 - part) * angle) / sine, libm::sin(part * angle) / sine)
        };
        let [x, y, z, w]: [f64; 4] = core::array::from_fn(|i| to_a * a[i] + sign * to_b * b[i]);
        let length = libm::sqrt(x * x + y * y + z * z + w * w);
        Self { x: x / length, y: y / length, z: z / length, w: w / length }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Largest difference of two rotations, of which both signs are the same.
    fn off(a: Rotation, b: [f64; 4]) -> f64 {
        let distance = |sign: f64| a.quaternion().iter().zip(b).map(|(a, b)| (a - sign * b).abs()).fold(0.0, f64::max);
        distance(1.0).min(distance(-1.0))
    }

    /// Numbers of `scipy.spatial.transform` 1.16: `from_euler('xyz', …)`, `as_quat`, `*`, `apply`, `Slerp`.
    #[test]
    fn rotations_are_those_of_scipy() {
        let a = Rotation::from_rpy(0.3, -0.7, 2.1);
        let b = Rotation::from_rpy(-1.2, 0.4, -2.8);
        assert!(off(a, [0.3639456996973828, -0.04693295967682286, 0.8311805440083868, 0.4177077066917465]) < 1e-15);
        assert!(off(b, [0.06752543877723588, 0.5732046042701268, -0.7780479448449993, 0.2480286118252129]) < 1e-15);
        let product = [-0.32144557913262, 0.5670842984993256, 0.09294445323523882, 0.7526283722159463];
        assert!(off(a.then(b), product) < 1e-15);
        let turned = a.turn([1.0, -2.0, 3.0]);
        let expected = [2.7683606263024894, 0.8072930971152315, 2.3842099945449817];
        assert!(turned.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-14), "{turned:?}");
        for (part, expected) in [
            (0.0, a.quaternion()),
            (0.25, [0.2747120201033196, -0.20616610291795326, 0.9009258607943896, 0.26525730408466663]),
            (0.5, [0.1686046002713206, -0.3527358276992845, 0.9153332679288023, 0.09651390183506484]),
            (0.9, [-0.01974585876363273, -0.5389198981417045, 0.8223696499535474, -0.18133836682815146]),
            (1.0, b.quaternion()),
        ] {
            assert!(off(a.towards(b, part), expected) < 1e-14, "{part}");
        }
        assert!(off(a.towards(a, 0.3), a.quaternion()) < 1e-15, "the same");
        assert!((Rotation::from_rpy(0.2, -0.1, 2.0).heading() - 2.0).abs() < 1e-15);
    }

    #[test]
    fn what_is_not_a_rotation_is_refused() {
        let rounded = Rotation::new([0.0, 0.0, 0.601, 0.799]).expect("rounded");
        let length = 0.601_f64.hypot(0.799);
        assert!(off(rounded, [0.0, 0.0, 0.601 / length, 0.799 / length]) < 1e-15);
        assert_eq!(Rotation::new(rounded.quaternion()), Ok(rounded), "the same again");
        for (quaternion, reason) in [
            ([0.0; 4], "the length of a quaternion is 0.000: its sender has not set it"),
            ([0.0, 0.0, 1.0, 1.0], "the length of a quaternion is 1.414: that of a rotation is 1"),
            ([f64::NAN, 0.0, 0.0, 1.0], "the length of a quaternion is NaN: it has numbers that are not finite"),
            ([f64::MAX, 0.0, 0.0, 1.0], "the length of a quaternion is inf: it has numbers that are not finite"),
        ] {
            assert_eq!(Rotation::new(quaternion).map_err(|e| std::format!("{e}")), Err(reason.into()));
        }
    }
}
