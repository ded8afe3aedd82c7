use super::PosedScans;
use crate::{
    map::{Grid, Occupancy, OccupancyBuilder, Raster, TooManyCells},
    scan::Point2,
};
use apex_rt::{Out, node};

/// Margin of a map around its contents, in m.
const MARGIN: f32 = 0.5;
/// Number of cells of which the sides of a map are multiples, so that most maps have the raster of the one before.
const TILE: usize = 32;
/// Maximum number of cells traversed by the rays of a map, which takes about half a second.
const MOST_STEPS: f32 = 1e8;

/// Draws occupancy grids of scans at known poses by counting their rays.
///
/// The map is that of the scans alone, whatever was drawn before. But rays that were counted before are not counted
/// again: where some scans are new, gone or elsewhere, only theirs are.
#[derive(Debug, Clone, Default)]
pub struct ScanDrawer {
    builder: OccupancyBuilder,
    /// The scans whose rays are counted.
    counted: PosedScans,
    /// Number of rays per counted ray.
    every: usize,
    /// The last map.
    map: Grid<Occupancy>,
}

impl ScanDrawer {
    /// Creates a drawer whose cells are known and occupied as those of `builder`.
    pub fn new(builder: OccupancyBuilder) -> Self {
        Self { builder, ..Self::default() }
    }

    /// Draws a map with cells of `resolution` m.
    ///
    /// If the rays would traverse too many cells, only every second ray is drawn, or every third, and so on: the time
    /// to draw a map is bounded for any resolution.
    ///
    /// # Errors
    /// If the map would have too many cells. Nothing is written then.
    pub fn draw(&mut self, scans: &PosedScans, resolution: f32, map: &mut Grid<Occupancy>) -> Result<(), TooManyCells> {
        let raster = raster(scans, resolution);
        let every = thinned(scans.iter().map(length).sum::<f32>() / resolution);
        let kept = matches(&self.counted, scans).filter(|found| matches!(found, Found::InBoth)).count();
        // To take away most of the rays takes longer than to begin anew.
        if raster != *self.builder.counts().raster() || every != self.every || 2 * kept < scans.len() {
            self.builder.reset(raster)?;
            self.builder.write(&mut self.map);
            self.counted.clear();
            self.every = every;
        }
        let mut changed = Bounds::default();
        for found in matches(&self.counted, scans) {
            match found {
                Found::InBoth => {}
                Found::Before(scan) => changed.count(scan, every, |from, to| self.builder.remove(from, to)),
                Found::Now(scan) => changed.count(scan, every, |from, to| self.builder.add(from, to)),
            }
        }
        self.counted.clone_from(scans);
        if let [Some(low), Some(high)] = [changed.low, changed.high].map(|corner| raster.cell(corner)) {
            self.builder.write_between([low, high], &mut self.map);
        }
        map.clone_from(&self.map);
        Ok(())
    }
}

/// Draws an occupancy grid of scans at known poses, in which the rays of all scans are counted, like Karto.
///
/// Only rays of scans that are new, gone or elsewhere are counted, which takes less than a millisecond. After a
/// correction of all poses it takes tens of them: put the node on a thread of its own (`on`), behind a slot such as
/// that of `Latest`.
///
/// Fails if the map would have too many cells.
#[node]
#[derive(Debug)]
pub struct DrawScans {
    /// Side of a cell.
    #[param(unit = "m", default = 0.05, range = 0.01..=1.0)]
    resolution: f32,
    drawer: ScanDrawer,
}

#[node]
impl DrawScans {
    fn process(&mut self, scans: &PosedScans, map: &mut Out<Grid<Occupancy>>) -> Result<(), TooManyCells> {
        let written = self.drawer.draw(scans, self.resolution, map.get_mut());
        if written.is_err() {
            map.clear();
        }
        written
    }
}

/// Bounds of counted rays.
struct Bounds {
    low: Point2,
    high: Point2,
}

impl Default for Bounds {
    fn default() -> Self {
        let [low, high] = [f32::INFINITY, f32::NEG_INFINITY].map(|none| Point2::new(none, none));
        Self { low, high }
    }
}

impl Bounds {
    /// Counts every so many rays of a scan.
    fn count(&mut self, (_, from, points): ScanAt<'_>, every: usize, mut ray: impl FnMut(Point2, Point2)) {
        self.cover(from);
        for to in points.iter().step_by(every) {
            self.cover(*to);
            ray(from, *to);
        }
    }

    fn cover(&mut self, point: Point2) {
        self.low = Point2::new(self.low.x.min(point.x), self.low.y.min(point.y));
        self.high = Point2::new(self.high.x.max(point.x), self.high.y.max(point.y));
    }
}

/// Number, position of the scanner and points of a scan.
type ScanAt<'a> = (usize, Point2, &'a [Point2]);

