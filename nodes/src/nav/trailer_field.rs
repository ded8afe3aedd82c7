use super::{
    Articulated, Twist,
    latest::{Latest, both_fresh},
    near::{Near, Zone, seen},
    outline::{Axes, Outline},
    twist::Command,
};
use crate::scan::{BeamDirections, Pose2, Scan};
use apex_rt::{Ctx, node};

/// Distance between predicted places, in m.
const STEP: f32 = 0.02;
/// Length of the curve that is predicted, in m.
const LOOK_AHEAD: f32 = 0.8;

/// Slows a tractor with a trailer down before obstacles on its curve, and stops it before it touches one: a
/// [`SafetyField`](super::SafetyField) of the shape of the vehicle with its load, whose corners swing out in curves.
///
/// `ahead` and `behind` are scans in the frames of the tractor and of the trailer, without the load. They may be ⊥, as
/// scans come less often than twists, but the vehicle stops if one of the two is older than `max_age`, by its stamp; a
/// scan that measures nothing is none. `base` and `trailer` are the poses of the two axes in one fixed frame such as
/// that of odometry. The vehicle stops at once without them, and if the last twist is older than `max_age`.
#[node]
#[derive(Debug, Clone)]
pub struct TrailerField {
    /// Shape of the vehicle.
    #[param(default = Articulated::PATSY)]
    vehicle: Articulated,
    /// Length of the load, whose middle is above that of the straight vehicle.
    #[param(unit = "m", default = 0.0, range = 0.0..=10.0)]
    load_length: f32,
    /// Width of the load; 0 for none.
    #[param(unit = "m", default = 0.0, range = 0.0..=10.0)]
    load_width: f32,
    /// Minimum distance from obstacles at a stop.
    #[param(unit = "m", default = 0.05, range = 0.0..=10.0)]
    margin: f32,
    /// Deceleration of the vehicle.
    #[param(unit = "m/s^2", default = 1.0, range = 0.01..=100.0)]
    deceleration: f32,
    /// Delay before the vehicle begins to brake.
    #[param(unit = "s", default = 0.1, range = 0.0..=10.0)]
    latency: f32,
    /// Maximum age of a scan and of a twist.
    #[param(unit = "s", default = 0.5, range = 0.01..=60.0, silence)]
    max_age: f32,
    last: [Latest<Scan>; 2],
    command: Command,
    /// Points near the vehicle.
    near: Near,
    directions: [BeamDirections; 2],
}

#[node]
impl TrailerField {
    fn process(
        &mut self,
        ctx: &Ctx,
        twist: Option<&Twist>,
        ahead: Option<&Scan>,
        behind: Option<&Scan>,
        base: Option<&Pose2>,
        trailer: Option<&Pose2>,
    ) -> Option<Twist> {
        for (last, scan) in self.last.iter_mut().zip([ahead, behind]) {
            last.update(ctx, scan, self.max_age);
        }
        let twist = self.command.update(ctx, twist, self.max_age);
        let axes = both_fresh(ctx, [base, trailer], self.max_age);
        let limited = match axes.map(|(base, trailer)| [*base, *trailer]) {
            Some(now) if twist != Twist::ZERO && self.find_near(ctx, &now) => {
                twist.stoppable(self.gap(&twist, &now), self.deceleration, self.latency)
            }
            _ => Twist::ZERO,
        };
        self.command.send(limited)
    }

    /// Finds the points near the vehicle. Returns `false` without young scans.
    fn find_near(&mut self, ctx: &Ctx, now: &Axes) -> bool {
        let (zone, [ahead, behind]) = (self.zone(), [0, 1].map(|i| self.last[i].young(ctx, self.max_age)));
        let Some((ahead, behind)) = ahead.zip(behind) else { return false };
        let [first, second] = &mut self.directions;
        let places = seen(ahead, first, &now[0], self.margin).chain(seen(behind, second, &now[1], self.margin));
        self.near.find(&zone, now, LOOK_AHEAD, places);
        true
    }

    /// Distance that the vehicle can drive before an obstacle is within its margin, in m.
    fn gap(&self, twist: &Twist, now: &Axes) -> f32 {
        if twist.x == 0.0 {
            return f32::INFINITY;
        }
        self.near.gap(&self.zone(), self.vehicle.places(now, twist, STEP), STEP, LOOK_AHEAD)
    }

