use super::Rotation;
use crate::scan::Pose2;
use apex_rt::Units;

/// Pose in space: position and orientation of a frame in an outer frame.
#[derive(Debug, Clone, Copy, PartialEq, Default, Units)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Pose3 {
    /// Forward position, in m.
    #[unit("m")]
    pub x: f64,
    /// Position to the left, in m.
    #[unit("m")]
    pub y: f64,
    /// Height, in m.
    #[unit("m")]
    pub z: f64,
    /// Orientation.
    pub rotation: Rotation,
}

impl Pose3 {
    /// Creates a pose from its position, in m, and orientation.
    pub const fn new([x, y, z]: [f64; 3], rotation: Rotation) -> Self {
        Self { x, y, z, rotation }
    }

    /// Position, in m: the origin of the frame.
    pub const fn position(&self) -> [f64; 3] {
        [self.x, self.y, self.z]
    }

    /// Returns `true` if the position is finite.
    pub const fn is_finite(&self) -> bool {
        self.x.is_finite() && self.y.is_finite() && self.z.is_finite()
    }

    /// Transforms a point from this frame to the outer frame.
    pub fn to_outer(&self, point: [f64; 3]) -> [f64; 3] {
        let [x, y, z] = self.rotation.turn(point);
        [self.x + x, self.y + y, self.z + z]
    }

    /// Transforms a pose from this frame to the outer frame.
    #[must_use]
    pub fn compose(&self, inner: &Self) -> Self {
        Self::new(self.to_outer(inner.position()), self.rotation.then(inner.rotation))
    }

    /// Pose of the outer frame in this frame.
    #[must_use]
    pub fn inverse(&self) -> Self {
        let back = self.rotation.inverse();
        Self::new(back.turn(self.position()).map(|c| -c), back)
    }

    /// Pose on the way to `other`: this one at 0, the other one at 1.
    #[must_use]
    pub fn towards(&self, other: &Self, part: f64) -> Self {
        let (a, b) = (self.position(), other.position());
        let position = core::array::from_fn(|i| a[i] + part * (b[i] - a[i]));
        Self::new(position, self.rotation.towards(other.rotation, part))
    }
}

/// Pose in the plane of the outer frame's x and y axis.
impl From<&Pose2> for Pose3 {
    fn from(pose: &Pose2) -> Self {
        let rotation = Rotation::about([0.0, 0.0, 1.0], f64::from(pose.theta));
        Self::new([f64::from(pose.x), f64::from(pose.y), 0.0], rotation)
    }
}

/// Pose seen from above: height and tilt are left out.
impl From<&Pose3> for Pose2 {
    fn from(pose: &Pose3) -> Self {
        Self::new(pose.x as f32, pose.y as f32, pose.rotation.heading() as f32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn poses_are_those_of_matrices() {
        let a = Pose3::new([1.0, 2.0, 3.0], Rotation::from_rpy(0.3, -0.7, 2.1));
        let b = Pose3::new([-4.0, 0.5, 2.0], Rotation::from_rpy(-1.2, 0.4, -2.8));
        // `inv(A) @ B` of NumPy and scipy: the rows.
        let rows = [
            [-0.1194785040746965, -0.8770977185820087, -0.46521444423223635, 0.2960918970750783],
            [0.7437588998761794, -0.38946523469681077, 0.5432674569836979, 4.386642063279185],
            [-0.6576834998075052, -0.2810986001757994, 0.6988819578871371, -2.986586847415664],
        ];
        let found = a.inverse().compose(&b);
        for (i, row) in rows.iter().enumerate() {
            let found = [found.rotation.matrix()[i].as_slice(), &[found.position()[i]]].concat();
            assert!(found.iter().zip(row).all(|(a, b)| (a - b).abs() < 1e-14), "{found:?}");
        }
    }

    #[test]
    fn poses_in_the_plane_stay_there() {
        let pose = Pose2::new(1.0, -2.0, 0.5);
        let back = Pose2::from(&Pose3::from(&pose));
        assert!((back.x, back.y) == (1.0, -2.0) && (back.theta - 0.5).abs() < 1e-7);
    }
}
