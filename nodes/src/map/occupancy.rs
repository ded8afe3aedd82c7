use super::{Cell, Grid, Occupancy, Raster, TooManyCells};
use crate::scan::Point2;

/// Statistics of the rays of a scanner in a cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct RayCount {
    /// Number of rays that reached the cell, including those that ended in it.
    pub passes: u32,
    /// Number of rays that ended in the cell.
    pub hits: u32,
}

/// Builds an occupancy grid from the rays of a scanner by counting, like Karto.
///
/// Keeps its storage from one map to the next.
#[derive(Debug, Clone)]
pub struct OccupancyBuilder {
    least_passes: u32,
    least_share: f32,
    counts: Grid<RayCount>,
}

impl OccupancyBuilder {
    /// Creates a builder. A cell is known once `least_passes` rays have reached it, and occupied if at least the share
    /// `least_share` of them (0 to 1) ended in it.
    pub fn new(least_passes: u32, least_share: f32) -> Self {
        Self { least_passes: least_passes.max(1), least_share, counts: Grid::default() }
    }

    /// Begins a new map.
    ///
    /// # Errors
    /// If the raster has too many cells or no positive size. The map is then unchanged.
    pub fn reset(&mut self, raster: Raster) -> Result<(), TooManyCells> {
        self.counts.reset(raster, RayCount::default())
    }

    /// Adds a ray from `from` to `to`, in the frame of the map. A ray that ends outside the map counts up to the
    /// border. A ray that starts outside or is not finite is ignored.
    pub fn add(&mut self, from: Point2, to: Point2) {
        self.count(from, to, |count| count.saturating_add(1));
    }

    /// Removes a ray that was added.
    pub fn remove(&mut self, from: Point2, to: Point2) {
        self.count(from, to, |count| count.saturating_sub(1));
    }

    #[inline]
    fn count(&mut self, from: Point2, to: Point2, change: impl Fn(u32) -> u32) {
        let raster = *self.counts.raster();
        let (Some(start), hit) = (raster.cell(from), raster.cell(to)) else { return };
        let Some(end) = hit.or_else(|| last_inside(&raster, from, to)) else { return };
        let counts = self.counts.cells_mut();
        for at in raster.line_of_indices(start, end) {
            if let Some(count) = counts.get_mut(at) {
                count.passes = change(count.passes);
            }
        }
        if let Some(count) = hit.and_then(|cell| self.counts.get_mut(cell)) {
            count.hits = change(count.hits);
        }
    }

    /// Statistics of all cells.
    pub fn counts(&self) -> &Grid<RayCount> {
        &self.counts
    }

    /// Writes the state of each cell.
    pub fn write(&self, map: &mut Grid<Occupancy>) {
        let raster = self.counts.raster();
        // Cannot fail: the builder has a grid of the same raster.
        if map.reset(*raster, Occupancy::Unknown).is_ok() && raster.width.min(raster.height) > 0 {
            self.write_between([Cell::default(), Cell::new(raster.width - 1, raster.height - 1)], map);
        }
    }

    /// Writes the states of the cells in a rectangle, given by two of its corners, to a map of the same raster. Cells
    /// outside of the raster are left out.
    pub fn write_between(&self, [low, high]: [Cell; 2], map: &mut Grid<Occupancy>) {
        let Raster { width, height, .. } = *self.counts.raster();
        if width == 0 || self.counts.raster() != map.raster() {
            return;
        }
        let (least, share) = (self.least_passes, self.least_share);
        let (first, end) = (low.x.min(width), (high.x + 1).min(width));
        let rows = map.cells_mut().chunks_mut(width).zip(self.counts.cells().chunks(width));
        for (cells, counts) in rows.take((high.y + 1).min(height)).skip(low.y) {
            for (cell, count) in cells[first..end.max(first)].iter_mut().zip(&counts[first..end.max(first)]) {
                *cell = occupancy(*count, least, share);
            }
        }
    }
}

/// State of a cell, without branches: most cells of a map have never been looked at.
#[inline]
fn occupancy(RayCount { passes, hits }: RayCount, least_passes: u32, least_share: f32) -> Occupancy {
    let is_hit = (hits > 0) & (hits as f32 >= least_share * passes as f32);
    let seen = if is_hit { Occupancy::Occupied } else { Occupancy::Free };
    if passes < least_passes { Occupancy::Unknown } else { seen }
}

/// The parameters of Karto: a cell is known after 2 rays, and occupied if a tenth of them ended in it.
impl Default for OccupancyBuilder {
    fn default() -> Self {
        Self::new(2, 0.1)
    }
}

