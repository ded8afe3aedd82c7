use super::Pose;
use crate::scan::Point2;

/// Side of a cell of a level in cells of the next finer level, as a power of two.
const SHIFT: u32 = 2;
/// Number of levels: cells, blocks of 4 × 4, and blocks of 16 × 16.
pub(super) const LEVELS: usize = 3;
/// Radius of a smeared point, in standard deviations.
const REACH: f64 = 3.0;
/// Minimum increase of the value of its cell for which a point is added.
const ENOUGH: u8 = 25;
/// Resolution of the position of a point in its cell, in parts along x and y.
const PARTS: i32 = 8;

/// Smeared points of earlier scans. A scan is compared with them by looking up its points (Olson: Real-Time Correlative
/// Scan Matching, 2009).
///
/// A value is 255 exp(−d² / 2σ²) for the distance d of the centre of a cell from the nearest point. Coarser levels
/// contain the greatest value that a point can reach if it is moved by up to the side of a block.
#[derive(Debug, Clone)]
pub(super) struct Table {
    /// Side of a cell, in m.
    pub resolution: f64,
    /// Corner with the least x and y, in m.
    corner: [f64; 2],
    /// Number of cells of the finest level along x and along y.
    side: usize,
    levels: [Vec<u8>; LEVELS],
    /// exp(−d² / 2σ²) by the distance d along one axis, in parts of a cell.
    kernel: Vec<f32>,
    /// Radius of the kernel, in cells.
    reach: usize,
}

/// Side of a block of a level, in cells.
pub(super) const fn block(level: usize) -> i32 {
    1 << (SHIFT * level as u32)
}

impl Table {
    /// Creates an empty table with cells of `resolution` m, which smears points with a standard deviation of `smear` m.
    pub fn new(resolution: f64, smear: f64) -> Self {
        let reach = (REACH * smear / resolution).ceil() as usize;
        let value = |i: usize| (-0.5 * (i as f64 / f64::from(PARTS) * resolution / smear).powi(2)).exp() as f32;
        let kernel = (0..=reach * PARTS as usize).map(value).collect();
        Self { resolution, corner: [0.0; 2], side: 0, levels: Default::default(), kernel, reach }
    }

    /// Clears the table and makes it a square that extends `radius` m to each side of a point.
    pub fn reset(&mut self, centre: &Pose, radius: f64) {
        // Whole blocks of the coarsest level, and two more on each side: no lookup is outside.
        let coarsest = block(LEVELS - 1) as usize;
        let blocks = (2.0 * radius / self.resolution) as usize / coarsest + 5;
        self.side = blocks * coarsest;
        let half = 0.5 * self.side as f64 * self.resolution;
        self.corner = [centre.translation.x - half, centre.translation.y - half];
        for (level, cells) in self.levels.iter_mut().enumerate() {
            cells.clear();
            cells.resize((self.side >> (SHIFT * level as u32)).pow(2), 0);
        }
    }

    /// Adds the points of a scan taken at `pose`. Points outside the square are skipped.
    pub fn add(&mut self, pose: &Pose, points: &[Point2]) {
        let (place, margin) = (Placement::new(self, pose), self.reach as i32 + 2 * block(LEVELS - 1));
        let inside = margin..self.side as i32 - margin;
        for point in points {
            let (x, y) = place.position(point);
            let (column, row) = (x.floor() as i32, y.floor() as i32);
            if !inside.contains(&column) || !inside.contains(&row) {
                continue;
            }
            let parts = |cells: f64| (cells * f64::from(PARTS)) as i32;
            let (x, y) = (parts(x), parts(y));
            // Most points are seen by many scans: a position slightly nearer to the centre of the cell is not worth the
            // time.
            if self.fine(column, row).saturating_add(ENOUGH) < self.value(x, y, (column, row), 0) {
                (0..LEVELS).for_each(|level| self.stamp(level, x, y));
            }
        }
    }

    /// Value that a point gives to the nearest cell of a square. The square begins at `first` and has `more` additional
    /// cells along x and y.
    fn value(&self, x: i32, y: i32, first: (i32, i32), more: i32) -> u8 {
        let outside = |at: i32, first: i32| {
            let centre = |cell: i32| cell * PARTS + PARTS / 2;
            (centre(first) - at).max(at - centre(first + more)).max(0) as usize
        };
        let share = |distance: usize| self.kernel.get(distance).copied().unwrap_or(0.0);
        (255.0 * share(outside(x, first.0)) * share(outside(y, first.1))).round() as u8
    }

    /// Raises the values of one level around a point.
    fn stamp(&mut self, level: usize, x: i32, y: i32) {
        let (reach, shift) = (self.reach as i32, SHIFT * level as u32);
        let width = self.side >> shift;
        // A point in any cell of a block, moved by less than the side of the block, reaches cells up to here behind its
        // first one.
        let last = 2 * block(level) - 2;
        let blocks = |at: i32| (at / PARTS - reach - last) >> shift..=(at / PARTS + reach) >> shift;
        for row in blocks(y) {
            for column in blocks(x) {
                let value = self.value(x, y, (column << shift, row << shift), last);
                let cell = &mut self.levels[level][row as usize * width + column as usize];
                *cell = (*cell).max(value);
            }
        }
    }

