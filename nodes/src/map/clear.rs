use super::{Grid, Occupancy};
use crate::scan::Pose2;
use apex_rt::{Out, node};

/// Marks the cells of a map in a box as free, for example those of a container that a vehicle is to drive beneath.
///
/// `place` is the pose of the middle of the box in the frame of `pose`, which is in the frame of the map. It may be ⊥:
/// then the map remains as it is.
#[node]
#[derive(Debug, Clone)]
pub struct ClearBox {
    /// Size of the box along its heading.
    #[param(unit = "m", range = 0.0..=100.0)]
    length: f32,
    /// Size of the box across.
    #[param(unit = "m", range = 0.0..=100.0)]
    width: f32,
}

#[node]
impl ClearBox {
    fn process(
        &mut self,
        map: &Grid<Occupancy>,
        pose: &Pose2,
        place: Option<&Pose2>,
        cleared: &mut Out<Grid<Occupancy>>,
    ) {
        let cleared = cleared.get_mut();
        cleared.clone_from(map);
        let Some(middle) = place.map(|place| pose.compose(place)) else { return };
        for (cell, _) in map.iter() {
            let is_inside = middle.is_in_box(map.raster().centre(cell), self.length, self.width);
            if let Some(cell) = cleared.get_mut(cell).filter(|_| is_inside) {
                *cell = Occupancy::Free;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{map::Raster, scan::Point2};
    use apex_rt::Construct;
    use core::f32::consts::FRAC_PI_2;

    #[test]
    fn only_the_box_is_free() {
        let raster = Raster { corner: Point2::default(), resolution: 1.0, width: 5, height: 5 };
        let map = Grid::new(raster, Occupancy::Occupied).expect("small");
        let mut node = ClearBox::construct((3.0, 1.0));
        let pose = Pose2::new(2.5, 0.5, FRAC_PI_2);
        let mut clear = |place: Option<Pose2>| {
            let mut out = Out::new();
            node.process(&map, &pose, place.as_ref(), &mut out);
            let cleared = out.get().expect("a map");
            let free = cleared.iter().filter(|(_, cell)| **cell == Occupancy::Free);
            free.map(|(cell, _)| (cell.x, cell.y)).collect::<Vec<_>>()
        };
        assert_eq!(clear(Some(Pose2::new(2.0, 0.0, 0.0))), [(2, 1), (2, 2), (2, 3)]);
        assert_eq!(clear(Some(Pose2::new(2.0, 0.0, FRAC_PI_2))), [(1, 2), (2, 2), (3, 2)]);
        assert_eq!([clear(None), clear(Some(Pose2::new(f32::NAN, 0.0, 0.0)))], [[], []]);
    }
}
