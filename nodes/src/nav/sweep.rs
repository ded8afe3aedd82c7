use super::{
    Articulated, Clearance, Twist,
    latest::{Latest, Measured, both_fresh},
    near::Near,
    outline::Axes,
    twist::Command,
};
use crate::{
    map::{Grid, Occupancy},
    scan::Pose2,
};
use apex_rt::{Ctx, node};

/// Distance between predicted places, in m.
const STEP: f32 = 0.04;

/// Stops a tractor with a trailer before it drives over an obstacle, missing floor, or floor that was not seen.
///
/// `map` is that of `HazardMap`. On the curve of the twist the vehicle keeps the `clearance` from what is not free in
/// it. Backward, that are also unknown cells: the vehicle only backs up over floor that was seen before. Forward, an
/// unknown cell counts if the camera should see it, and the vehicle stops while the camera still sees it: nearer to the
/// front it would no longer count. What is too near already must not come nearer, and what is beneath the vehicle does
/// not count. [`CurvePlanner`](super::CurvePlanner) and [`CurveFollower`](super::CurveFollower) keep the same
/// clearance.
///
/// `base` and `trailer` are the poses of the two axes in the frame of the map, such as that of odometry. `map` may be
/// ⊥, as clouds come less often than twists: the last map counts for `max_age`. The vehicle stops without such a map,
/// so that a broken camera is not taken for free floor, at once without poses, and if the last twist is that old.
#[node]
#[derive(Debug, Clone)]
pub struct SweepStop {
    /// Shape of the vehicle.
    #[param(default = Articulated::PATSY)]
    vehicle: Articulated,
    /// Distances kept from hazards.
    #[param(default = Clearance::PATSY)]
    clearance: Clearance,
    /// Deceleration of the vehicle.
    #[param(unit = "m/s^2", default = 0.6, range = 0.01..=100.0)]
    deceleration: f32,
    /// Length of the curve that is predicted.
    #[param(unit = "m", default = 1.0, range = 0.0..=10.0)]
    look_ahead: f32,
    /// Maximum age of a map and of a twist.
    #[param(unit = "s", default = 0.6, range = 0.01..=60.0, silence)]
    max_age: f32,
    last: Latest<Grid<Occupancy>>,
    command: Command,
    /// Hazards near the vehicle.
    near: Near,
}

/// A map without cells says nothing.
impl Measured for Grid<Occupancy> {
    fn is_usable(&self) -> bool {
        !self.cells().is_empty()
    }
}

#[node]
impl SweepStop {
    fn process(
        &mut self,
        ctx: &Ctx,
        twist: Option<&Twist>,
        map: Option<&Grid<Occupancy>>,
        base: Option<&Pose2>,
        trailer: Option<&Pose2>,
    ) -> Option<Twist> {
        self.last.update(ctx, map, self.max_age);
        let twist = self.command.update(ctx, twist, self.max_age);
        let axes = both_fresh(ctx, [base, trailer], self.max_age).map(|(base, trailer)| [*base, *trailer]);
        let gap = axes.and_then(|now| self.gap(ctx, &twist, &now));
        let limited = gap.map_or(Twist::ZERO, |gap| twist.stoppable(gap, self.deceleration, 0.0));
        self.command.send(limited)
    }

    /// Distance that the vehicle can drive before it is too near to a hazard, in m; `None` without a map.
    fn gap(&mut self, ctx: &Ctx, twist: &Twist, now: &Axes) -> Option<f32> {
        let map = self.last.young(ctx, self.max_age)?;
        if twist.x == 0.0 {
            return Some(f32::INFINITY);
        }
        let Self { vehicle, clearance, look_ahead, .. } = *self;
        let is_backward = twist.x < 0.0;
        let zone = clearance.zone(vehicle, is_backward);
        let hazards = clearance.hazards(map, vehicle, now, is_backward);
        self.near.find(&zone, now, look_ahead, hazards);
        Some(self.near.gap(&zone, vehicle.places(now, twist, STEP), STEP, look_ahead))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        map::{Cell, Raster},
        scan::Point2,
    };
    use apex_rt::{Construct, Time};
    use core::f32::consts::FRAC_PI_2;

    const CLEARANCE: Clearance = Clearance { side: 0.05, ahead: 0.2, unknown: 0.03, near: 0.4, view_angle: 1.0 };

    fn node() -> SweepStop {
        SweepStop::construct((Articulated::PATSY, CLEARANCE, 0.5, 1.0, 0.6))
    }

    /// Floor of 6 m × 6 m about the origin with one cell that is not free.
    fn floor(place: Point2, cell: Occupancy) -> Grid<Occupancy> {
        let raster = Raster { corner: Point2::new(-3.0, -3.0), resolution: 0.05, width: 120, height: 120 };
        let mut map = Grid::new(raster, Occupancy::Free).expect("small");
        *map.get_mut(raster.cell(place).expect("inside")).expect("inside") = cell;
        map
    }

    /// Speed that is left of a curve at 1 m/s before a cell that is not free.
    fn speed(place: (f32, f32), cell: Occupancy, twist: Twist) -> f32 {
        let map = floor(Point2::new(place.0, place.1), cell);
        let base = Pose2::default();
        let trailer = Articulated::PATSY.trailer(&base, 0.0);
        let ctx = Ctx::new(Time::ZERO);
        let limited = node().process(&ctx, Some(&twist), Some(&map), Some(&base), Some(&trailer)).expect("a command");
        assert!((limited.omega * twist.x - twist.omega * limited.x).abs() < 1e-5, "the same curve");
        limited.x
    }

