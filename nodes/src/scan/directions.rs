use super::{Point2, Scan, laser::directions};

/// Directions of the beams of a scanner: a table in the memory of whatever turns its scans into points, so that there
/// is neither a sine nor a cosine in a point.
///
/// The table is filled by the first scan, and again by a scan with other angles or more beams. Its points are those of
/// [`Scan::points`], bit by bit. Without the feature `std`, where
/// memory is scarce, directions are computed again for each scan.
#[derive(Debug, Clone, Default)]
pub struct BeamDirections {
    angle_min: f32,
    angle_increment: f32,
    #[cfg(feature = "std")]
    table: std::vec::Vec<Point2>,
}

impl BeamDirections {
    /// Measured points of a scan in the frame of the scanner with the indices of their beams, in order.
    #[inline]
    pub fn points<'a>(&'a mut self, scan: &'a Scan) -> impl Iterator<Item = (usize, Point2)> + 'a {
        scan.points_in(self.of(scan))
    }

    /// Directions of the beams of a scan, as vectors of length 1.
    #[cfg(feature = "std")]
    #[inline]
    fn of(&mut self, scan: &Scan) -> impl Iterator<Item = Point2> + '_ {
        let is_same = self.angle_min == scan.angle_min && self.angle_increment == scan.angle_increment;
        if !is_same || self.table.len() < scan.ranges.len() {
            self.fill(scan);
        }
        self.table.iter().copied()
    }

    #[cfg(not(feature = "std"))]
    fn of(&mut self, scan: &Scan) -> impl Iterator<Item = Point2> + use<> {
        (self.angle_min, self.angle_increment) = (scan.angle_min, scan.angle_increment);
        directions(self.angle_min, self.angle_increment)
    }

    #[cfg(feature = "std")]
    #[cold]
    fn fill(&mut self, scan: &Scan) {
        (self.angle_min, self.angle_increment) = (scan.angle_min, scan.angle_increment);
        self.table.clear();
        self.table.extend(directions(self.angle_min, self.angle_increment).take(scan.ranges.len()));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f32::consts::PI;

    #[test]
    fn points_are_those_without_a_table() {
        let mut beams = BeamDirections::default();
        let geometries = [(-PI, PI / 720.0, 1440), (-PI, PI / 720.0, 20), (-PI, PI / 720.0, 1440), (2.0, -0.01, 300)];
        for (angle_min, angle_increment, count) in geometries.into_iter().chain([(2.0, -0.01, 400), (0.0, 0.0, 2)]) {
            let mut scan = Scan { angle_min, angle_increment, ..Scan::default() };
            scan.ranges.extend((0..count).map(|beam| if beam % 7 == 3 { f32::NAN } else { 0.1 * beam as f32 + 0.3 }));
            assert!(beams.points(&scan).eq(scan.points()), "{count} beams from {angle_min}");
            assert_eq!(scan.points().count(), count - (count + 3) / 7, "{count} beams from {angle_min}");
        }
    }
}
