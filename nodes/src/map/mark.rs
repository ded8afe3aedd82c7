use super::{Grid, Occupancy};
use crate::scan::{BeamDirections, Pose2, Scan};
use apex_rt::{Out, node};

/// Marks the cells that contain points of a scan as occupied (thesis 4.3.6, the combined map m′). `pose` is the pose
/// of the scanner in the frame of the map.
///
/// Several scanners need several of these nodes in sequence.
#[node]
#[derive(Debug, Clone, Default)]
pub struct MarkScan {
    directions: BeamDirections,
}

#[node]
impl MarkScan {
    fn process(&mut self, map: &Grid<Occupancy>, scan: &Scan, pose: &Pose2, marked: &mut Out<Grid<Occupancy>>) {
        let marked = marked.get_mut();
        marked.clone_from(map);
        let (raster, frame) = (*map.raster(), pose.transform());
        for (_, point) in self.directions.points(scan) {
            if let Some(cell) = raster.cell(frame.to_outer(point)).and_then(|cell| marked.get_mut(cell)) {
                *cell = Occupancy::Occupied;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::map::{Cell, Raster};
    use core::f32::consts::FRAC_PI_2;

    #[test]
    fn points_are_marked_where_they_lie() {
        let raster = Raster { width: 5, height: 5, ..Raster::default() };
        let map = Grid::new(raster, Occupancy::Free).expect("small");
        let mut scan = Scan { angle_increment: FRAC_PI_2, ..Scan::default() };
        scan.ranges.extend([2.0, 1.0, f32::NAN, 100.0]);
        let mut out = Out::new();
        MarkScan::default().process(&map, &scan, &Pose2::new(2.5, 1.5, FRAC_PI_2), &mut out);
        let marked: Vec<Cell> = out
            .get()
            .expect("a map")
            .iter()
            .filter(|(_, c)| **c == Occupancy::Occupied)
            .map(|(cell, _)| cell)
            .collect();
        assert_eq!(marked, [Cell::new(1, 1), Cell::new(2, 3)]);
        MarkScan::default().process(&map, &scan, &Pose2::new(f32::NAN, 0.0, 0.0), &mut out);
        assert_eq!(out.get(), Some(&map));
    }
}
