use super::{BeamDirections, Point2, Pose2, Scan};
use crate::math::normalize_angle;
use apex_rt::{Ctx, Out, Time, node};
use core::f32::consts::TAU;
use heapless::Vec;

/// Maximum number of remembered points.
const MOST: usize = 128;
/// Distance between remembered points, in m.
const APART: f32 = 0.02;
/// Distance from the area in which parts of the load stand out up to which other things are remembered, in m, and
/// distance between their points.
const RING: f32 = 0.25;
const OTHERS_APART: f32 = 0.04;
/// Additional range from which on a beam passes a remembered point, in m.
const BEYOND: f32 = 0.1;

/// Marks the beams of a scan that end in a load as not measured (NaN), but not those that end in what comes near it,
/// such as the castors of another container.
///
/// `place` is the pose of the middle of the load in the frame of the scan, ⊥ without a load. What is in a box of
/// `length` and `width` belongs to the load. What is beside it, up to `around`, does so if it was there within `learn`
/// after the load came: while it is lifted, the robot stands. A load may lie a little off its place, and its castors
/// stand out.
///
/// `rest` is the scan without the load. What comes so near that it is taken for a castor, or is hidden behind one, is
/// still there: `near` is that scan with what was seen beside the load before, for `memory` or until a beam passes it.
/// Its beams are those that end in the load. For that `pose` is the pose of the scanner in a fixed frame such as that
/// of odometry; without it nothing is remembered.
#[node]
#[derive(Debug, Clone)]
pub struct HideCarried {
    /// Size of the load along its heading.
    #[param(unit = "m", range = 0.0..=100.0)]
    length: f32,
    /// Size of the load across.
    #[param(unit = "m", range = 0.0..=100.0)]
    width: f32,
    /// Distance up to which parts of the load stand out.
    #[param(unit = "m", default = 0.15, range = 0.0..=10.0)]
    around: f32,
    /// Distance from such a part up to which beams end in it: that of the sides of a castor which are not seen yet.
    #[param(unit = "m", default = 0.14, range = 0.0..=10.0)]
    reach: f32,
    /// Time in which these parts are looked at.
    #[param(unit = "s", default = 2.0, range = 0.0..=60.0)]
    learn: f32,
    /// Time for which what is hidden beside the load is remembered.
    #[param(unit = "s", default = 10.0, range = 0.0..=600.0)]
    memory: f32,
    /// Time at which the load came.
    since: Option<Time>,
    /// Points that stand out, in the frame of the load.
    parts: Vec<Point2, MOST>,
    /// Points beside the load, in the fixed frame, and when they were seen.
    others: Vec<(Point2, Time), MOST>,
    directions: BeamDirections,
}

#[node]
impl HideCarried {
    fn process(
        &mut self,
        ctx: &Ctx,
        scan: &Scan,
        place: Option<&Pose2>,
        pose: Option<&Pose2>,
        rest: &mut Out<Scan>,
        near: &mut Out<Scan>,
    ) {
        let (rest, near) = (rest.get_mut(), near.get_mut());
        self.hide(ctx, scan, place, rest);
        near.clone_from(rest);
        match place.zip(pose.filter(|pose| pose.is_usable())) {
            Some((place, pose)) => self.remember(ctx.now(), place, pose, near),
            None => self.others.clear(),
        }
    }

    fn hide(&mut self, ctx: &Ctx, scan: &Scan, place: Option<&Pose2>, rest: &mut Scan) {
        rest.clone_from(scan);
        let Some(place) = place else {
            self.since = None;
            return;
        };
        if self.since.is_none_or(|since| since > ctx.now()) {
            self.since = Some(ctx.now());
            self.parts.clear();
        }
        let learns = self.since.is_some_and(|since| ctx.now().since(since).as_secs_f32() <= self.learn);
        let [length, width] = [self.length, self.width].map(|size| size + 2.0 * self.around);
        let mut directions = core::mem::take(&mut self.directions);
        for (beam, point) in directions.points(scan).filter(|(_, point)| place.is_in_box(*point, length, width)) {
            let part = place.to_inner(point);
            if learns && !self.is_part(part, APART) {
                // Does not matter if it is full: then there are parts everywhere.
                let _ = self.parts.push(part);
            }
            if place.is_in_box(point, self.length, self.width) || self.is_part(part, self.reach) {
                rest.ranges[beam] = f32::NAN;
            }
        }
        self.directions = directions;
    }

    /// Remembers what a scan without the load shows beside it, and adds what it hides there.
    fn remember(&mut self, now: Time, place: &Pose2, pose: &Pose2, near: &mut Scan) {
        let [length, width] = [self.length, self.width].map(|size| size + 2.0 * (self.around + RING));
        let (memory, frame) = (self.memory, pose.transform());
        self.others.retain(|(point, seen)| {
            let here = frame.to_inner(*point);
            // The beams beside that of a point may end at the same thing.
            let passes = |range: &f32| *range > here.norm() + BEYOND;
            let about = beam(near, here).map(|beam| beam.saturating_sub(1)..(beam + 2).min(near.ranges.len()));
            now.since(*seen).as_secs_f32() < memory
                && place.is_in_box(here, length, width)
                && !about.is_some_and(|about| near.ranges[about].iter().all(passes))
        });
        for (_, point) in self.directions.points(near).filter(|(_, point)| place.is_in_box(*point, length, width)) {
            let point = frame.to_outer(point);
            let is_same =
                |(other, _): &&mut (Point2, Time)| (*other - point).norm_squared() <= OTHERS_APART * OTHERS_APART;
            match self.others.iter_mut().find(is_same) {
                Some(other) => other.1 = now,
                // Does not matter if it is full: there is something everywhere.
                None => drop(self.others.push((point, now))),
            }
        }
        for (point, _) in &self.others {
            let here = pose.to_inner(*point);
            let hidden = beam(near, here).and_then(|beam| near.ranges.get_mut(beam)).filter(|range| range.is_nan());
            if let Some(range) = hidden {
                *range = here.norm();
            }
        }
    }

