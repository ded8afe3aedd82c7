use super::{Mapper, Pose};
use crate::scan::Point2;

/// Selects the scans for a map from `count` scans: the last hundred, every tenth of the hundred before them, and every
/// hundredth of the eight hundred before these. So the time to build a map is bounded (thesis 4.3.5).
///
/// The intervals are those of the thesis: k ∈ [n − 100, n); k ∈ (n − 200, n − 100) with k ≡ 0 (mod 10); and
/// k ∈ (n − 1000, n − 200) with k ≡ 0 (mod 100). At most 118 scans are chosen, in ascending order.
pub fn selected_scans(count: usize) -> impl Iterator<Item = usize> + Clone {
    // The lower bound of an open interval is excluded, unless the interval would start below 0.
    let between = |low: usize, high: usize| {
        let first = if count >= low { count - low + 1 } else { 0 };
        first..count.saturating_sub(high)
    };
    let sparse = between(1000, 200).filter(|k| k % 100 == 0);
    let middle = between(200, 100).filter(|k| k % 10 == 0);
    sparse.chain(middle).chain(count.saturating_sub(100)..count)
}

/// A scan of [`PosedScans`].
#[derive(Debug, Clone, Copy, PartialEq)]
struct PosedScan {
    number: usize,
    scanner: Point2,
    /// Number of points up to its end.
    end: usize,
}

/// Scans at known poses, of which a map can be drawn: their points and the positions of the scanner, in m, in the frame
/// of the map.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PosedScans {
    scans: Vec<PosedScan>,
    points: Vec<Point2>,
}

impl PosedScans {
    /// Removes all scans.
    pub fn clear(&mut self) {
        self.scans.clear();
        self.points.clear();
    }

    /// Adds the scan of a scanner at `scanner` by its points, all in the frame of the robot, which is at `pose`.
    /// `number` tells it from all others, and grows from scan to scan.
    pub fn push(&mut self, number: usize, pose: &Pose, scanner: Point2, points: &[Point2]) {
        self.points.extend(points.iter().map(|p| place(pose, *p)));
        self.scans.push(PosedScan { number, scanner: place(pose, scanner), end: self.points.len() });
    }

    /// Number of scans.
    pub fn len(&self) -> usize {
        self.scans.len()
    }

    /// Returns `true` if there are no scans.
    pub fn is_empty(&self) -> bool {
        self.scans.is_empty()
    }

    /// Numbers of the scans, positions of the scanner, and the points.
    pub fn iter(&self) -> impl Iterator<Item = (usize, Point2, &[Point2])> + Clone {
        let begins = std::iter::once(0).chain(self.scans.iter().map(|scan| scan.end));
        let all = self.scans.iter().zip(begins);
        all.map(|(scan, begin)| (scan.number, scan.scanner, &self.points[begin..scan.end]))
    }
}

impl Mapper {
    /// Writes some of the kept scans at their present poses. `scanner` is the position of the scanner in the frame of
    /// the robot. The frame of the map is that of [`locate`](Self::locate).
    pub fn write_scans(&self, scans: impl Iterator<Item = usize>, scanner: Point2, posed: &mut PosedScans) {
        posed.clear();
        for k in scans {
            if let (Some(pose), Some(points)) = (self.graph().poses().get(k), self.scans().get(k)) {
                posed.push(k, pose, scanner, points);
            }
        }
    }
}

/// Transforms a point from the frame `pose` to the frame of the map.
fn place(pose: &Pose, point: Point2) -> Point2 {
    let p = pose * nalgebra::Point2::new(f64::from(point.x), f64::from(point.y));
    Point2::new(p.x as f32, p.y as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn selected(count: usize) -> Vec<usize> {
        selected_scans(count).collect()
    }

    #[test]
    fn the_intervals_are_those_of_the_thesis() {
        for count in [0, 1, 99, 100, 101, 199, 200, 201, 250, 999, 1000, 1001, 5432] {
            let n = count as i64;
            let chosen = |k: i64| {
                (n - 100 <= k && k < n)
                    || (n - 200 < k && k < n - 100 && k % 10 == 0)
                    || (n - 1000 < k && k < n - 200 && k % 100 == 0)
            };
            let expected: Vec<usize> = (0..n).filter(|&k| chosen(k)).map(|k| k as usize).collect();
            assert_eq!(selected(count), expected, "{count}");
        }
    }

    #[test]
    fn a_map_is_made_of_a_bounded_number_of_scans() {
        assert_eq!((0..5000).map(|count| selected(count).len()).max(), Some(118));
    }
}
