use super::{Point2, Pose2, Scan};
use apex_rt::{Ctx, Out, Time, node};
use heapless::Vec;

/// Maximum number of remembered points.
const MOST: usize = 128;
/// Distance between remembered points, in m.
const APART: f32 = 0.02;

/// Marks the beams of a scan that end in a load as not measured (NaN), but not those that end in what comes near it,
/// such as the castors of another container.
///
/// `place` is the pose of the middle of the load in the frame of the scan, ⊥ without a load. What is in a box of
/// `length` and `width` belongs to the load. What is beside it, up to `around`, does so if it was there within `learn`
/// after the load came: while it is lifted, the robot stands. A load may lie a little off its place, and its castors
/// stand out.
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
    /// Time at which the load came.
    since: Option<Time>,
    /// Points that stand out, in the frame of the load.
    parts: Vec<Point2, MOST>,
}

#[node]
impl HideCarried {
    fn process(&mut self, ctx: &Ctx, scan: &Scan, place: Option<&Pose2>, rest: &mut Out<Scan>) {
        let rest = rest.get_mut();
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
        for (beam, point) in scan.points().filter(|(_, point)| place.is_in_box(*point, length, width)) {
            let part = place.to_inner(point);
            if learns && !self.is_part(part, APART) {
                // Does not matter if it is full: then there are parts everywhere.
                let _ = self.parts.push(part);
            }
            if place.is_in_box(point, self.length, self.width) || self.is_part(part, self.reach) {
                rest.ranges[beam] = f32::NAN;
            }
        }
    }

    fn is_part(&self, point: Point2, reach: f32) -> bool {
        self.parts.iter().any(|part| (*part - point).norm_squared() <= reach * reach)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use apex_rt::Construct;
    use core::f32::consts::{PI, TAU};

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
        let mut node = HideCarried::construct((1.2, 0.7, 0.15, 0.06, 2.0));
        firings.map(|(ms, is_loaded, points)| {
            let (ctx, mut rest) = (Ctx::new(Time::from_millis(ms)), Out::new());
            let place = Pose2::new(-0.3, 0.0, 0.0);
            node.process(&ctx, &scan(points), is_loaded.then_some(&place), &mut rest);
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
}
