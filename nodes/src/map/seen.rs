use super::{Grid, Occupancy};
use crate::scan::{Point2, Pose2};
use apex_rt::{Out, node};

/// Map of what a camera has looked at: a free cell that it has not seen is unknown.
///
/// So a robot that explores this map looks at the whole ground, and not only at what its scanner measures from afar. A
/// cell is seen if it was within `reach` of the camera, within its angle, and not hidden; what is around the robot up
/// to `near` counts as seen. `pose` is that of the robot in the frame of the map; the camera is in its middle. A map
/// may grow: what was seen remains, as long as the resolution is the same.
#[node]
#[derive(Debug, Clone)]
pub struct SeenMap {
    /// Distance up to which the camera shows what is looked for.
    #[param(unit = "m", default = 3.0, range = 0.0..=100.0)]
    reach: f32,
    /// Angle of the camera's view across, about the x axis of the robot.
    #[param(unit = "rad", default = 1.0, range = 0.0..=6.3)]
    view_angle: f32,
    /// Distance around the robot that counts as seen.
    #[param(unit = "m", default = 0.5, range = 0.0..=100.0)]
    near: f32,
    seen: Grid<bool>,
    before: Grid<bool>,
}

#[node]
impl SeenMap {
    fn process(&mut self, map: &Grid<Occupancy>, pose: &Pose2, seen: &mut Out<Grid<Occupancy>>) {
        self.follow(map);
        if pose.is_usable() {
            self.look(map, pose);
        }
        let seen = seen.get_mut();
        seen.clone_from(map);
        for (cell, is_seen) in seen.cells_mut().iter_mut().zip(self.seen.cells()) {
            if *cell == Occupancy::Free && !is_seen {
                *cell = Occupancy::Unknown;
            }
        }
    }

    /// Adopts the raster of the map.
    fn follow(&mut self, map: &Grid<Occupancy>) {
        if self.seen.raster() == map.raster() {
            return;
        }
        core::mem::swap(&mut self.seen, &mut self.before);
        self.seen.reset_like(map, false);
        for (cell, _) in self.before.iter().filter(|(_, is_seen)| **is_seen) {
            let place = map.raster().cell(self.before.raster().centre(cell));
            if let Some(cell) = place.and_then(|cell| self.seen.get_mut(cell)) {
                *cell = true;
            }
        }
    }

    /// Marks the cells in view along rays that are less than a cell apart.
    fn look(&mut self, map: &Grid<Occupancy>, pose: &Pose2) {
        let resolution = map.raster().resolution;
        let rays = |angle: f32, reach: f32| ((angle * reach / resolution) as i32).clamp(0, 2000) + 1;
        let half = 0.5 * self.view_angle;
        let [ahead, around] = [rays(half, self.reach), rays(core::f32::consts::PI, self.near)];
        let turned = |i: i32, of: i32, half: f32| pose.theta + half * i as f32 / of as f32;
        for i in -ahead..=ahead {
            self.cast(map, pose.position(), turned(i, ahead, half), self.reach);
        }
        for i in -around..=around {
            self.cast(map, pose.position(), turned(i, around, core::f32::consts::PI), self.near);
        }
    }

    /// Marks the cells of a ray up to the first one that is not free.
    fn cast(&mut self, map: &Grid<Occupancy>, from: Point2, heading: f32, reach: f32) {
        let step = 0.5 * map.raster().resolution;
        let steps = ((reach / step) as i32).clamp(0, 4000);
        for i in 0..=steps {
            let place = from + Point2::polar(step * i as f32, heading);
            let free = map.raster().cell(place).filter(|cell| map.get(*cell) == Some(&Occupancy::Free));
            let Some(cell) = free.and_then(|cell| self.seen.get_mut(cell)) else { return };
            *cell = true;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::map::Raster;
    use apex_rt::Construct;
    use core::f32::consts::PI;

    fn map(corner: f32, side: usize) -> Grid<Occupancy> {
        let raster = Raster { corner: Point2::new(corner, corner), resolution: 0.1, width: side, height: side };
        Grid::new(raster, Occupancy::Free).expect("small")
    }

    fn look(node: &mut SeenMap, map: &Grid<Occupancy>, heading: f32) -> Grid<Occupancy> {
        let mut out = Out::new();
        node.process(map, &Pose2::new(0.0, 0.0, heading), &mut out);
        out.get().cloned().expect("a map")
    }

    #[test]
    fn only_what_is_in_view_is_seen() {
        let mut map = map(-5.0, 100);
        let wall = map.raster().cell(Point2::new(1.55, 0.05)).expect("inside");
        *map.get_mut(wall).expect("inside") = Occupancy::Occupied;
        let mut node = SeenMap::construct((2.0, 1.0, 0.3));
        let seen = look(&mut node, &map, 0.0);
        let at = |x, y| *seen.at(Point2::new(x, y)).expect("inside");
        assert_eq!([at(1.05, 0.05), at(1.05, 0.45), at(0.05, -0.25)], [Occupancy::Free; 3]);
        // Beside the view, too far away, and behind the wall.
        assert_eq!([at(1.05, 0.95), at(2.25, 0.55), at(1.75, 0.05), at(-0.95, 0.05)], [Occupancy::Unknown; 4]);
        assert_eq!(at(1.55, 0.05), Occupancy::Occupied);
    }

    #[test]
    fn what_was_seen_remains_when_the_map_grows() {
        let (small, large) = (map(-3.0, 60), map(-5.0, 100));
        let mut node = SeenMap::construct((2.0, 1.0, 0.3));
        look(&mut node, &small, 0.0);
        let seen = look(&mut node, &large, PI);
        let at = |x| *seen.at(Point2::new(x, 0.05)).expect("inside");
        assert_eq!([at(1.55), at(-1.55), at(3.55)], [Occupancy::Free, Occupancy::Free, Occupancy::Unknown]);
        let mut out = Out::new();
        node.process(&large, &Pose2::new(f32::NAN, 0.0, 0.0), &mut out);
        assert_eq!(out.get(), Some(&seen), "without a pose nothing is seen");
    }
}
