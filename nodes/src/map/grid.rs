use crate::scan::Point2;
use core::fmt;

/// Maximum number of cells of a [`Grid`]: 400 m by 400 m at 5 cm.
pub const MAX_CELLS: usize = 1 << 26;

/// Division of a rectangle of the plane into square cells. Its sides are parallel to the axes of its frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Raster {
    /// Corner with the least x and y, in m.
    pub corner: Point2,
    /// Side of a cell, in m.
    pub resolution: f32,
    /// Number of cells along x.
    pub width: usize,
    /// Number of cells along y.
    pub height: usize,
}

/// Indices of a cell: its column (along x) and its row (along y).
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub struct Cell {
    /// Column, counted from the corner along x.
    pub x: usize,
    /// Row, counted from the corner along y.
    pub y: usize,
}

/// Grid map: a value for each cell of a raster, row by row from the least y.
#[derive(Debug, PartialEq)]
pub struct Grid<T> {
    raster: Raster,
    cells: Vec<T>,
}

/// State of a cell of a map.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash)]
pub enum Occupancy {
    /// No knowledge of the cell.
    #[default]
    Unknown,
    /// No obstacle in the cell.
    Free,
    /// An obstacle in the cell.
    Occupied,
    /// A low obstacle in the cell, such as a cable: no robot drives over it, but its load may be above it.
    Low,
}

impl Occupancy {
    /// Returns `true` if an obstacle is in the cell, of any height.
    #[must_use]
    pub const fn is_obstacle(self) -> bool {
        matches!(self, Self::Occupied | Self::Low)
    }
}

/// Probabilities of an obstacle in % up to which a cell is free, and from which on it is occupied, as map servers of
/// ROS have it.
const MOSTLY_FREE: f32 = 19.0;
const MOSTLY_OCCUPIED: f32 = 65.0;
/// Angle up to which an origin is along the axes, in rad.
const LEVEL: f32 = 1e-6;

impl Occupancy {
    /// State of a cell with this probability of an obstacle, in %.
    pub(crate) fn of_percent(percent: f32) -> Self {
        if percent >= MOSTLY_OCCUPIED {
            Self::Occupied
        } else if percent <= MOSTLY_FREE {
            Self::Free
        } else {
            Self::Unknown
        }
    }
}

/// Refuses a map of another program whose origin is turned by `yaw`, in rad.
pub(crate) fn check_level(yaw: f32) -> Result<(), String> {
    if yaw.abs() > LEVEL {
        let turn = yaw.to_degrees();
        return Err(format!("its origin is turned by {turn:.1}°: only maps along the axes can be read"));
    }
    Ok(())
}

/// Error of a raster that has too many cells, or cells without a positive size.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TooManyCells(pub Raster);

impl fmt::Display for TooManyCells {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Raster { width, height, resolution, .. } = self.0;
        write!(f, "a grid of {width} x {height} cells of {resolution} m is not possible: ")?;
        write!(f, "at most {MAX_CELLS} cells of a positive size are")
    }
}

impl std::error::Error for TooManyCells {}

impl Cell {
    /// Creates the indices of the cell in column `x` and row `y`.
    pub const fn new(x: usize, y: usize) -> Self {
        Self { x, y }
    }
}

impl Raster {
    /// Creates the smallest raster with cells of `resolution` m that covers all `points` with a margin of `margin` m.
    /// Its corner is a multiple of the resolution, so that the cells of two rasters of the same resolution coincide.
    pub fn around(points: impl IntoIterator<Item = Point2>, margin: f32, resolution: f32) -> Self {
        let (mut low, mut high) = (Point2::new(f32::MAX, f32::MAX), Point2::new(f32::MIN, f32::MIN));
        for p in points {
            low = Point2::new(low.x.min(p.x), low.y.min(p.y));
            high = Point2::new(high.x.max(p.x), high.y.max(p.y));
        }
        if low.x > high.x {
            (low, high) = Default::default();
        }
        let first = |low: f32| ((low - margin) / resolution).floor();
        let (x, y) = (first(low.x), first(low.y));
        // Casts of too large numbers saturate; no grid has that many cells.
        let count =
            |high: f32, first: f32| ((((high + margin) / resolution).floor() - first) as usize).saturating_add(1);
        Self {
            corner: Point2::new(x * resolution, y * resolution),
            resolution,
            width: count(high.x, x),
            height: count(high.y, y),
        }
    }