    fn zone(&self) -> Zone {
        Zone::new(Outline::new(self.vehicle, [self.load_length, self.load_width]), 0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scan::Point2;
    use apex_rt::{Construct, Time};
    use core::f32::consts::{PI, TAU};

    const LOAD: [f32; 2] = [1.2, 0.7];

    fn node([length, width]: [f32; 2]) -> TrailerField {
        TrailerField::construct((Articulated::PATSY, length, width, 0.02, 0.8, 0.1, 0.5))
    }

    /// Scan of points in the frame of its scanner, each hit by one beam.
    fn scan(points: &[Point2]) -> Scan {
        let mut scan = Scan { angle_min: -PI, angle_increment: TAU / 1080.0, range_max: 20.0, ..Scan::default() };
        scan.ranges.extend([f32::INFINITY; 1080]);
        for point in points {
            let beam = libm::roundf((point.angle() + PI) / scan.angle_increment) as usize % 1080;
            scan.ranges[beam] = point.norm();
        }
        scan
    }

    /// Speed that is left of a twist with points in the frame of the tractor, of a straight vehicle.
    fn speed(load: [f32; 2], twist: Twist, points: &[(f32, f32)]) -> f32 {
        let base = Pose2::new(1.0, 2.0, 0.5);
        let trailer = Articulated::PATSY.trailer(&base, 0.5);
        let points: Vec<Point2> = points.iter().map(|(x, y)| Point2::new(*x, *y)).collect();
        let (front, rear): (Vec<Point2>, Vec<Point2>) = points.iter().partition(|point| point.x > -0.6);
        let rear: Vec<Point2> = rear.iter().map(|p| trailer.to_inner(base.to_outer(*p))).collect();
        let ctx = Ctx::new(Time::ZERO);
        let [front, rear] = [scan(&front), scan(&rear)];
        let limited = node(load).process(&ctx, Some(&twist), Some(&front), Some(&rear), Some(&base), Some(&trailer));
        let limited = limited.expect("a command");
        assert!((limited.omega * twist.x - twist.omega * limited.x).abs() < 1e-5, "the same curve");
        limited.x
    }

    #[test]
    fn it_stops_before_what_its_outline_meets() {
        let (ahead, back) = (Twist::new(0.5, 0.0, 0.0), Twist::new(-0.5, 0.0, 0.0));
        assert_eq!(speed([0.0; 2], ahead, &[(0.26, 0.1)]), 0.0);
        assert_eq!(speed([0.0; 2], ahead, &[(0.26, 0.25), (1.5, 0.0), (-1.0, 0.1)]), 0.5);
        let near = speed([0.0; 2], ahead, &[(0.33, -0.19)]);
        assert!((0.1..0.4).contains(&near), "{near}");
        assert_eq!(speed(LOAD, ahead, &[(0.33, -0.33)]), 0.0);
        assert_eq!(speed(LOAD, back, &[(0.33, -0.33)]), -0.5);
        let [empty, loaded] = [[0.0; 2], LOAD].map(|load| speed(load, back, &[(-0.95, 0.1)]));
        assert!(empty < loaded - 0.1 && loaded < 0.0, "{empty} {loaded}");
    }

    #[test]
    fn the_corner_of_the_load_swings_out() {
        let (straight, bend) = (Twist::new(0.4, 0.0, 0.0), Twist::new(0.4, 0.0, 0.5));
        let beside = [(0.43, -0.375)];
        assert_eq!([speed(LOAD, straight, &beside), speed([0.0; 2], bend, &beside)], [0.4, 0.4]);
        assert!(speed(LOAD, bend, &beside) < 0.35);
    }

    #[test]
    fn what_touches_it_at_its_side_holds_it_in_no_direction() {
        for x in [0.2, -0.3, -0.8] {
            for twist in [0.5, -0.5].map(|x| Twist::new(x, 0.0, 0.0)) {
                assert_eq!(speed(LOAD, twist, &[(x, 0.36), (x, -0.36)]), twist.x, "at {x}");
            }
        }
    }

    #[test]
    fn it_stands_without_both_scans() {
        let (mut node, twist, at) = (node(LOAD), Twist::new(0.5, 0.0, 0.1), Pose2::default());
        let trailer = Articulated::PATSY.trailer(&at, 0.0);
        let mut fire = |ms: i64, ahead: bool, behind: bool, base: Option<&Pose2>| {
            let seen = Scan { stamp: Time::from_millis(ms), ..scan(&[]) };
            let (ahead, behind) = (ahead.then_some(&seen), behind.then_some(&seen));
            let ctx = Ctx::new(Time::from_millis(ms));
            node.process(&ctx, Some(&twist), ahead, behind, base, Some(&trailer)).expect("a command")
        };
        let here = Some(&at);
        assert_eq!([fire(0, false, false, here), fire(50, true, false, here)], [Twist::ZERO; 2]);
        assert_eq!([fire(100, false, true, here), fire(500, false, false, here)], [twist; 2]);
        assert_eq!([fire(520, true, true, None), fire(550, false, false, here)], [Twist::ZERO, twist]);
        assert_eq!([fire(600, true, false, here), fire(1050, true, false, here)], [twist, Twist::ZERO]);
    }
}
