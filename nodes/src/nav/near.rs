use super::outline::{Axes, Outline};
use crate::scan::{BeamDirections, Point2, Pose2, Scan};
use std::vec::Vec;

/// Greatest distance that a corner of the vehicle moves on a metre of a curve, in m.
const SWING: f32 = 2.0;
/// Distance by which a place that is within its margin already may come nearer, in m: what is beside the vehicle would
/// else hold it in both directions.
pub(super) const GRAZE: f32 = 0.01;

/// Points of a scan whose scanner is at `axis`, with the distance to be kept from them in m.
pub(super) fn seen<'a>(
    scan: &'a Scan,
    directions: &'a mut BeamDirections,
    axis: &Pose2,
    margin: f32,
) -> impl Iterator<Item = (Point2, f32)> + use<'a> {
    let axis = axis.transform();
    directions.points(scan).map(move |(_, point)| (axis.to_outer(point), margin))
}

/// Zone about a vehicle: its outline, and the same with a longer front.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Zone {
    outline: Outline,
    pub grown: Outline,
}

impl Zone {
    /// Zone about a vehicle that reaches `ahead` m beyond the front of its tractor.
    pub fn new(outline: Outline, ahead: f32) -> Self {
        Self { outline, grown: outline.with_front(ahead) }
    }
}

/// Place near a vehicle, and what it is to the vehicle at the start of a way.
#[derive(Debug, Clone, Copy)]
struct Place {
    at: Point2,
    /// Distance to be kept, in m.
    margin: f32,
    /// Distance beyond the margin about the zone, in m: negative within it.
    beyond: f32,
    /// Distance from the outline, in m.
    before: f32,
}

/// Places that a vehicle should not come near on a way.
#[derive(Debug, Clone, Default)]
pub(super) struct Near(Vec<Place>);

impl Near {
    /// Finds the places, given with the distances to be kept from them in m, that may be met on the next `way` m.
    pub fn find(&mut self, zone: &Zone, now: &Axes, way: f32, places: impl Iterator<Item = (Point2, f32)>) {
        let (grown, outline) = (zone.grown.at(now), zone.outline.at(now));
        self.0.clear();
        self.0.extend(places.filter_map(|(at, margin)| {
            let beyond = grown.distance(at) - margin;
            (beyond < SWING * way).then(|| Place { at, margin, beyond, before: outline.distance(at) })
        }));
    }

    /// Returns `true` if a place is within its margin about the zone of a vehicle that has driven `driven` m. One that
    /// was about there from the start must not be nearer to the outline than it was, but for `graze` m.
    pub fn is_met(&self, zone: &Zone, axes: &Axes, driven: f32, graze: f32) -> bool {
        let (grown, outline) = (zone.grown.at(axes), zone.outline.at(axes));
        self.0.iter().filter(|place| place.beyond <= SWING * driven).any(|place| {
            let is_near = grown.distance(place.at) < place.margin;
            let is_grazed = || place.beyond < graze && place.before - outline.distance(place.at) <= graze;
            is_near && !is_grazed()
        })
    }

    /// Distance that a vehicle can drive before it meets a place, in m. `places` are those of the vehicle after each
    /// `step` m; they count up to `way` m.
    pub fn gap(&self, zone: &Zone, places: impl Iterator<Item = Axes>, step: f32, way: f32) -> f32 {
        if self.0.is_empty() {
            return f32::INFINITY;
        }
        let mut met = (0..(way / step) as u16).map(|k| f32::from(k) * step).zip(places);
        let first = met.find(|(free, axes)| self.is_met(zone, axes, free + step, GRAZE));
        first.map_or(f32::INFINITY, |(free, _)| free)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::nav::Articulated;

    const VEHICLE: Articulated = Articulated::PATSY;

    fn at(x: f32) -> Axes {
        let base = Pose2::new(x, 0.0, 0.0);
        [base, VEHICLE.trailer(&base, 0.0)]
    }

    /// Returns `true` if a straight vehicle meets a place after some distance, forward or backward.
    fn meets(place: (f32, f32), driven: f32) -> bool {
        let zone = Zone::new(Outline::new(VEHICLE, [0.0; 2]), 0.1);
        let mut near = Near::default();
        near.find(&zone, &at(0.0), 2.0, core::iter::once((Point2::new(place.0, place.1), 0.08)));
        near.is_met(&zone, &at(driven), driven.abs(), GRAZE)
    }

    #[test]
    fn the_front_keeps_more_distance() {
        assert_eq!([meets((1.0, 0.0), 0.55), meets((1.0, 0.0), 0.6)], [false, true]);
        assert_eq!([meets((0.5, 0.27), 0.5), meets((0.5, 0.29), 0.5)], [true, false]);
        assert_eq!([meets((-1.3, 0.0), -0.4), meets((-1.3, 0.0), -0.45)], [false, true]);
    }

    #[test]
    fn what_is_near_from_the_start_must_not_come_nearer() {
        // Before the front, also where it would pass beneath a corner.
        for place in [(0.35, 0.0), (0.35, 0.19), (0.35, -0.19)] {
            assert_eq!([meets(place, 0.05), meets(place, -0.05), meets(place, -0.5)], [true, false, false]);
        }
        // Beside it, within the margin and just beyond it.
        assert_eq!([meets((0.1, 0.25), 0.05), meets((-0.6, 0.25), -0.05)], [false; 2]);
        assert!(!meets((0.1, 0.2801), 0.05));
    }
}