/// Last cell inside a raster on the line between two points. The first point is inside, the second one is not.
fn last_inside(raster: &Raster, from: Point2, to: Point2) -> Option<Cell> {
    let (corner, d) = (raster.corner, to - from);
    // Fraction of the line up to half a cell before the border, along one axis.
    let share = |from: f32, d: f32, low: f32, cells: usize| {
        let border =
            if d > 0.0 { low + (cells as f32 - 0.5) * raster.resolution } else { low + 0.5 * raster.resolution };
        if d == 0.0 { 1.0 } else { ((border - from) / d).max(0.0) }
    };
    let x = share(from.x, d.x, corner.x, raster.width);
    let y = share(from.y, d.y, corner.y, raster.height);
    raster.cell(from + d.scaled(x.min(y)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn builder() -> OccupancyBuilder {
        let mut builder = OccupancyBuilder::new(2, 0.5);
        builder.reset(Raster { resolution: 1.0, width: 8, height: 4, ..Raster::default() }).expect("a few cells");
        builder
    }

    /// The lowest rows of the map, as text.
    fn rows(builder: &OccupancyBuilder) -> Vec<String> {
        let mut map = Grid::default();
        builder.write(&mut map);
        let letter = |o: &Occupancy| match o {
            Occupancy::Unknown => '?',
            Occupancy::Free => '.',
            Occupancy::Occupied | Occupancy::Low => '#',
        };
        map.cells().chunks(8).map(|row| row.iter().map(letter).collect()).collect()
    }

    #[test]
    fn rays_free_what_they_pass_and_occupy_where_they_end() {
        let mut builder = builder();
        for end in [5.5, 5.5, 6.5] {
            builder.add(Point2::new(0.5, 0.5), Point2::new(end, 0.5));
        }
        assert_eq!(rows(&builder)[..2], [".....#??", "????????"]);
        assert_eq!(builder.counts().get(Cell::new(5, 0)), Some(&RayCount { passes: 3, hits: 2 }));
        builder.add(Point2::new(7.5, 0.5), Point2::new(0.5, 0.5));
        builder.add(Point2::new(7.5, 0.5), Point2::new(0.5, 0.5));
        assert_eq!(rows(&builder)[0], ".......?".replace('?', "."), "what moved away is free again");
    }

    #[test]
    fn rays_are_cut_at_the_border() {
        let mut builder = builder();
        for _ in 0..2 {
            builder.add(Point2::new(4.5, 1.5), Point2::new(1e9, 1.5));
            builder.add(Point2::new(4.5, 1.5), Point2::new(4.5, -1e9));
            builder.add(Point2::new(-0.5, 3.5), Point2::new(2.0, 3.5));
            builder.add(Point2::new(0.5, 3.5), Point2::new(f32::NAN, 3.5));
            builder.add(Point2::new(0.5, 3.5), Point2::new(f32::INFINITY, 3.5));
        }
        assert_eq!(rows(&builder), ["????.???", "????....", "????????", "????????"]);
    }

    #[test]
    fn a_removed_ray_leaves_nothing() {
        let mut builder = builder();
        let (from, to) = (Point2::new(0.5, 0.5), Point2::new(6.5, 2.5));
        builder.add(from, Point2::new(5.5, 0.5));
        let before = builder.counts().clone();
        for to in [to, Point2::new(1e9, 3.5), Point2::new(f32::NAN, 0.5)] {
            builder.add(from, to);
            builder.remove(from, to);
            assert_eq!(builder.counts(), &before);
        }
    }

    #[test]
    fn a_part_of_a_map_is_written_alone() {
        let mut builder = builder();
        let mut map = Grid::default();
        builder.write(&mut map);
        for _ in 0..2 {
            builder.add(Point2::new(0.5, 1.5), Point2::new(7.5, 1.5));
        }
        let free = |map: &Grid<Occupancy>| map.cells().iter().filter(|cell| **cell == Occupancy::Free).count();
        builder.write_between([Cell::new(2, 2), Cell::new(3, 3)], &mut map);
        assert_eq!(free(&map), 0);
        builder.write_between([Cell::new(2, 1), Cell::new(3, 1)], &mut map);
        assert_eq!(free(&map), 2);
        builder.write_between([Cell::new(9, 0), Cell::new(20, 20)], &mut map);
        builder.write_between([Cell::new(3, 1), Cell::new(2, 1)], &mut map);
        assert_eq!(free(&map), 2);
        builder.write_between([Cell::new(5, 0), Cell::new(20, 20)], &mut map);
        assert_eq!(free(&map), 4);
    }

    #[test]
    fn a_map_without_a_raster_has_no_cells() {
        let mut builder = OccupancyBuilder::default();
        builder.add(Point2::default(), Point2::new(1.0, 1.0));
        assert!(rows(&builder).is_empty());
    }
}
