use super::{CloudPoint, MAX_POINTS};
use apex_rt::Time;
use std::fmt;

/// Point cloud of one turn of a laser scanner with rings. The default has no points.
///
/// Points are in m, in the frame of the scanner at the time of their column: x forward, y to the left, z up along its
/// axis. Point `i` is in column `i / rings`, and in row `i % rings`; row 0 is the uppermost ring. The columns are in
/// the order of their times. A direction without a measurement has NaN as its coordinates.
#[derive(Default, PartialEq)]
pub struct RingCloud {
    /// Time of the end of the turn.
    pub stamp: Time,
    rings: usize,
    points: Vec<CloudPoint>,
    times: Vec<f32>,
}

impl RingCloud {
    /// Number of rings.
    pub const fn rings(&self) -> usize {
        self.rings
    }

    /// Number of columns.
    pub fn columns(&self) -> usize {
        self.times.len()
    }

    /// Points, column by column, each from the uppermost ring.
    pub fn points(&self) -> &[CloudPoint] {
        &self.points
    }

    /// Points for modification.
    pub fn points_mut(&mut self) -> &mut [CloudPoint] {
        &mut self.points
    }

    /// Time of each column, in s after the stamp; negative, as columns are measured before the end of the turn.
    pub fn times(&self) -> &[f32] {
        &self.times
    }

    /// Times for modification.
    pub fn times_mut(&mut self) -> &mut [f32] {
        &mut self.times
    }

    /// Replaces the content by points without measurements, at the time of the stamp. Reuses the allocated storage. A
    /// cloud with more than [`MAX_POINTS`] becomes one without points.
    pub fn reset(&mut self, stamp: Time, rings: usize, columns: usize) {
        self.stamp = stamp;
        self.rings = rings;
        let fits = rings.checked_mul(columns).is_some_and(|count| count <= MAX_POINTS);
        let columns = if fits && rings > 0 { columns } else { 0 };
        self.points.clear();
        self.points.resize(rings * columns, CloudPoint::MISSING);
        self.times.clear();
        self.times.resize(columns, 0.0);
    }

    /// Adds a column at the end: its time in s after the stamp, and the points of its rings from the uppermost one.
    /// Adds nothing if their number is not that of the rings, or if there is no room.
    pub fn push_column(&mut self, time: f32, points: &[CloudPoint]) {
        if points.len() == self.rings && self.points.len() + points.len() <= MAX_POINTS {
            self.points.extend_from_slice(points);
            self.times.push(time);
        }
    }

    /// Returns `true` if a direction has been measured.
    pub fn measures_anything(&self) -> bool {
        self.points.iter().any(CloudPoint::is_measured)
    }
}

/// `clone_from` reuses the allocated storage.
impl Clone for RingCloud {
    fn clone(&self) -> Self {
        Self { stamp: self.stamp, rings: self.rings, points: self.points.clone(), times: self.times.clone() }
    }

    fn clone_from(&mut self, source: &Self) {
        (self.stamp, self.rings) = (source.stamp, source.rings);
        self.points.clone_from(&source.points);
        self.times.clone_from(&source.times);
    }
}

/// Shows the size instead of the points.
impl fmt::Debug for RingCloud {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("RingCloud")
            .field("stamp", &self.stamp)
            .field("rings", &self.rings)
            .field("columns", &self.columns())
            .finish_non_exhaustive()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_added_and_impossible_sizes_have_none() {
        let mut cloud = RingCloud::default();
        cloud.reset(Time::from_millis(5), 2, 1);
        let point = CloudPoint { x: 1.0, y: 2.0, z: 3.0, intensity: 4.0 };
        cloud.push_column(-0.5, &[point, point]);
        cloud.push_column(-0.4, &[point]);
        assert_eq!((cloud.columns(), cloud.points().len(), cloud.times()[1]), (2, 4, -0.5));
        assert!(cloud.measures_anything());
        for (rings, columns) in [(usize::MAX, 2), (16, MAX_POINTS), (0, 9)] {
            cloud.reset(Time::ZERO, rings, columns);
            assert_eq!((cloud.points().len(), cloud.columns()), (0, 0));
        }
        assert!(!cloud.measures_anything());
    }
}