    fn is_part(&self, point: Point2, reach: f32) -> bool {
        self.parts.iter().any(|part| (*part - point).norm_squared() <= reach * reach)
    }
}

/// Beam of a scan in whose direction a point lies.
fn beam(scan: &Scan, point: Point2) -> Option<usize> {
    let turn = normalize_angle(&(point.angle() - scan.angle_min));
    let turn = if turn < -0.5 * scan.angle_increment { turn + TAU } else { turn };
    let beam = libm::roundf(turn / scan.angle_increment);
    (beam >= 0.0 && beam < scan.ranges.len() as f32).then_some(beam as usize)
}

#[cfg(test)]
mod tests {
    use super::*;
    use apex_rt::Construct;
    use core::f32::consts::PI;

    fn scan(points: &[(f32, f32)]) -> Scan {
        let mut scan = Scan { angle_min: -PI, angle_increment: TAU / 720.0, range_max: 20.0, ..Scan::default() };
        scan.ranges.extend([f32::INFINITY; 720]);
        for (x, y) in points {
            let point = Point2::new(*x, *y);
            let beam = libm::roundf((point.angle() + PI) / scan.angle_increment) as usize % 720;
            scan.ranges[beam] = point.norm();
        }
        scan
    }

    /// Time in ms, whether there is a load, and the points of a scan.
    type Firing<'a> = (i64, bool, &'a [(f32, f32)]);

    /// Number of points that are left at each time.
    fn left<const N: usize>(firings: [Firing<'_>; N]) -> [usize; N] {
        let mut node = HideCarried::construct((1.2, 0.7, 0.15, 0.06, 2.0, 10.0));
        firings.map(|(ms, is_loaded, points)| {
            let (ctx, mut rest) = (Ctx::new(Time::from_millis(ms)), Out::new());
            let place = Pose2::new(-0.3, 0.0, 0.0);
            let none = &mut Out::new();
            node.process(&ctx, &scan(points), is_loaded.then_some(&place), None, &mut rest, none);
            rest.get().expect("a scan").points().count()
        })
    }

    #[test]
    fn what_comes_beside_the_load_is_not_hidden() {
        let (own, other) = ((0.24, 0.4), (-0.3, 0.42));
        let counts = left([(0, true, &[own]), (1000, true, &[own]), (5000, true, &[own]), (6000, true, &[own, other])]);
        assert_eq!(counts, [0, 0, 0, 1]);
    }

    #[test]
    fn what_is_under_the_load_is_hidden_and_the_next_load_is_another() {
        let (under, own) = ((-0.7, 0.3), (0.24, 0.4));
        assert_eq!(left([(0, true, &[]), (5000, true, &[under, own]), (6000, false, &[under])]), [0, 1, 1]);
        assert_eq!(left([(0, true, &[own]), (3000, false, &[]), (4000, true, &[]), (9000, true, &[own])])[3], 1);
    }

    /// A thing beside the way comes so near to a castor that it is taken for it.
    #[test]
    fn what_was_seen_beside_the_load_is_still_there_when_it_is_taken_for_a_castor() {
        let mut node = HideCarried::construct((1.2, 0.7, 0.15, 0.14, 2.0, 10.0));
        let (place, own, thing) = (Pose2::new(-0.3, 0.0, 0.0), (0.26, 0.33), Point2::new(1.0, 0.4));
        let mut see = |ms: i64, x: f32, is_there: bool| {
            let (pose, ctx) = (Pose2::new(x, 0.0, 0.0), Ctx::new(Time::from_millis(ms)));
            // Three beams wide.
            let here = |across: f32| pose.to_inner(thing + Point2::new(0.0, across));
            let [a, b, c] = [-0.01, 0.0, 0.01].map(|across| (here(across).x, here(across).y));
            let points = [own, a, b, c];
            let scan = scan(&points[..if is_there { 4 } else { 1 }]);
            let (mut rest, mut near) = (Out::new(), Out::new());
            node.process(&ctx, &scan, Some(&place), Some(&pose), &mut rest, &mut near);
            let is_seen = |out: &Out<Scan>| out.get().expect("a scan").points().count() > 0;
            [is_seen(&rest), is_seen(&near)]
        };
        assert_eq!(see(0, -1.0, true), [true, true]);
        assert_eq!(see(3000, 0.5, true), [true, true]);
        // Within the reach of the castor, or behind it.
        assert_eq!(see(3100, 0.66, true), [false, true]);
        assert_eq!(see(3200, 0.68, true), [false, true]);
        // A beam passes where it was.
        assert_eq!(see(3300, 0.45, false), [false, false]);
        assert_eq!(see(3400, 0.68, false), [false, false]);
    }
}
