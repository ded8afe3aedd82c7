use super::{Mapper, Pose};
use crate::{
    map::{Grid, Occupancy, OccupancyBuilder, Raster, TooManyCells},
    scan::Point2,
};

/// Free space around what a map has to show, in m.
const MARGIN: f32 = 0.5;
/// The most cells that the rays of a map pass, which takes about half a second.
const MOST_STEPS: f32 = 1e8;

/// The scans of which a map is made when there are `count`: the last hundred, of the hundred before them each
/// tenth, and of the eight hundred before these each hundredth. So the time for a map is bounded (thesis 4.3.5).
///
/// The intervals are those of the thesis: k ∈ [n − 100, n); k ∈ (n − 200, n − 100) with k ≡ 0 (mod 10); and
/// k ∈ (n − 1000, n − 200) with k ≡ 0 (mod 100). At most 118 scans are chosen, in ascending order.
pub fn selected_scans(count: usize) -> impl Iterator<Item = usize> + Clone {
    // From behind the lower border of an open interval, which does not exist below 0, up to the upper one.
    let between = |low: usize, high: usize| {
        let first = if count >= low { count - low + 1 } else { 0 };
        first..count.saturating_sub(high)
    };
    let sparse = between(1000, 200).filter(|k| k % 100 == 0);
    let middle = between(200, 100).filter(|k| k % 10 == 0);
    sparse.chain(middle).chain(count.saturating_sub(100)..count)
}

impl Mapper {
    /// Makes a map of some of the kept scans, with cells of `resolution` m; `scanner` is where the scanner stands in
    /// the frame of the robot. Its frame is that of [`locate`](Self::locate). Where its rays would pass too many cells,
    /// only every second one is drawn, or every third, and so on: the time for a map is bounded, however fine it is.
    ///
    /// # Errors
    /// It would have too many cells; then nothing is written.
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

/// Of how many rays one is drawn, if all pass so many cells.
fn thinned(steps: f32) -> usize {
    // A cast of NaN gives 0.
    (steps / MOST_STEPS).ceil().max(1.0) as usize
}

/// A point of the frame `pose`, in the frame of the map.
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