    #[test]
    fn obstacles_ahead_and_behind_count_but_not_beside() {
        let (ahead, back) = (Twist::new(1.0, 0.0, 0.0), Twist::new(-1.0, 0.0, 0.0));
        let near = speed((0.61, 0.1), Occupancy::Occupied, ahead);
        assert!((0.4..0.6).contains(&near), "{near}");
        assert_eq!(speed((0.61, 0.31), Occupancy::Occupied, ahead), 1.0);
        assert_eq!(speed((0.1, 0.1), Occupancy::Occupied, ahead), 1.0, "beneath the vehicle");
        assert_eq!(speed((-1.2, 0.1), Occupancy::Occupied, ahead), 1.0);
        let behind = speed((-1.2, 0.1), Occupancy::Occupied, back);
        assert!(behind > -0.6 && behind < 0.0, "{behind}");
    }

    #[test]
    fn what_is_beside_the_hitch_holds_it_in_no_direction() {
        for (x, y) in [(-0.25, 0.24), (-0.15, 0.24), (0.3, 0.27), (-0.85, 0.27), (-0.25, 0.19), (-0.2, 0.19)] {
            for speed_of in [1.0, -1.0] {
                let twist = Twist::new(speed_of, 0.0, 0.0);
                assert_eq!(speed((x, y), Occupancy::Occupied, twist), speed_of, "at {x}, {y}");
            }
        }
    }

    /// Place and speed of a vehicle that has driven towards something on the map for 24 s.
    fn drive_until_it_stops(mut node: SweepStop, map: &Grid<Occupancy>) -> (f32, f32) {
        let (mut x, mut speed) = (0.0, 0.0);
        for step in 0..300 {
            let (base, ctx) = (Pose2::new(x, 0.0, 0.0), Ctx::new(Time::from_millis(80 * step)));
            let trailer = Articulated::PATSY.trailer(&base, 0.0);
            let twist = Twist::new(0.8, 0.0, 0.0);
            let limited = node.process(&ctx, Some(&twist), Some(map), Some(&base), Some(&trailer));
            speed = limited.expect("a command").x;
            x += 0.08 * speed;
        }
        (x, speed)
    }

    #[test]
    fn it_keeps_more_distance_from_what_is_ahead() {
        let map = floor(Point2::new(1.0, 0.0), Occupancy::Occupied);
        let stop = |ahead| {
            let clearance = Clearance { ahead, ..CLEARANCE };
            drive_until_it_stops(SweepStop { clearance, ..node() }, &map).0
        };
        let [near, far] = [stop(0.05), stop(0.25)];
        assert!((0.6..=0.75).contains(&near) && (near - far - 0.2).abs() < 0.06, "{near} m, {far} m");
    }

    /// The camera sees neither floor nor a bottom there, and no longer the nearest part of it.
    #[test]
    fn it_stops_before_a_pit_that_was_not_seen() {
        for side in [-0.3, 0.12, 0.22] {
            let mut map = floor(Point2::default(), Occupancy::Free);
            let cells: Vec<Cell> = map.iter().map(|(cell, _)| cell).collect();
            for cell in cells {
                let place = map.raster().centre(cell);
                if place.x > 1.0 && place.y > side {
                    *map.get_mut(cell).expect("inside") = Occupancy::Unknown;
                }
            }
            let (x, speed) = drive_until_it_stops(node(), &map);
            assert!(speed == 0.0 && (0.4..0.75).contains(&x), "{speed} m/s at {x} m");
        }
    }

    #[test]
    fn unknown_floor_counts_backward_and_in_view() {
        let (ahead, back) = (Twist::new(1.0, 0.0, 0.0), Twist::new(-1.0, 0.0, 0.0));
        assert!(speed((0.7, 0.1), Occupancy::Unknown, ahead) < 0.9);
        assert_eq!(speed((0.3, 0.2), Occupancy::Unknown, ahead), 1.0);
        assert!(speed((-1.2, 0.1), Occupancy::Unknown, back) > -0.6);
    }

    #[test]
    fn the_trailer_cuts_the_corner() {
        // Beside the tractor, where only the trailer gets in a curve to the left.
        let place = (0.3, 0.31);
        assert_eq!(speed(place, Occupancy::Occupied, Twist::new(1.0, 0.0, 0.0)), 1.0);
        assert!(speed(place, Occupancy::Occupied, Twist::new(1.0, 0.0, 1.4)) < 0.9);
    }

    #[test]
    fn it_stands_without_a_map() {
        let (mut node, twist) = (node(), Twist::new(0.5, 0.0, 0.1));
        let (base, trailer) = (Pose2::new(0.0, 0.0, FRAC_PI_2), Pose2::new(0.0, -0.65, FRAC_PI_2));
        let map = floor(Point2::new(2.9, 2.9), Occupancy::Occupied);
        let mut at = |ms: i64, map: Option<&Grid<Occupancy>>, base: Option<&Pose2>| {
            let ctx = Ctx::new(Time::from_millis(ms));
            node.process(&ctx, Some(&twist), map, base, Some(&trailer)).expect("a command")
        };
        assert_eq!(at(0, None, Some(&base)), Twist::ZERO);
        assert_eq!(at(50, Some(&Grid::default()), Some(&base)), Twist::ZERO);
        assert_eq!([at(100, Some(&map), Some(&base)), at(600, None, Some(&base))], [twist; 2]);
        let odd = [Pose2::new(f32::NAN, 0.0, 0.0), Pose2::new(0.0, 5e6, 0.0)];
        assert_eq!([at(650, None, Some(&odd[0])), at(650, None, Some(&odd[1])), at(650, None, None)], [Twist::ZERO; 3]);
        assert_eq!([at(699, None, Some(&base)), at(700, None, Some(&base))], [twist, Twist::ZERO]);
    }
}
