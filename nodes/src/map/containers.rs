use super::{Grid, Occupancy};
use crate::scan::{Containers, Point2, Pose2};
use apex_rt::{Out, node};

/// Marks the areas of containers in a map: a scanner sees only their wheels, and no way leads between them.
///
/// `containers` are in the frame of `odometry`. `pose` is the pose of the robot in the frame of `map`; while it is not
/// known, nothing is marked. A container above the robot is left out.
#[node]
#[derive(Debug, Clone)]
pub struct MarkContainers {
    /// Length of a container.
    #[param(unit = "m", default = 1.2, range = 0.0..=100.0)]
    length: f32,
    /// Width of a container.
    #[param(unit = "m", default = 0.7, range = 0.0..=100.0)]
    width: f32,
    /// Distance from a container up to which the robot is beneath it.
    #[param(unit = "m", default = 0.3, range = 0.0..=100.0)]
    beneath: f32,
}

#[node]
impl MarkContainers {
    fn process(
        &mut self,
        map: &Grid<Occupancy>,
        pose: Option<&Pose2>,
        odometry: &Pose2,
        containers: Option<&Containers>,
        marked: &mut Out<Grid<Occupancy>>,
    ) {
        let marked = marked.get_mut();
        marked.clone_from(map);
        let pose = pose.filter(|pose| pose.is_usable() && odometry.is_usable());
        let Some((pose, containers)) = pose.zip(containers) else { return };
        for container in &containers.poses {
            let place = pose.compose(&container.relative_to(odometry));
            let [length, width] = [self.length, self.width].map(|side| side + 2.0 * self.beneath);
            if !place.is_in_box(pose.position(), length, width) {
                self.mark(marked, &place);
            }
        }
    }

    /// Marks the cells of points in the area of a container, of which there are two in each cell.
    fn mark(&self, map: &mut Grid<Occupancy>, place: &Pose2) {
        let raster = *map.raster();
        let counts =
            [self.length, self.width].map(|side| libm::ceilf(2.0 * side / raster.resolution).clamp(1.0, 1000.0));
        let [rows, columns] = counts.map(|count| 0..=count as u16);
        for (i, j) in rows.flat_map(|i| columns.clone().map(move |j| (i, j))) {
            let x = (f32::from(i) / counts[0] - 0.5) * self.length;
            let y = (f32::from(j) / counts[1] - 0.5) * self.width;
            let point = place.to_outer(Point2::new(x, y));
            if let Some(cell) = raster.cell(point).and_then(|cell| map.get_mut(cell)) {
                *cell = Occupancy::Occupied;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::map::{Cell, Raster};
    use apex_rt::Construct;

    const ODOMETRY: Pose2 = Pose2::new(5.0, 5.0, 1.0);

    /// The map of 4 m × 4 m around the origin, with a container at a pose relative to a robot at another pose.
    fn marked(robot: Option<Pose2>, container: Pose2) -> Grid<Occupancy> {
        let raster = Raster { corner: Point2::new(-2.0, -2.0), resolution: 0.1, width: 40, height: 40 };
        let map = Grid::new(raster, Occupancy::Free).expect("small");
        let mut containers = Containers::default();
        containers.poses.push(ODOMETRY.compose(&container)).expect("room");
        let mut out = Out::new();
        MarkContainers::construct((1.2, 0.7, 0.3)).process(
            &map,
            robot.as_ref(),
            &ODOMETRY,
            Some(&containers),
            &mut out,
        );
        out.get().cloned().expect("a map")
    }

    fn count(map: &Grid<Occupancy>) -> usize {
        map.cells().iter().filter(|cell| **cell == Occupancy::Occupied).count()
    }

    #[test]
    fn the_area_of_a_container_is_not_free() {
        let robot = Pose2::new(-1.5, 0.0, 0.0);
        for turn in [0.0, 0.4, 1.5] {
            let map = marked(Some(robot), Pose2::new(1.5, 0.05, turn));
            assert!((84..140).contains(&count(&map)), "{} cells", count(&map));
            assert_eq!(map.get(Cell::new(20, 20)), Some(&Occupancy::Occupied));
        }
        // Partly outside of the map, and far away from it.
        assert!((20..84).contains(&count(&marked(Some(robot), Pose2::new(3.5, 0.0, 0.0)))));
        assert_eq!(count(&marked(Some(robot), Pose2::new(1e9, 0.0, 0.0))), 0);
    }

    #[test]
    fn without_a_pose_and_beneath_a_container_nothing_is_marked() {
        let (here, nan) = (Pose2::default(), Pose2::new(f32::NAN, 0.0, 0.0));
        assert_eq!(count(&marked(None, Pose2::new(1.5, 0.0, 0.0))), 0);
        assert_eq!(count(&marked(Some(nan), Pose2::new(1.5, 0.0, 0.0))), 0);
        assert_eq!(count(&marked(Some(here), nan)), 0);
        assert_eq!([0.5, 1.5].map(|x| count(&marked(Some(here), Pose2::new(x, 0.0, 0.0))) > 0), [false, true]);
    }
}
