use super::{Cell, DistanceTransform, Grid, Occupancy};
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
}