/// A scan among those of the map before and those of the map now.
enum Found<'a> {
    InBoth,
    Before(ScanAt<'a>),
    Now(ScanAt<'a>),
}

/// Compares scans, both in the order of their numbers. A scan at another pose is two scans.
fn matches<'a>(before: &'a PosedScans, now: &'a PosedScans) -> impl Iterator<Item = Found<'a>> {
    let (mut before, mut now) = (before.iter().peekable(), now.iter().peekable());
    std::iter::from_fn(move || match (before.peek(), now.peek()) {
        (Some(old), Some(new)) if old == new => {
            before.next();
            now.next().map(|_| Found::InBoth)
        }
        (Some(old), new) if new.is_none_or(|new| old.0 <= new.0) => before.next().map(Found::Before),
        _ => now.next().map(Found::Now),
    })
}

/// The raster of a map, in whole tiles.
fn raster(scans: &PosedScans, resolution: f32) -> Raster {
    let places = scans.iter().flat_map(|(_, scanner, points)| points.iter().copied().chain([scanner]));
    let tile = Raster::around(places, MARGIN, TILE as f32 * resolution);
    Raster { resolution, width: tile.width.saturating_mul(TILE), height: tile.height.saturating_mul(TILE), ..tile }
}

/// Length of all rays of a scan, in m.
fn length((_, from, points): ScanAt<'_>) -> f32 {
    points.iter().map(|to| (*to - from).norm()).sum()
}

/// Number of rays per drawn ray if all rays together traverse this number of cells.
fn thinned(steps: f32) -> usize {
    // A cast of NaN gives 0.
    (steps / MOST_STEPS).ceil().max(1.0) as usize
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{math::Random, slam::pose};

    /// Scans with these numbers of a scanner that goes along x, each at a pose that `moved` shifts.
    fn scans(numbers: impl IntoIterator<Item = usize>, moved: impl Fn(usize) -> f64) -> PosedScans {
        let mut scans = PosedScans::default();
        for k in numbers {
            let mut random = Random::new(k as u64 + 1);
            let points: Vec<Point2> =
                (0..60).map(|i| Point2::polar(random.uniform(1.0, 6.0), i as f32 * 0.1)).collect();
            scans.push(k, &pose(0.3 * k as f64 + moved(k), 0.1, 0.02 * k as f64), Point2::new(0.1, 0.0), &points);
        }
        scans
    }

    fn drawn(drawer: &mut ScanDrawer, scans: &PosedScans) -> Grid<Occupancy> {
        let mut map = Grid::default();
        drawer.draw(scans, 0.1, &mut map).expect("a map of some metres");
        map
    }

    #[test]
    fn a_map_is_that_of_its_scans_whatever_was_drawn_before() {
        let mut random = Random::new(7);
        let mut drawer = ScanDrawer::default();
        for round in 0..200 {
            let (first, count) = ((random.bits() % 9) as usize, (random.bits() % 12) as usize);
            let left_out = (random.bits() % 20) as usize;
            let from = (random.bits() % 25) as usize;
            let moved = |k| if k >= from { 0.05 } else { 0.0 };
            let scans = scans((first..first + count).filter(|k| *k != left_out), moved);
            assert_eq!(drawn(&mut drawer, &scans), drawn(&mut ScanDrawer::default(), &scans), "{round}");
        }
    }

    #[test]
    fn scans_without_an_order_make_the_same_map() {
        let (mut drawer, still) = (ScanDrawer::default(), |_| 0.0);
        for numbers in [[3, 1, 2, 0], [0, 1, 2, 3], [2, 2, 1, 3], [3, 1, 2, 0]] {
            let scans = scans(numbers, still);
            assert_eq!(drawn(&mut drawer, &scans), drawn(&mut ScanDrawer::default(), &scans), "{numbers:?}");
        }
    }

    #[test]
    fn rays_are_counted_once_while_scans_stay() {
        let (mut drawer, still) = (ScanDrawer::default(), |_| 0.0);
        drawn(&mut drawer, &scans(0..10, still));
        let found = |before: &PosedScans, now: &PosedScans| {
            let count = |kind: fn(&Found<'_>) -> bool| matches(before, now).filter(kind).count();
            [
                count(|f| matches!(f, Found::InBoth)),
                count(|f| matches!(f, Found::Before(_))),
                count(|f| matches!(f, Found::Now(_))),
            ]
        };
        assert_eq!(found(&drawer.counted, &scans(1..11, still)), [9, 1, 1]);
        assert_eq!(found(&drawer.counted, &scans(0..10, |k| if k == 9 { 0.1 } else { 0.0 })), [9, 1, 1]);
        assert_eq!(found(&drawer.counted, &PosedScans::default()), [0, 10, 0]);
    }

    #[test]
    fn a_map_of_too_many_cells_is_refused_and_the_next_one_is_drawn() {
        let (mut drawer, still) = (ScanDrawer::default(), |_| 0.0);
        drawn(&mut drawer, &scans(0..4, still));
        let far = scans(0..4, |k| 1e5 * k as f64);
        let before = Grid::default();
        let mut map = Grid::default();
        assert!(drawer.draw(&far, 0.01, &mut map).is_err());
        assert_eq!(map, before);
        let scans = scans(1..5, still);
        assert_eq!(drawn(&mut drawer, &scans), drawn(&mut ScanDrawer::default(), &scans));
    }

    #[test]
    fn no_more_rays_are_drawn_than_there_is_time_for() {
        for (steps, every) in [(0.0, 1), (1e8, 1), (1.01e8, 2), (2e8, 2), (1e9, 10), (f32::NAN, 1)] {
            assert_eq!(thinned(steps), every, "{steps}");
        }
    }
}
