use super::{
    Twist,
    latest::Latest,
    twist::{Command, braking_speed},
};
use crate::scan::{BeamDirections, Point2, Scan};
use apex_rt::{Ctx, node};
use libm::{fmaxf, sqrtf};

/// Strip before a round robot that has to be free: as wide as the robot, and as long as its stopping distance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ProtectiveField {
    /// Radius of the robot, in m.
    pub radius: f32,
    /// Minimum distance from obstacles at a stop, in m.
    pub margin: f32,
    /// Deceleration of the robot, in m/s².
    pub deceleration: f32,
    /// Delay before the robot begins to brake, in s.
    pub latency: f32,
}

impl ProtectiveField {
    /// Distance that the robot can move in a direction before an obstacle is within its margin, in m: infinite without
    /// such an obstacle, 0 with one that is within the margin already. Points beside or behind the robot do not count.
    /// The direction and the points are in the frame of the robot.
    pub fn gap(&self, direction: Point2, points: impl Iterator<Item = Point2>) -> f32 {
        let reach = self.radius + self.margin;
        let unit = direction.scaled(1.0 / direction.norm());
        let gaps = points.filter_map(|point| {
            let (ahead, aside) = (unit.dot(point), unit.perpendicular().dot(point));
            let chord = reach * reach - aside * aside;
            let is_met = ahead > 0.0 && chord > 0.0;
            is_met.then(|| fmaxf(ahead - sqrtf(chord), 0.0))
        });
        gaps.fold(f32::INFINITY, f32::min)
    }

    /// Maximum speed from which the robot still stops within `gap` m, in m/s.
    pub fn highest_speed(&self, gap: f32) -> f32 {
        braking_speed(gap, self.deceleration, self.latency)
    }

    /// The twist, slowed down as far as the obstacles require. Rotation is not limited.
    pub fn limit(&self, twist: &Twist, points: impl Iterator<Item = Point2>) -> Twist {
        let velocity = twist.velocity();
        let speed = velocity.norm();
        if speed == 0.0 {
            return *twist;
        }
        let highest = self.highest_speed(self.gap(velocity, points));
        // NaN if a parameter is NaN: the robot then stands still.
        let factor = if highest >= speed { 1.0 } else { fmaxf(highest / speed, 0.0) };
        Twist::of(velocity.scaled(factor), twist.omega)
    }
}

/// Slows a robot down before obstacles in its driving direction, and stops it before it touches one (thesis 4.3.6).
///
/// `scan` is in the frame of the robot. It may be ⊥, as scans come less often than twists. The robot stops if no scan
/// is younger than `max_age`, by its stamp, so that a failed scanner is not taken for free space; a scan that measures
/// nothing is none. It stops, too, if the last twist is that old.
#[node]
#[derive(Debug, Clone)]
pub struct SafetyField {
    /// Radius of the robot.
    #[param(unit = "m", default = 0.3, range = 0.0..=10.0)]
    radius: f32,
    /// Minimum distance from obstacles at a stop.
    #[param(unit = "m", default = 0.05, range = 0.0..=10.0)]
    margin: f32,
    /// Deceleration of the robot.
    #[param(unit = "m/s^2", default = 1.0, range = 0.01..=100.0)]
    deceleration: f32,
    /// Delay before the robot begins to brake.
    #[param(unit = "s", default = 0.1, range = 0.0..=10.0)]
    latency: f32,
    /// Maximum age of a scan and of a twist.
    #[param(unit = "s", default = 0.5, range = 0.01..=60.0, silence)]
    max_age: f32,
    last: Latest<Scan>,
    command: Command,
    directions: BeamDirections,
}