    /// Sum of the values at cells moved by (`x`, `y`) cells. On a coarser level it is an upper bound.
    pub fn sum(&self, level: usize, cells: &[(i32, i32)], x: i32, y: i32) -> u32 {
        let (shift, table) = (SHIFT * level as u32, &self.levels[level]);
        let width = (self.side >> shift) as i32;
        let value = |&(cx, cy): &(i32, i32)| {
            let at = ((cy + y) >> shift) * width + ((cx + x) >> shift);
            table.get(at as usize).map_or(0, |&value| u32::from(value))
        };
        cells.iter().map(value).sum()
    }

    /// Interpolated value at a point of the frame of the map, from 0 to 1, and its derivatives with respect to x and y,
    /// in 1/m.
    pub fn at(&self, x: f64, y: f64) -> (f64, [f64; 2]) {
        let (x, y) = ((x - self.corner[0]) / self.resolution - 0.5, (y - self.corner[1]) / self.resolution - 0.5);
        let (column, row) = (x.floor(), y.floor());
        let (u, v) = (x - column, y - row);
        let value = |dx: i32, dy: i32| {
            f64::from(self.fine((column as i32).saturating_add(dx), (row as i32).saturating_add(dy))) / 255.0
        };
        let [a, b, c, d] = [value(0, 0), value(1, 0), value(0, 1), value(1, 1)];
        let (low, high) = (a + u * (b - a), c + u * (d - c));
        let dx = (1.0 - v) * (b - a) + v * (d - c);
        (low + v * (high - low), [dx / self.resolution, (high - low) / self.resolution])
    }

    fn fine(&self, x: i32, y: i32) -> u8 {
        let inside = 0..self.side as i32;
        if inside.contains(&x) && inside.contains(&y) { self.levels[0][y as usize * self.side + x as usize] } else { 0 }
    }
}

/// Transformation of points of a frame into cells of a table.
pub(super) struct Placement {
    cos: f64,
    sin: f64,
    x: f64,
    y: f64,
}

impl Placement {
    /// Creates the transformation for points of the frame `pose`.
    pub fn new(table: &Table, pose: &Pose) -> Self {
        let (cos, sin) = (pose.rotation.re / table.resolution, pose.rotation.im / table.resolution);
        let cells = |position: f64, corner: f64| (position - corner) / table.resolution;
        let t = &pose.translation;
        Self { cos, sin, x: cells(t.x, table.corner[0]), y: cells(t.y, table.corner[1]) }
    }

    /// Position of a point, in cells from the corner.
    fn position(&self, point: &Point2) -> (f64, f64) {
        let (x, y) = (f64::from(point.x), f64::from(point.y));
        (self.x + self.cos * x - self.sin * y, self.y + self.sin * x + self.cos * y)
    }

    /// Cell of a point.
    pub fn cell(&self, point: &Point2) -> (i32, i32) {
        let (x, y) = self.position(point);
        (x.floor() as i32, y.floor() as i32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::slam::pose;

    #[test]
    fn coarse_levels_are_never_below_what_they_stand_for() {
        let mut table = Table::new(0.1, 0.1);
        table.reset(&pose(5.0, 5.0, 0.0), 3.0);
        let points: Vec<Point2> = (0..20).map(|i| Point2::new(0.1 * i as f32, (0.7 * i as f32).sin())).collect();
        let at = pose(4.0, 5.0, 0.3);
        table.add(&at, &points);
        let place = Placement::new(&table, &at);
        let cells: Vec<_> = points.iter().map(|p| place.cell(p)).collect();
        for level in 1..LEVELS {
            let size = block(level);
            for (x, y) in [(-7, 3), (0, 0), (-16, -16), (5, 9)] {
                let bound = table.sum(level, &cells, x, y);
                let inside = (0..size * size).map(|i| table.sum(0, &cells, x + i % size, y + i / size));
                let best = inside.max().unwrap_or(0);
                assert!(best > 0 && bound >= best, "level {level}, {bound} for {best}");
            }
        }
    }

    #[test]
    fn a_point_is_found_where_it_is() {
        let mut table = Table::new(0.05, 0.05);
        table.reset(&pose(0.0, 0.0, 0.0), 1.0);
        table.add(&pose(0.0, 0.0, 0.0), &[Point2::new(0.525, 0.525)]);
        let (value, slope) = table.at(0.525, 0.525);
        assert!(value > 0.97 && slope[0] < 0.0, "{value} {slope:?}");
        let (near, slope) = table.at(0.5, 0.525);
        assert!(near < value && slope[0] > 4.0 && slope[1].abs() < 9.0, "{near} {slope:?}");
        assert_eq!(table.at(40.0, 1e30).0, 0.0);
    }

    #[test]
    fn points_far_away_or_nowhere_are_left_out() {
        let mut table = Table::new(0.1, 0.1);
        table.reset(&pose(0.0, 0.0, 0.0), 1.0);
        let before = table.levels.clone();
        table.add(&pose(0.0, 0.0, 0.0), &[Point2::new(1e30, 0.0), Point2::new(-99.0, 0.0)]);
        assert_eq!(table.levels, before);
    }
}