    /// Cell that contains a point, or `None` if the point is outside.
    #[inline]
    pub fn cell(&self, point: Point2) -> Option<Cell> {
        let d = point - self.corner;
        let (x, y) = (d.x / self.resolution, d.y / self.resolution);
        // False for NaN.
        let inside = x >= 0.0 && y >= 0.0 && x < self.width as f32 && y < self.height as f32;
        inside.then_some(Cell::new(x as usize, y as usize))
    }

    /// Centre of a cell, in m.
    #[inline]
    pub fn centre(&self, cell: Cell) -> Point2 {
        self.corner + Point2::new(cell.x as f32 + 0.5, cell.y as f32 + 0.5).scaled(self.resolution)
    }

    /// Returns `true` if the raster has this cell.
    #[inline]
    pub const fn contains(&self, cell: Cell) -> bool {
        cell.x < self.width && cell.y < self.height
    }

    /// Cells along a line, including both ends, starting with `from` (Bresenham 1965).
    pub fn line(from: Cell, to: Cell) -> impl Iterator<Item = Cell> {
        let (dx, dy) = (from.x.abs_diff(to.x) as i64, from.y.abs_diff(to.y) as i64);
        let (mut at, mut error) = (from, dx - dy);
        (0..=dx.max(dy)).map(move |_| {
            let here = at;
            let twice = 2 * error;
            if twice > -dy && at.x != to.x {
                error -= dy;
                at.x = if to.x > at.x { at.x + 1 } else { at.x - 1 };
            }
            if twice < dx && at.y != to.y {
                error += dx;
                at.y = if to.y > at.y { at.y + 1 } else { at.y - 1 };
            }
            here
        })
    }

    /// Indices of the [`line`](Self::line) between two cells of the raster, row by row from 0 on.
    ///
    /// Each step goes along the longer side; whether it goes along the shorter one, too, is computed without a branch.
    #[inline]
    pub(super) fn line_of_indices(&self, from: Cell, to: Cell) -> impl Iterator<Item = usize> + use<> {
        let step = |from: usize, to: usize, stride: usize| if to < from { stride.wrapping_neg() } else { stride };
        let x = (from.x.abs_diff(to.x) as i32, step(from.x, to.x, 1));
        let y = (from.y.abs_diff(to.y) as i32, step(from.y, to.y, self.width));
        let ((long, along), (short, across)) = if x.0 > y.0 { (x, y) } else { (y, x) };
        let (mut at, mut error) = (from.y * self.width + from.x, long - short);
        (0..=long).map(move |_| {
            let here = at;
            let is_diagonal = 2 * error < long;
            error += if is_diagonal { long - short } else { -short };
            at = at.wrapping_add(along).wrapping_add(if is_diagonal { across } else { 0 });
            here
        })
    }
}

/// A raster without cells.
impl Default for Raster {
    fn default() -> Self {
        Self { corner: Point2::default(), resolution: 1.0, width: 0, height: 0 }
    }
}

impl<T: Clone> Grid<T> {
    /// Creates a grid with the same value in all cells.
    ///
    /// # Errors
    /// If there would be more than [`MAX_CELLS`] cells, or if their size is not positive and finite.
    pub fn new(raster: Raster, value: T) -> Result<Self, TooManyCells> {
        let mut grid = Self::default();
        grid.reset(raster, value)?;
        Ok(grid)
    }

