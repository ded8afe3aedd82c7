use super::{Labels, PointCloud};
use apex_rt::{Out, node};

/// Structured point cloud in the frame of the robot, column by column (thesis 6.5.1). The default has no points.
///
/// A column of the camera is a line of points that leads away from the robot (thesis fig. 6.8). Point `i` is in column
/// `i / height` and row `i % height`. Coordinates of a pixel without a measurement are NaN.
#[derive(Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Columns {
    /// Number of rows.
    pub height: usize,
    /// Position of the camera, in m.
    pub origin: [f32; 3],
    /// Forward, in m.
    pub x: Vec<f32>,
    /// To the left, in m.
    pub y: Vec<f32>,
    /// Upward, in m.
    pub z: Vec<f32>,
    /// Intensity of the reflected light, in the unit of the sensor.
    pub intensity: Vec<f32>,
}

/// `clone_from` reuses the allocated storage.
impl Clone for Columns {
    fn clone(&self) -> Self {
        let mut new = Self::default();
        new.clone_from(self);
        new
    }

    fn clone_from(&mut self, source: &Self) {
        (self.height, self.origin) = (source.height, source.origin);
        self.x.clone_from(&source.x);
        self.y.clone_from(&source.y);
        self.z.clone_from(&source.z);
        self.intensity.clone_from(&source.intensity);
    }
}

impl Columns {
    /// Number of points.
    pub fn len(&self) -> usize {
        self.x.len()
    }

    /// Returns `true` if there are no points.
    pub fn is_empty(&self) -> bool {
        self.x.is_empty()
    }

    /// Returns `true` if all lists have the same length, which is that of some whole columns.
    pub fn is_whole(&self) -> bool {
        let lists = [&self.y, &self.z, &self.intensity];
        lists.iter().all(|list| list.len() == self.len())
            && (self.is_empty() || self.height > 0 && self.len().is_multiple_of(self.height))
    }

    /// Returns `true` if the columns are whole and there is a label for each point.
    pub fn fits(&self, labels: &Labels) -> bool {
        self.is_whole() && labels.labels.len() == self.len() && labels.height == self.height
    }

    /// Squared distance between two points, in m². NaN if one of them is not measured.
    #[inline]
    pub(super) fn distance_squared(&self, i: usize, j: usize) -> f32 {
        let d = [self.x[i] - self.x[j], self.y[i] - self.y[j], self.z[i] - self.z[j]];
        d[0] * d[0] + d[1] * d[1] + d[2] * d[2]
    }

    fn reset(&mut self, origin: [f32; 3], height: usize, count: usize) {
        (self.height, self.origin) = (height, origin);
        for list in [&mut self.x, &mut self.y, &mut self.z, &mut self.intensity] {
            list.resize(count, 0.0);
        }
    }
}

/// Converts a cloud of a camera into the frame of the robot, column by column (thesis 6.5.1).
///
/// The camera is level in roll. Without yaw and pitch it looks along x.
#[node]
#[derive(Debug, Clone)]
pub struct MountCloud {
    /// Position of the camera, forward.
    #[param(unit = "m", default = 0.0, range = -10.0..=10.0)]
    x: f32,
    /// Position of the camera, to the left.
    #[param(unit = "m", default = 0.0, range = -10.0..=10.0)]
    y: f32,
    /// Position of the camera, upward.
    #[param(unit = "m", default = 0.1, range = -10.0..=10.0)]
    z: f32,
    /// Rotation of the camera to the left.
    #[param(unit = "rad", default = 0.0, range = -3.2..=3.2)]
    yaw: f32,
    /// Rotation of the camera downwards.
    #[param(unit = "rad", default = 0.261_799_4, range = -1.6..=1.6)]
    pitch: f32,
}

/// Number of columns that are converted together, so that whole cache lines of the cloud are read.
const TILE: usize = 8;

#[node]
impl MountCloud {
    fn process(&mut self, cloud: &PointCloud, columns: &mut Out<Columns>) {
        let (width, height) = cloud.size();
        let origin = [self.x, self.y, self.z];
        let out = columns.get_mut();
        out.reset(origin, height, cloud.points().len());
        let [forward, left, up] = self.axes();
        for first in (0..width).step_by(TILE) {
            let tile = first..width.min(first + TILE);
            for (row, points) in cloud.points().chunks_exact(width).enumerate() {
                for (column, p) in tile.clone().zip(&points[tile.clone()]) {
                    let i = column * height + row;
                    out.x[i] = p.x * forward[0] + p.y * left[0] + p.z * up[0] + origin[0];
                    out.y[i] = p.x * forward[1] + p.y * left[1] + p.z * up[1] + origin[1];
                    out.z[i] = p.x * forward[2] + p.y * left[2] + p.z * up[2] + origin[2];
                    out.intensity[i] = p.intensity;
                }
            }
        }
    }

    /// Forward, left and up directions of the camera in the frame of the robot.
    fn axes(&self) -> [[f32; 3]; 3] {
        let ((sin, cos), (down, level)) = (libm::sincosf(self.yaw), libm::sincosf(self.pitch));
        [[cos * level, sin * level, -down], [-sin, cos, 0.0], [cos * down, sin * down, level]]
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::cloud::{CloudPoint, Label};
    use apex_rt::{Construct, Time};

    /// Columns with these points, which reflect nothing.
    pub fn dark(height: usize, points: &[[f32; 3]]) -> Columns {
        let list = |i: usize| points.iter().map(|p| p[i]).collect();
        let intensity = vec![0.0; points.len()];
        Columns { height, x: list(0), y: list(1), z: list(2), intensity, ..Columns::default() }
    }

    /// Columns with these points, and a label for each: missing without a measurement, unknown otherwise.
    pub fn columns(height: usize, points: &[[f32; 4]]) -> (Columns, Labels) {
        let places: Vec<[f32; 3]> = points.iter().map(|[x, y, z, _]| [*x, *y, *z]).collect();
        let columns = Columns { intensity: points.iter().map(|p| p[3]).collect(), ..dark(height, &places) };
        let label = |p: &[f32; 4]| if p[0].is_nan() { Label::Missing } else { Label::Unknown };
        (columns, Labels { height, labels: points.iter().map(label).collect() })
    }

    #[test]
    fn points_are_where_the_camera_on_the_robot_sees_them() {
        let mut cloud = PointCloud::default();
        cloud.reset(Time::from_millis(3), (20, 3));
        // Straight ahead of a camera that looks down by 0.3 rad: on the floor.
        cloud.points_mut()[47] = CloudPoint { x: 0.1 / 0.3_f32.sin(), y: 0.0, z: 0.0, intensity: 9.0 };
        let mut out = Out::new();
        MountCloud::construct((0.5, 0.0, 0.1, 0.0, 0.3)).process(&cloud, &mut out);
        let columns = out.get().expect("columns");
        let i = 7 * 3 + 2;
        assert!((columns.x[i] - 0.5 - 0.1 / 0.3_f32.tan()).abs() < 1e-6 && columns.z[i].abs() < 1e-6);
        assert_eq!((columns.intensity[i], columns.height), (9.0, 3));
        assert_eq!(columns.x.iter().filter(|x| x.is_finite()).count(), 1);
    }

    #[test]
    fn clouds_without_points_are_columns_without_points() {
        let mut out = Out::new();
        MountCloud::construct((0.0, 0.0, 0.1, 0.0, 0.3)).process(&PointCloud::default(), &mut out);
        let columns = out.get().expect("columns");
        assert!(columns.is_empty() && columns.fits(&Labels::default()));
        assert!(!columns.fits(&Labels { height: 1, labels: vec![Label::Floor] }));
    }
}
