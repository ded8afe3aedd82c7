use super::{Cell, DistanceTransform, Grid, Occupancy, Raster};
use crate::scan::{Point2, Pose2};
use apex_rt::{Out, node};

/// Marks every cell as occupied whose centre is within `radius` m of the centre of an occupied cell. Cells within
/// `kept` m of a point of `around` are unchanged. `distances` are those to the nearest occupied cell, as written by
/// [`DistanceTransform`].
pub fn grow(map: &mut Grid<Occupancy>, distances: &Grid<f32>, radius: f32, around: &[Point2], kept: f32) {
    let raster = *map.raster();
    let is_kept = |i: usize| {
        let centre = raster.centre(Cell::new(i % raster.width, i / raster.width));
        around.iter().any(|point| (*point - centre).norm_squared() <= kept * kept)
    };
    for (i, (cell, distance)) in map.cells_mut().iter_mut().zip(distances.cells()).enumerate() {
        if *distance <= radius && !is_kept(i) {
            *cell = Occupancy::Occupied;
        }
    }
}

/// Fills small unknown regions with the state of most of the cells around them. Keeps its buffers.
#[derive(Debug, Clone, Default)]
pub struct UnknownRegions {
    visited: Vec<bool>,
    region: Vec<usize>,
}

/// Boundary of a region of unknown cells.
#[derive(Debug, Default)]
struct Rim {
    free: usize,
    occupied: usize,
    touches_border: bool,
}

impl UnknownRegions {
    /// Fills regions of unknown cells that are not larger than `largest_area` m² and do not touch the border of the
    /// map. Cells of a region are connected by their sides. The region gets the state of most sides around it; in a
    /// tie, it becomes occupied.
    pub fn close(&mut self, map: &mut Grid<Occupancy>, largest_area: f32) {
        let raster = *map.raster();
        // Casts of NaN give 0; casts of too large numbers saturate.
        let largest = (largest_area / (raster.resolution * raster.resolution) + 1e-3) as usize;
        self.visited.clear();
        self.visited.resize(map.cells().len(), false);
        for i in 0..map.cells().len() {
            if map.cells()[i] != Occupancy::Unknown || self.visited[i] {
                continue;
            }
            let rim = self.explore(map, i);
            if self.region.len() <= largest && !rim.touches_border {
                let fill = if rim.free > rim.occupied { Occupancy::Free } else { Occupancy::Occupied };
                self.region.iter().for_each(|&i| map.cells_mut()[i] = fill);
            }
        }
    }

    /// Collects the region of an unknown cell and returns its boundary.
    fn explore(&mut self, map: &Grid<Occupancy>, first: usize) -> Rim {
        let mut rim = Rim::default();
        self.region.clear();
        self.region.push(first);
        self.visited[first] = true;
        let mut next = 0;
        while let Some(&i) = self.region.get(next) {
            next += 1;
            let sides = sides(map.raster(), i);
            rim.touches_border |= sides.contains(&None);
            for side in sides.into_iter().flatten() {
                match map.cells()[side] {
                    Occupancy::Free => rim.free += 1,
                    Occupancy::Occupied | Occupancy::Low => rim.occupied += 1,
                    Occupancy::Unknown if !self.visited[side] => {
                        self.visited[side] = true;
                        self.region.push(side);
                    }
                    Occupancy::Unknown => {}
                }
            }
        }
        rim
    }
}

/// Cells at the four sides of a cell; `None` outside the raster.
fn sides(raster: &Raster, i: usize) -> [Option<usize>; 4] {
    let (x, y, width) = (i % raster.width, i / raster.width, raster.width);
    [
        (x > 0).then(|| i - 1),
        (x + 1 < width).then(|| i + 1),
        (y > 0).then(|| i - width),
        (y + 1 < raster.height).then(|| i + width),
    ]
}

/// Fills small unknown regions inside a map with the state of most of the cells around them (thesis 4.3.6).
#[node]
#[derive(Debug, Clone)]
pub struct CloseUnknown {
    /// Maximum area of a region that is filled.
    #[param(unit = "m^2", default = 0.25, range = 0.0..=100.0)]
    largest_area: f32,
    regions: UnknownRegions,
}

#[node]
impl CloseUnknown {
    fn process(&mut self, map: &Grid<Occupancy>, closed: &mut Out<Grid<Occupancy>>) {
        let closed = closed.get_mut();
        closed.clone_from(map);
        self.regions.close(closed, self.largest_area);
    }
}

/// Grows obstacles, so that paths can be planned for a point instead of a robot (thesis 4.3.6).
///
/// Discs around `start` and `goal` are unchanged, so that a path may begin and end close to obstacles. Both are in the
/// frame of the map.
#[node]
#[derive(Debug, Clone)]
pub struct GrowObstacles {
    /// Distance by which obstacles grow: the radius of the robot.
    #[param(unit = "m", default = 0.35, range = 0.0..=10.0)]
    radius: f32,
    /// Radius of the discs that are unchanged.
    #[param(unit = "m", default = 0.5, range = 0.0..=10.0)]
    kept: f32,
    transform: DistanceTransform,
    distances: Grid<f32>,
}

#[node]
impl GrowObstacles {
    fn process(
        &mut self,
        map: &Grid<Occupancy>,
        start: Option<&Pose2>,
        goal: Option<&Pose2>,
        grown: &mut Out<Grid<Occupancy>>,
    ) {
        self.transform.run(map, |cell| cell.is_obstacle(), &mut self.distances);
        let grown = grown.get_mut();
        grown.clone_from(map);
        let nowhere = Point2::new(f32::NAN, f32::NAN);
        let around = [start, goal].map(|pose| pose.map_or(nowhere, Pose2::position));
        grow(grown, &self.distances, self.radius, &around, self.kept);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::map::drawn as map;
    use apex_rt::Construct;

    #[test]
    fn obstacles_grow_by_the_radius() {
        let grown = |start: Option<&Pose2>| {
            let mut out = Out::new();
            let mut node = GrowObstacles::construct((1.5, 0.6));
            node.process(&map(&["......", "..#...", "......", "?....."]), start, None, &mut out);
            out.get().expect("a map").clone()
        };
        assert_eq!(grown(None), map(&[".###..", ".###..", ".###..", "?....."]));
        // Around the start nothing changes.
        assert_eq!(grown(Some(&Pose2::new(1.5, 0.5, 0.0))), map(&["..##..", ".###..", ".###..", "?....."]));
    }

    #[test]
    fn small_unknown_regions_are_filled() {
        let closed = |largest_area| {
            let mut out = Out::new();
            let open = map(&["?.......", "...??.##", "...???#?", "......##", "........"]);
            CloseUnknown::construct((largest_area,)).process(&open, &mut out);
            out.get().expect("a map").clone()
        };
        // The region on the right touches the border.
        assert_eq!(closed(5.0), map(&["?.......", "......##", "......#?", "......##", "........"]));
        assert_eq!(closed(4.9), map(&["?.......", "...??.##", "...???#?", "......##", "........"]));
        assert_eq!(closed(f32::NAN), closed(0.0));
    }

    #[test]
    fn the_inside_of_an_obstacle_is_occupied() {
        let mut pillar = map(&[".....", ".###.", ".#?#.", ".###.", "....."]);
        UnknownRegions::default().close(&mut pillar, 1.0);
        assert_eq!(pillar.get(Cell::new(2, 2)), Some(&Occupancy::Occupied));
    }
}
