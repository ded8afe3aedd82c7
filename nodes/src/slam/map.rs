use super::{Mapper, Pose};
use crate::{
    map::{Grid, Occupancy, OccupancyBuilder, Raster, TooManyCells},
    scan::Point2,
};
use apex_rt::{Out, node};

/// Margin of a map around its contents, in m.
const MARGIN: f32 = 0.5;
/// Maximum number of cells traversed by the rays of a map, which takes about half a second.
const MOST_STEPS: f32 = 1e8;

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

/// Scans at known poses, of which a map can be drawn: their points and the positions of the scanner, in m, in the frame
/// of the map.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PosedScans {
    /// Position of the scanner, and number of points up to the end of the scan.
    scans: Vec<(Point2, usize)>,
    points: Vec<Point2>,
}

impl PosedScans {
    /// Removes all scans.
    pub fn clear(&mut self) {
        self.scans.clear();
        self.points.clear();
    }

    /// Adds the scan of a scanner at `scanner` by its points, all in the frame of the robot, which is at `pose`.
    pub fn push(&mut self, pose: &Pose, scanner: Point2, points: &[Point2]) {
        self.points.extend(points.iter().map(|p| place(pose, *p)));
        self.scans.push((place(pose, scanner), self.points.len()));
    }

    /// Number of scans.
    pub fn len(&self) -> usize {
        self.scans.len()
    }

    /// Returns `true` if there are no scans.
    pub fn is_empty(&self) -> bool {
        self.scans.is_empty()
    }

    /// Positions of the scanner, each with the points of its scan.
    pub fn iter(&self) -> impl Iterator<Item = (Point2, &[Point2])> {
        let begins = std::iter::once(0).chain(self.scans.iter().map(|(_, end)| *end));
        self.scans.iter().zip(begins).map(|((scanner, end), begin)| (*scanner, &self.points[begin..*end]))
    }

    /// Draws a map with cells of `resolution` m.
    ///
    /// If the rays would traverse too many cells, only every second ray is drawn, or every third, and so on: the time
    /// to draw a map is bounded for any resolution.
    ///
    /// # Errors
    /// If the map would have too many cells. Nothing is written then.
    pub fn draw(
        &self,
        resolution: f32,
        builder: &mut OccupancyBuilder,
        map: &mut Grid<Occupancy>,
    ) -> Result<(), TooManyCells> {
        let scanners = self.scans.iter().map(|(scanner, _)| *scanner);
        builder.reset(Raster::around(self.points.iter().copied().chain(scanners), MARGIN, resolution))?;
        let length = |(from, points): (Point2, &[Point2])| points.iter().map(|to| (*to - from).norm()).sum::<f32>();
        let every = thinned(self.iter().map(length).sum::<f32>() / resolution);
        for (from, points) in self.iter() {
            points.iter().step_by(every).for_each(|to| builder.add(from, *to));
        }
        builder.write(map);
        Ok(())
    }
}

impl Mapper {
    /// Writes some of the kept scans at their present poses. `scanner` is the position of the scanner in the frame of
    /// the robot. The frame of the map is that of [`locate`](Self::locate).
    pub fn write_scans(&self, scans: impl Iterator<Item = usize>, scanner: Point2, posed: &mut PosedScans) {
        posed.clear();
        for (pose, points) in scans.filter_map(|k| Some((self.graph().poses().get(k)?, self.scans().get(k)?))) {
            posed.push(pose, scanner, points);
        }
    }
}

/// Draws an occupancy grid of scans at known poses, in which the rays of all scans are counted, like Karto.
///
/// This takes tens of milliseconds: put the node on a thread of its own (`on`), behind a slot such as that of `Latest`.
///
/// Fails if the map would have too many cells.
#[node]
#[derive(Debug)]
pub struct DrawScans {
    /// Side of a cell.
    #[param(unit = "m", default = 0.05, range = 0.01..=1.0)]
    resolution: f32,
    builder: OccupancyBuilder,
}

#[node]
impl DrawScans {
    fn process(&mut self, scans: &PosedScans, map: &mut Out<Grid<Occupancy>>) -> Result<(), TooManyCells> {
        let written = scans.draw(self.resolution, &mut self.builder, map.get_mut());
        if written.is_err() {
            map.clear();
        }
        written
    }
}

/// Number of rays per drawn ray if all rays together traverse this number of cells.
fn thinned(steps: f32) -> usize {
    // A cast of NaN gives 0.
    (steps / MOST_STEPS).ceil().max(1.0) as usize
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
    fn no_more_rays_are_drawn_than_there_is_time_for() {
        for (steps, every) in [(0.0, 1), (1e8, 1), (1.01e8, 2), (2e8, 2), (1e9, 10), (f32::NAN, 1)] {
            assert_eq!(thinned(steps), every, "{steps}");
        }
    }

    #[test]
    fn a_map_is_made_of_a_bounded_number_of_scans() {
        assert_eq!((0..5000).map(|count| selected(count).len()).max(), Some(118));
    }
}