#[node]
impl SafetyField {
    fn process(&mut self, ctx: &Ctx, twist: Option<&Twist>, scan: Option<&Scan>) -> Option<Twist> {
        let Self { radius, margin, deceleration, latency, max_age, .. } = *self;
        let field = ProtectiveField { radius, margin, deceleration, latency };
        self.last.update(ctx, scan, max_age);
        let twist = self.command.update(ctx, twist, max_age);
        self.command.send(match self.last.young(ctx, max_age) {
            Some(scan) => field.limit(&twist, self.directions.points(scan).map(|(_, point)| point)),
            None => Twist::ZERO,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use apex_rt::{Construct, Time};
    use core::f32::consts::{PI, TAU};

    const FIELD: ProtectiveField = ProtectiveField { radius: 0.3, margin: 0.1, deceleration: 1.0, latency: 0.0 };

    fn gap(direction: (f32, f32), point: (f32, f32)) -> f32 {
        let at = |(x, y)| Point2::new(x, y);
        FIELD.gap(at(direction), [at(point)].into_iter())
    }

    #[test]
    fn only_what_is_ahead_counts() {
        assert!((gap((2.0, 0.0), (1.4, 0.0)) - 1.0).abs() < 1e-6);
        assert!((gap((0.0, -0.1), (0.0, -1.4)) - 1.0).abs() < 1e-6);
        assert_eq!(gap((1.0, 0.0), (0.2, 0.1)), 0.0);
        for elsewhere in [(1.0, 0.41), (-0.5, 0.0), (f32::NAN, 0.0)] {
            assert_eq!(gap((1.0, 0.0), elsewhere), f32::INFINITY);
        }
    }

    #[test]
    fn it_stops_within_the_gap() {
        for latency in [0.0, 0.2] {
            let field = ProtectiveField { latency, ..FIELD };
            for distance in [0.01, 0.5, 3.0] {
                let v = field.highest_speed(distance);
                assert!((v * v / 2.0 + v * latency - distance).abs() < 1e-5);
            }
            assert_eq!((field.highest_speed(0.0), field.highest_speed(f32::INFINITY)), (0.0, f32::INFINITY));
        }
    }

    #[test]
    fn a_robot_stops_before_a_wall_and_gets_away_again() {
        let ctx = |step: i64| Ctx::new(Time::from_millis(20 * step));
        let scan = |x: f32, step: i64| {
            let stamp = Time::from_millis(20 * step);
            let mut scan =
                Scan { angle_min: -PI, angle_increment: TAU / 360.0, range_max: 10.0, stamp, ..Scan::default() };
            scan.ranges.extend((0..360).map(|i| (3.0 - x) / libm::cosf(-PI + i as f32 * TAU / 360.0)));
            scan
        };
        let mut node = SafetyField::construct((0.3, 0.1, 1.0, 0.1, 0.5));
        let (mut x, mut last) = (0.0, 1.0);
        for step in 0..1000 {
            let command = Twist::new(1.0, 0.0, 0.2);
            let twist = node.process(&ctx(step), Some(&command), Some(&scan(x, step))).expect("a command");
            assert!(twist.omega == 0.2 && twist.x <= last + 1e-6 && last - twist.x < 0.05, "{twist:?} at {x}");
            last = twist.x;
            x += 0.02 * twist.x;
        }
        assert!((2.55..=2.6).contains(&x), "{x}");
        let away = Twist::new(-1.0, 0.0, 0.0);
        assert_eq!(node.process(&ctx(1000), Some(&away), Some(&scan(x, 1000))), Some(away));
    }

    #[test]
    fn without_a_scan_it_stands_still() {
        let mut node = SafetyField::construct((0.3, 0.1, 1.0, 0.1, 0.5));
        let twist = Twist::new(1.0, 0.0, 0.0);
        // Scan with one beam, of a scanner that works, is covered, or sends nothing.
        let scan = |ms: i64, ranges: &[f32]| {
            let mut scan = Scan { stamp: Time::from_millis(ms), ..Scan::default() };
            scan.ranges.extend(ranges.iter().copied());
            Some(scan)
        };
        let mut fire = |ms: i64, twist: Twist, scan: Option<Scan>| {
            node.process(&Ctx::new(Time::from_millis(ms)), Some(&twist), scan.as_ref()).expect("a command")
        };
        assert_eq!(fire(0, twist, None), Twist::ZERO);
        assert_eq!(fire(50, twist, scan(50, &[])), Twist::ZERO);
        assert_eq!(fire(50, twist, scan(50, &[f32::NAN])), Twist::ZERO);
        assert_eq!(fire(100, twist, scan(100, &[f32::INFINITY])), twist);
        assert_eq!([fire(599, twist, None), fire(600, twist, None)], [twist, Twist::ZERO]);
        assert_eq!([fire(650, twist, scan(100, &[9.0])), fire(700, twist, scan(650, &[9.0]))], [Twist::ZERO, twist]);
        assert_eq!(fire(700, Twist { y: f32::NAN, ..twist }, scan(700, &[9.0])), Twist::ZERO);
    }
}