    /// Same as [`new`](Self::new), but reuses the allocated storage.
    ///
    /// # Errors
    /// The errors of [`new`](Self::new). The grid is then unchanged.
    pub fn reset(&mut self, raster: Raster, value: T) -> Result<(), TooManyCells> {
        // One of the sides may be zero, so both are checked.
        let longer = raster.width.max(raster.height);
        let count = raster.width.checked_mul(raster.height).filter(|&count| count.max(longer) <= MAX_CELLS);
        let sized = raster.resolution.is_finite() && raster.resolution > 0.0;
        let Some(count) = count.filter(|_| sized) else { return Err(TooManyCells(raster)) };
        self.raster = raster;
        self.cells.clear();
        self.cells.resize(count, value);
        Ok(())
    }

    /// Adopts the raster of another grid, with the same value in all cells. Reuses the allocated storage.
    pub fn reset_like<U>(&mut self, other: &Grid<U>, value: T) {
        self.raster = other.raster;
        self.cells.clear();
        self.cells.resize(other.cells.len(), value);
    }
}

impl<T> Grid<T> {
    /// Map without cells.
    pub const EMPTY: Self = Self {
        raster: Raster { corner: Point2::new(0.0, 0.0), resolution: 1.0, width: 0, height: 0 },
        cells: Vec::new(),
    };

    /// Raster of the cells.
    #[inline]
    pub const fn raster(&self) -> &Raster {
        &self.raster
    }

    /// Values, row by row from the least y.
    pub fn cells(&self) -> &[T] {
        &self.cells
    }

    /// Values for modification, row by row from the least y.
    pub fn cells_mut(&mut self) -> &mut [T] {
        &mut self.cells
    }

    /// Value of a cell, or `None` if the raster does not have it.
    #[inline]
    pub fn get(&self, cell: Cell) -> Option<&T> {
        if self.raster.contains(cell) { self.cells.get(cell.y * self.raster.width + cell.x) } else { None }
    }

    /// Value of a cell for modification, or `None` if the raster does not have it.
    #[inline]
    pub fn get_mut(&mut self, cell: Cell) -> Option<&mut T> {
        if self.raster.contains(cell) { self.cells.get_mut(cell.y * self.raster.width + cell.x) } else { None }
    }

    /// Value at a point, or `None` if the point is outside.
    #[inline]
    pub fn at(&self, point: Point2) -> Option<&T> {
        self.raster.cell(point).and_then(|cell| self.get(cell))
    }

    /// All cells with their values.
    pub fn iter(&self) -> impl Iterator<Item = (Cell, &T)> {
        let width = self.raster.width.max(1);
        self.cells.iter().enumerate().map(move |(i, value)| (Cell::new(i % width, i / width), value))
    }
}

impl<T: Clone> Clone for Grid<T> {
    fn clone(&self) -> Self {
        Self { raster: self.raster, cells: self.cells.clone() }
    }

    /// Same as [`clone`](Self::clone), but reuses the allocated storage.
    fn clone_from(&mut self, other: &Self) {
        self.raster = other.raster;
        self.cells.clone_from(&other.cells);
    }
}

/// A grid without cells.
impl<T> Default for Grid<T> {
    fn default() -> Self {
        Self::EMPTY
    }
}

/// Map with cells of 1 m, from the row of the least y on: `#` is occupied, `?` unknown, all else free.
#[cfg(test)]
pub fn drawn(rows: &[&str]) -> Grid<Occupancy> {
    let raster = Raster { width: rows[0].len(), height: rows.len(), ..Raster::default() };
    let mut map = Grid::new(raster, Occupancy::Free).expect("small");
    for (cell, sign) in map.cells_mut().iter_mut().zip(rows.concat().bytes()) {
        match sign {
            b'#' => *cell = Occupancy::Occupied,
            b'?' => *cell = Occupancy::Unknown,
            _ => {}
        }
    }
    map
}

#[cfg(test)]
mod tests {
    use super::*;

