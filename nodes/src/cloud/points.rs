use apex_rt::Time;
use std::fmt;

/// Maximum number of points of a cloud: 16 megapixels.
pub const MAX_POINTS: usize = 1 << 24;

/// Point of a cloud, in the frame of the cloud.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct CloudPoint {
    /// Forward, in m.
    pub x: f32,
    /// To the left, in m.
    pub y: f32,
    /// Upward, in m.
    pub z: f32,
    /// Intensity of the reflected light, in the unit of the sensor.
    pub intensity: f32,
}

/// Structured point cloud: one point per pixel of a depth camera (thesis 6.3.3). The default has no points.
///
/// The frame is that of the camera, with the axes of a robot: x along the optical axis, y to the left, z up.
#[derive(Default, PartialEq)]
pub struct PointCloud {
    /// Time of the measurement.
    pub stamp: Time,
    width: usize,
    height: usize,
    points: Vec<CloudPoint>,
}

impl CloudPoint {
    /// Pixel without a measurement.
    pub const MISSING: Self = Self { x: f32::NAN, y: f32::NAN, z: f32::NAN, intensity: 0.0 };

    /// Returns `true` if all coordinates are finite.
    #[inline]
    pub const fn is_measured(&self) -> bool {
        self.x.is_finite() && self.y.is_finite() && self.z.is_finite()
    }
}

impl PointCloud {
    /// Number of columns and of rows.
    pub const fn size(&self) -> (usize, usize) {
        (self.width, self.height)
    }

    /// Points, row by row from the top, each row from the left.
    pub fn points(&self) -> &[CloudPoint] {
        &self.points
    }

    /// Points for modification.
    pub fn points_mut(&mut self) -> &mut [CloudPoint] {
        &mut self.points
    }

    /// Replaces the content by pixels without measurements. Reuses the allocated storage. A cloud with more than
    /// [`MAX_POINTS`] becomes one without points.
    pub fn reset(&mut self, stamp: Time, (width, height): (usize, usize)) {
        let count = width.checked_mul(height).filter(|count| *count <= MAX_POINTS);
        self.stamp = stamp;
        (self.width, self.height) = if count.is_some() { (width, height) } else { (0, 0) };
        self.points.clear();
        self.points.resize(count.unwrap_or(0), CloudPoint::MISSING);
    }
}

/// `clone_from` reuses the allocated storage.
impl Clone for PointCloud {
    fn clone(&self) -> Self {
        Self { stamp: self.stamp, width: self.width, height: self.height, points: self.points.clone() }
    }

    fn clone_from(&mut self, source: &Self) {
        (self.stamp, self.width, self.height) = (source.stamp, source.width, source.height);
        self.points.clone_from(&source.points);
    }
}

/// Shows the size instead of the points.
impl fmt::Debug for PointCloud {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (width, height) = self.size();
        f.debug_struct("PointCloud")
            .field("stamp", &self.stamp)
            .field("width", &width)
            .field("height", &height)
            .finish_non_exhaustive()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cloud_is_overwritten_in_its_storage() {
        let mut cloud = PointCloud::default();
        cloud.reset(Time::from_millis(1), (4, 3));
        cloud.points_mut()[5] = CloudPoint { x: 1.0, y: 2.0, z: 3.0, intensity: 4.0 };
        assert_eq!((cloud.size(), cloud.points().iter().filter(|p| p.is_measured()).count()), ((4, 3), 1));
        let storage = cloud.points().as_ptr();
        cloud.reset(Time::from_millis(2), (2, 2));
        assert_eq!((cloud.points().as_ptr(), cloud.points().len()), (storage, 4));
        assert!(!cloud.points().iter().any(CloudPoint::is_measured));
    }

    #[test]
    fn impossible_sizes_have_no_points() {
        let mut cloud = PointCloud::default();
        for size in [(usize::MAX, 2), (MAX_POINTS, 2), (0, 7)] {
            cloud.reset(Time::ZERO, size);
            assert_eq!(cloud.points().len(), 0, "{size:?}");
            assert_eq!(cloud.size().0 * cloud.size().1, 0);
        }
    }
}
