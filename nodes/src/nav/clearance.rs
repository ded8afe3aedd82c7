use super::{
    Articulated,
    near::Zone,
    outline::{Axes, Outline},
};
use crate::{
    map::{Grid, Occupancy},
    scan::Point2,
};
use apex_rt::Units;

/// Distance up to which obstacles count, in m: enough for a stop. Those that the camera shows farther away are often
/// none.
const REACH: f32 = 1.25;
/// Distance up to which floor ahead that is not known counts, in m: farther away it may not be seen yet.
const SEEN: f32 = 1.0;

/// Distance from hazards that planners keep in addition, in m: a follower is not exactly on its path.
pub(super) const SLACK: f32 = 0.04;

/// Distances that a tractor with a trailer keeps from hazards on the floor, and what of the floor its camera sees.
/// Planner, follower and `SweepStop` judge the floor by it. Distances are those from the middles of cells.
#[derive(Debug, Clone, Copy, PartialEq, Units)]
pub struct Clearance {
    /// Distance of the outline from obstacles and missing floor.
    #[unit("m")]
    pub side: f32,
    /// Distance of the front from them when the vehicle drives forward. Of a long thing only the thicker end may be on
    /// the map.
    #[unit("m")]
    pub ahead: f32,
    /// Distance of the outline from floor that was not seen when the vehicle drives backward.
    #[unit("m")]
    pub unknown: f32,
    /// Distance ahead from which on the camera sees the floor.
    #[unit("m")]
    pub near: f32,
    /// Angle of the camera's view across, about the x axis of the tractor.
    #[unit("rad")]
    pub view_angle: f32,
}

impl Clearance {
    /// Distances of PATSY. It stops before floor ahead that is not known while the camera still sees it.
    pub const PATSY: Self = Self { side: 0.09, ahead: 0.21, unknown: 0.03, near: 0.4, view_angle: 1.0 };

    /// Clearance of a planner: greater by a distance in m that a follower may be beside its path. Floor that was not
    /// seen is a hazard like others.
    #[must_use]
    pub(super) fn widened(self, by: f32) -> Self {
        Self { side: self.side + by, ahead: self.ahead + by, unknown: self.side + by, ..self }
    }

    /// Zone about a vehicle that has to be free of hazards. The load is above small things.
    pub(super) fn zone(&self, vehicle: Articulated, is_backward: bool) -> Zone {
        Zone::new(Outline::new(vehicle, [0.0; 2]), if is_backward { 0.0 } else { self.ahead - self.side })
    }

    /// Obstacles and missing floor near the tractor, and floor that was not seen and should have been, with the
    /// distances to be kept from them in m. Ahead, floor that is not known only counts where the camera sees it, and
    /// behind everywhere. What is beneath the vehicle already does not count.
    pub(super) fn hazards<'a>(
        &'a self,
        map: &'a Grid<Occupancy>,
        vehicle: Articulated,
        now: &'a Axes,
        is_backward: bool,
    ) -> impl Iterator<Item = (Point2, f32)> + 'a {
        let raster = map.raster();
        let stance = Outline::new(vehicle, [0.0; 2]).at(now);
        let beneath = 0.5 * raster.resolution;
        map.iter().filter(|(_, cell)| **cell != Occupancy::Free).filter_map(move |(cell, occupancy)| {
            let place = raster.centre(cell);
            let margin = match occupancy {
                Occupancy::Occupied | Occupancy::Low if (place - now[0].position()).norm_squared() <= REACH * REACH => {
                    self.side
                }
                Occupancy::Unknown if is_backward => self.unknown,
                Occupancy::Unknown if self.is_in_view(now[0].to_inner(place)) => self.side,
                _ => return None,
            };
            (stance.distance(place) > beneath).then_some((place, margin))
        })
    }

    /// Returns `true` if the camera sees a place in the frame of the tractor, and sees it well.
    fn is_in_view(&self, place: Point2) -> bool {
        (self.near..SEEN).contains(&place.x) && place.angle().abs() <= 0.5 * self.view_angle
    }
}