    fn raster() -> Raster {
        Raster { corner: Point2::new(-1.0, 2.0), resolution: 0.5, width: 4, height: 3 }
    }

    #[test]
    fn points_are_in_the_cells_around_them() {
        let raster = raster();
        for y in 0..raster.height {
            for x in 0..raster.width {
                assert_eq!(raster.cell(raster.centre(Cell::new(x, y))), Some(Cell::new(x, y)));
            }
        }
        assert_eq!(raster.cell(Point2::new(-1.0, 2.0)), Some(Cell::new(0, 0)));
        for outside in [(1.0, 2.0), (-1.01, 2.0), (0.0, 3.5), (f32::NAN, 2.0)] {
            assert_eq!(raster.cell(Point2::new(outside.0, outside.1)), None);
        }
    }

    #[test]
    fn values_are_kept_by_cell() {
        let mut grid = Grid::new(raster(), 0).expect("twelve cells");
        *grid.get_mut(Cell::new(3, 1)).expect("inside") = 7;
        assert_eq!((grid.at(Point2::new(0.9, 2.6)), grid.get(Cell::new(4, 0))), (Some(&7), None));
        assert_eq!(grid.iter().filter(|(_, v)| **v == 7).map(|(cell, _)| cell).collect::<Vec<_>>(), [Cell::new(3, 1)]);
    }

    #[test]
    fn a_grid_takes_on_the_raster_of_another() {
        let mut grid = Grid::new(raster(), 7).expect("twelve cells");
        grid.reset_like(&Grid::<()>::default(), 1);
        assert!(grid.cells().is_empty());
        grid.reset_like(&Grid::new(raster(), 'x').expect("twelve cells"), 2);
        assert_eq!((grid.raster(), grid.cells()), (&raster(), [2; 12].as_slice()));
    }

    #[test]
    fn a_raster_covers_its_points_and_lies_on_others() {
        let points = [Point2::new(-0.26, 1.0), Point2::new(3.0, 7.9)];
        let raster = Raster::around(points, 0.1, 0.25);
        assert!(points.iter().all(|p| raster.cell(*p).is_some()));
        assert_eq!((raster.corner, raster.width, raster.height), (Point2::new(-0.5, 0.75), 15, 30));
        assert_eq!(Raster::around([], 0.0, 0.25).width, 1);
    }

    #[test]
    fn impossible_sizes_are_errors() {
        for (resolution, width) in [(0.0, 1), (f32::NAN, 1), (-1.0, 1), (1.0, MAX_CELLS), (1.0, usize::MAX)] {
            let raster = Raster { resolution, width, height: 2, ..Raster::default() };
            assert_eq!(Grid::new(raster, 0_u8).map_err(|e| e.0.width), Err(width), "{resolution}");
        }
        let raster = Raster { width: usize::MAX, height: 0, ..Raster::default() };
        assert!(Grid::new(raster, ()).is_err());
        let far = Raster::around([Point2::new(f32::MAX, 0.0), Point2::default()], 1.0, 0.05);
        assert!(Grid::new(far, 0_u8).is_err());
    }

    #[test]
    fn lines_reach_from_end_to_end() {
        for (to, count) in [((5, 2), 4), ((0, 0), 3), ((2, 9), 8), ((2, 2), 1)] {
            let (from, to) = (Cell::new(2, 2), Cell::new(to.0, to.1));
            let line: Vec<Cell> = Raster::line(from, to).collect();
            assert_eq!((line.len(), line[0], line[line.len() - 1]), (count, from, to));
            assert!(line.windows(2).all(|w| w[0].x.abs_diff(w[1].x) <= 1 && w[0].y.abs_diff(w[1].y) <= 1));
            let raster = Raster { width: 10, height: 10, ..Raster::default() };
            assert!(raster.line_of_indices(from, to).eq(line.iter().map(|cell| cell.y * 10 + cell.x)));
        }
    }
}
