use super::Grid;

/// Computes the distance of each cell of a grid from the nearest obstacle (Felzenszwalb and Huttenlocher 2012,
/// *Distance Transforms of Sampled Functions*). Exact, and linear in the number of cells. Keeps its buffers.
#[derive(Debug, Clone, Default)]
pub struct DistanceTransform {
    /// Distances within the columns of one row, in cells.
    columns: Vec<f32>,
    envelope: Vec<Parabola>,
}

/// Part of the lower envelope of the parabolas over a row.
#[derive(Debug, Clone, Copy)]
struct Parabola {
    /// Position of the vertex, in cells.
    x: f64,
    /// Height of the vertex: the square of the distance within the column.
    height: f64,
    /// Position from which on this parabola is the lowest.
    from: f64,
}

impl DistanceTransform {
    /// Writes the distance from the centre of each cell of `map` to the centre of the nearest obstacle, in m. It is 0
    /// on obstacles, and infinite if there are none.
    pub fn run<T>(&mut self, map: &Grid<T>, is_obstacle: impl Fn(&T) -> bool, distances: &mut Grid<f32>) {
        distances.reset_like(map, f32::INFINITY);
        let (width, resolution) = (map.raster().width, map.raster().resolution);
        if width == 0 {
            return;
        }
        for (distance, value) in distances.cells_mut().iter_mut().zip(map.cells()) {
            if is_obstacle(value) {
                *distance = 0.0;
            }
        }
        along_columns(distances.cells_mut(), width);
        for row in distances.cells_mut().chunks_mut(width) {
            self.along_row(row, resolution);
        }
    }

    /// Turns distances within columns, in cells, into distances in the plane, in m.
    fn along_row(&mut self, row: &mut [f32], resolution: f32) {
        self.columns.clear();
        self.columns.extend_from_slice(row);
        self.build_envelope();
        let mut parts = self.envelope.iter().peekable();
        let mut lowest = None;
        for (x, distance) in row.iter_mut().enumerate() {
            let x = x as f64;
            while let Some(part) = parts.next_if(|part| part.from <= x) {
                lowest = Some(part);
            }
            if let Some(Parabola { x: foot, height, .. }) = lowest {
                *distance = ((x - foot).powi(2) + height).sqrt() as f32 * resolution;
            }
        }
    }

    fn build_envelope(&mut self) {
        self.envelope.clear();
        for (x, &distance) in self.columns.iter().enumerate().filter(|(_, distance)| distance.is_finite()) {
            let mut new = Parabola { x: x as f64, height: f64::from(distance).powi(2), from: f64::NEG_INFINITY };
            while let Some(last) = self.envelope.last() {
                new.from = crossing(last, &new);
                if new.from > last.from {
                    break;
                }
                self.envelope.pop();
                new.from = f64::NEG_INFINITY;
            }
            self.envelope.push(new);
        }
    }
}

/// Position at which two parabolas intersect. From there on `right` is lower.
fn crossing(left: &Parabola, right: &Parabola) -> f64 {
    let of = |p: &Parabola| p.height + p.x * p.x;
    (of(right) - of(left)) / (2.0 * (right.x - left.x))
}

/// Turns cells of 0 (obstacle) and infinity into distances to the nearest obstacle in the same column, in cells.
fn along_columns(cells: &mut [f32], width: usize) {
    for i in width..cells.len() {
        cells[i] = cells[i].min(cells[i - width] + 1.0);
    }
    for i in (width..cells.len()).rev() {
        cells[i - width] = cells[i - width].min(cells[i] + 1.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::map::Raster;
    use apex_sim::Random;

    fn raster(width: usize, height: usize) -> Raster {
        Raster { resolution: 0.5, width, height, ..Raster::default() }
    }

    /// Distances by definition: the minimum over all obstacles.
    fn by_trying_all(map: &Grid<bool>) -> Vec<f32> {
        let obstacles: Vec<_> = map.iter().filter(|(_, taken)| **taken).map(|(cell, _)| cell).collect();
        map.iter()
            .map(|(at, _)| {
                let to = |o: &crate::map::Cell| (o.x.abs_diff(at.x).pow(2) + o.y.abs_diff(at.y).pow(2)) as f32;
                obstacles.iter().map(to).fold(f32::INFINITY, f32::min).sqrt() * 0.5
            })
            .collect()
    }

    #[test]
    fn distances_are_exact() {
        let mut random = Random::new(1);
        let (mut transform, mut distances) = (DistanceTransform::default(), Grid::default());
        for round in 0..60 {
            let mut size = || random.uniform(1.0, 40.0) as usize;
            let (width, height) = (size(), size());
            let mut map = Grid::new(raster(width, height), false).expect("small");
            let density = [0.0, 0.003, 0.05, 0.6][round % 4];
            map.cells_mut().iter_mut().for_each(|cell| *cell = random.chance(density));
            transform.run(&map, |taken| *taken, &mut distances);
            let expected = by_trying_all(&map);
            assert_eq!(distances.raster(), map.raster());
            for (is, should) in distances.cells().iter().zip(&expected) {
                assert!(is == should || (is - should).abs() < 1e-6 * should, "{is} is {should}");
            }
        }
    }

    #[test]
    fn without_obstacles_all_is_far_away() {
        let (mut transform, mut distances) = (DistanceTransform::default(), Grid::default());
        transform.run(&Grid::new(raster(3, 2), ()).expect("small"), |()| false, &mut distances);
        assert_eq!(distances.cells(), [f32::INFINITY; 6]);
        transform.run(&Grid::<()>::default(), |()| true, &mut distances);
        assert_eq!(distances.cells(), []);
    }
}
