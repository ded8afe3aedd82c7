use super::{Mapper, Pose};
use crate::{
    map::{Grid, Occupancy, OccupancyBuilder, Raster, TooManyCells},
    scan::Point2,
};

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

impl Mapper {
    /// Builds a map of some of the kept scans, with cells of `resolution` m. `scanner` is the position of the scanner
    /// in the frame of the robot. The frame of the map is that of [`locate`](Self::locate).
    ///
    /// If the rays would traverse too many cells, only every second ray is drawn, or every third, and so on: the time
    /// to build a map is bounded for any resolution.
    ///
    /// # Errors
    /// If the map would have too many cells. Nothing is written then.
    pub fn write_map(
        &self,
        scans: impl Iterator<Item = usize> + Clone,
        scanner: Point2,
        resolution: f32,
        builder: &mut OccupancyBuilder,
        map: &mut Grid<Occupancy>,
    ) -> Result<(), TooManyCells> {
        let known = scans.filter_map(|k| Some((self.graph().poses().get(k)?, self.scans().get(k)?)));
        let points = known
            .clone()
            .flat_map(|(pose, points)| points.iter().copied().chain([scanner]).map(move |p| place(pose, p)));
        builder.reset(Raster::around(points, MARGIN, resolution))?;
        let way = known.clone().flat_map(|(_, points)| points).map(|to| (*to - scanner).norm()).sum::<f32>();
        let every = thinned(way / resolution);
        for (pose, points) in known {
            let from = place(pose, scanner);
            points.iter().step_by(every).for_each(|to| builder.add(from, place(pose, *to)));
        }
        builder.write(map);
        Ok(())
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
