use crate::{map::Raster, scan::Point2};

/// Maximum number of cells on a side.
const MAX_SIDE: usize = 4096;

/// Square window of a grid map that follows the robot, as a cyclic buffer (thesis 6.5.3): cells that stay in the window
/// are not copied.
#[derive(Debug, Clone, Default)]
pub(super) struct Rolling<T> {
    cells: Vec<T>,
    side: usize,
    resolution: f32,
    /// Number of the first column and row of the window, counted from the origin of the map.
    corner: [i64; 2],
}

impl<T: Copy + Default> Rolling<T> {
    /// Moves the window so that `centre` is in its middle. Cells that come in are empty; all are, if the size changes.
    /// The coordinates have to be those of a usable pose.
    pub fn follow(&mut self, centre: Point2, size: f32, resolution: f32) {
        // A cast of a number that is not finite or negative saturates.
        let side = ((size / resolution).ceil() as usize).clamp(1, MAX_SIDE);
        let half = (side / 2) as i64;
        let corner = [centre.x, centre.y].map(|c| ((c / resolution).floor() as i64).saturating_sub(half));
        let moved = [0, 1].map(|axis| corner[axis].abs_diff(self.corner[axis]));
        let is_new = side != self.side || resolution != self.resolution;
        let old = core::mem::replace(&mut self.corner, corner);
        if is_new || moved.iter().any(|cells| *cells >= side as u64) {
            (self.side, self.resolution) = (side, resolution);
            self.cells.clear();
            self.cells.resize(side * side, T::default());
            return;
        }
        for axis in [0, 1] {
            let coming = if corner[axis] > old[axis] {
                old[axis] + side as i64..corner[axis] + side as i64
            } else {
                corner[axis]..old[axis]
            };
            coming.for_each(|line| self.clear_line(axis, line));
        }
    }

    /// Index of the cell of a point of the map, or `None` outside the window.
    #[inline]
    pub fn index(&self, point: Point2) -> Option<usize> {
        let cell = [point.x, point.y].map(|c| (c / self.resolution).floor());
        let inside = |axis: usize| {
            // A cast of a large number saturates.
            let offset = (cell[axis] as i64).saturating_sub(self.corner[axis]);
            (cell[axis].is_finite() && (0..self.side as i64).contains(&offset)).then(|| self.slot(cell[axis] as i64))
        };
        Some(inside(1)? * self.side + inside(0)?)
    }

    /// Value of a cell by its index.
    pub fn get(&self, index: usize) -> T {
        self.cells[index]
    }

    /// Value of a cell for modification.
    pub fn get_mut(&mut self, index: usize) -> &mut T {
        &mut self.cells[index]
    }

    /// Values of all cells, row by row from the least y, in the order of a grid with the raster of the window.
    pub fn values(&self) -> impl Iterator<Item = T> + '_ {
        let line = move |axis: usize| (0..self.side as i64).map(move |i| self.slot(self.corner[axis] + i));
        line(1).flat_map(move |row| line(0).map(move |column| self.cells[row * self.side + column]))
    }

    /// Raster of the window.
    pub fn raster(&self) -> Raster {
        let [x, y] = self.corner.map(|cell| cell as f32 * self.resolution);
        Raster { corner: Point2::new(x, y), resolution: self.resolution, width: self.side, height: self.side }
    }

    fn clear_line(&mut self, axis: usize, line: i64) {
        let fixed = self.slot(line);
        for other in 0..self.side {
            let index = if axis == 0 { other * self.side + fixed } else { fixed * self.side + other };
            self.cells[index] = T::default();
        }
    }

    fn slot(&self, cell: i64) -> usize {
        cell.rem_euclid(self.side.max(1) as i64) as usize
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_stays_in_view_is_remembered() {
        let mut map = Rolling::<u8>::default();
        map.follow(Point2::new(0.0, 0.0), 2.0, 0.5);
        for (x, value) in [(-0.75, 1), (0.25, 2)] {
            let index = map.index(Point2::new(x, 0.25)).expect("inside");
            *map.get_mut(index) = value;
        }
        assert_eq!(map.values().filter(|v| *v > 0).collect::<Vec<_>>(), [1, 2]);
        map.follow(Point2::new(0.6, 0.0), 2.0, 0.5);
        assert_eq!((map.index(Point2::new(-0.75, 0.25)), map.raster().corner), (None, Point2::new(-0.5, -1.0)));
        assert_eq!(map.values().filter(|v| *v > 0).collect::<Vec<_>>(), [2]);
        let back = map.index(Point2::new(1.25, 0.25)).expect("inside");
        assert_eq!(map.get(back), 0, "its place is that of a cell that left");
        map.follow(Point2::new(-50.0, 3.0), 2.0, 0.5);
        assert!(map.values().all(|v| v == 0));
        for outside in [Point2::new(f32::NAN, 0.0), Point2::new(f32::INFINITY, 0.0), Point2::new(0.0, 0.0)] {
            assert_eq!(map.index(outside), None);
        }
        map.follow(Point2::new(0.0, 0.0), f32::NAN, 0.5);
        assert_eq!(map.raster().width, 1);
    }
}
