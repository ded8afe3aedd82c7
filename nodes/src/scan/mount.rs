use super::{BeamDirections, Point2, Pose2, Scan, wrap_angle};
use apex_rt::{Out, node};
use core::{
    f32::consts::{PI, TAU},
    fmt,
};

/// Number of beams of a scan around a robot: one per half degree.
const BEAMS: usize = 720;

/// Transforms a scan into one of a virtual scanner at the origin of the robot, so that scans of several scanners can be
/// merged.
///
/// The result is in the frame of the robot and covers a full turn from −π on, with 720 beams. The range of a beam is
/// the distance to the nearest point in its direction; infinity if the scanner sees nothing within range there, and NaN
/// if it does not measure there.
#[node]
#[derive(Debug, Clone)]
pub struct MountScan {
    /// Forward position of the scanner in the frame of the robot.
    #[param(unit = "m", default = 0.0, range = -10.0..=10.0)]
    x: f32,
    /// Position of the scanner to the left.
    #[param(unit = "m", default = 0.0, range = -10.0..=10.0)]
    y: f32,
    /// Direction of the scanner's x axis, counter-clockwise from straight ahead.
    #[param(unit = "rad", default = 0.0, range = -6.3..=6.3)]
    heading: f32,
    directions: BeamDirections,
}

#[node]
impl MountScan {
    fn process(&mut self, scan: &Scan, mounted: &mut Out<Scan>) {
        let mount = Pose2::new(self.x, self.y, self.heading);
        let (direction, mount) = (|angle| wrap_angle(angle + self.heading), mount.transform());
        around(scan, &mut self.directions, |point| mount.to_outer(point), direction, mounted.get_mut());
    }
}

/// Scan around the origin of an outer frame: `to_outer` transforms points into it, and `direction` angles, to [−π, π].
pub(crate) fn around(
    scan: &Scan,
    directions: &mut BeamDirections,
    to_outer: impl Fn(Point2) -> Point2,
    direction: impl Fn(f32) -> f32,
    mounted: &mut Scan,
) {
    mounted.angle_min = -PI;
    mounted.angle_increment = TAU / BEAMS as f32;
    mounted.range_min = f32::MIN_POSITIVE;
    mounted.range_max = f32::MAX;
    mounted.stamp = scan.stamp;
    mounted.time_increment = 0.0;
    mounted.ranges.clear();
    mounted.ranges.extend([f32::NAN; BEAMS]);
    let towards = |angle: f32| libm::roundf((angle + PI) / (TAU / BEAMS as f32)) as usize % BEAMS;
    for beam in (0..scan.ranges.len()).filter(|beam| scan.sight(*beam) == f32::INFINITY) {
        // What is far away is in this direction from any place on the robot.
        mounted.ranges[towards(direction(scan.angle(beam)))] = f32::INFINITY;
    }
    for (_, point) in directions.points(scan) {
        let point = to_outer(point);
        let range = &mut mounted.ranges[towards(point.angle())];
        // `min` ignores the NaN of a beam without a point.
        *range = range.min(point.norm());
    }
}

/// Error of two scans with different beams.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct OtherBeams;

impl fmt::Display for OtherBeams {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("the scans have other beams: put each through `MountScan` first")
    }
}

impl core::error::Error for OtherBeams {}

/// Merges two scans from [`MountScan`]: the nearer range in each beam. If one input is ⊥, the result is the other
/// one. The stamp is the older one.
///
/// Fails on scans that do not have the same beams.
#[node]
#[keeps_frame]
#[derive(Debug, Clone, Default)]
pub struct MergeScans;

#[node]
impl MergeScans {
    fn process(&mut self, a: Option<&Scan>, b: Option<&Scan>, merged: &mut Out<Scan>) -> Result<(), OtherBeams> {
        let Some(first) = a.or(b) else { return Ok(()) };
        let second = b.unwrap_or(first);
        let beams = |scan: &Scan| (scan.angle_min, scan.angle_increment, scan.ranges.len());
        if beams(first) != beams(second) {
            return Err(OtherBeams);
        }
        let merged = merged.get_mut();
        merged.clone_from(first);
        merged.range_min = first.range_min.min(second.range_min);
        merged.range_max = first.range_max.max(second.range_max);
        merged.stamp = first.stamp.min(second.stamp);
        for (beam, range) in merged.ranges.iter_mut().enumerate() {
            // `min` ignores the NaN of a scanner that does not measure there.
            *range = first.sight(beam).min(second.sight(beam));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use apex_rt::{Construct, Time};

    fn mounted((x, y, heading): (f32, f32, f32), scan: &Scan) -> Scan {
        let mut out = Out::new();
        MountScan::construct((x, y, heading)).process(scan, &mut out);
        out.get().expect("a scan").clone()
    }

    /// A scan of 180° with the same range in all beams.
    fn half_turn(range: f32) -> Scan {
        let mut scan = Scan { angle_min: -0.5 * PI, angle_increment: PI / 720.0, ..Scan::default() };
        scan.ranges.extend([range; 721]);
        scan
    }

    #[test]
    fn points_stay_where_they_are() {
        let scan = half_turn(2.0);
        let seen = mounted((0.3, -0.2, 2.5), &scan);
        let mount = Pose2::new(0.3, -0.2, 2.5);
        let points: std::vec::Vec<Point2> = scan.points().map(|(_, p)| mount.to_outer(p)).collect();
        assert!(seen.points().count() > 300);
        for (_, p) in seen.points() {
            let nearest = points.iter().map(|q| (*q - p).norm()).fold(f32::MAX, f32::min);
            assert!(nearest < 0.02, "{p:?} is {nearest} m away from all points");
        }
    }

    #[test]
    fn nothing_in_range_stays_nothing_in_range() {
        let seen = mounted((0.3, -0.2, 2.5), &half_turn(f32::INFINITY));
        let count = |test: fn(&f32) -> bool| seen.ranges.iter().filter(|range| test(range)).count();
        assert_eq!((count(|range| range.is_infinite()), count(|range| range.is_nan())), (361, 359));
        let mut out = Out::new();
        let near = mounted((0.0, 0.0, -0.6), &half_turn(1.0));
        MergeScans.process(Some(&seen), Some(&near), &mut out).expect("the same beams");
        let merged = out.get().expect("a scan");
        assert!((0..720).all(|beam| near.range(beam).is_none() || merged.range(beam).is_some()));
        assert!(merged.ranges.iter().any(|range| range.is_infinite()));
    }

    #[test]
    fn the_seam_behind_is_seen() {
        let mut scan = Scan { angle_increment: 0.001, ..Scan::default() };
        scan.ranges.extend([1.0, 1.0]);
        for heading in [-PI, PI - 0.0005, PI] {
            let seen = mounted((0.0, 0.0, heading), &scan);
            assert_eq!((seen.ranges.len(), seen.points().count(), seen.range(0)), (720, 1, Some(1.0)), "{heading}");
        }
    }

    #[test]
    fn the_nearer_one_counts() {
        let front = Scan { stamp: Time::from_secs(2), ..mounted((0.0, 0.0, 0.0), &half_turn(2.0)) };
        let rear = Scan { stamp: Time::from_secs(1), ..mounted((0.0, 0.0, 0.5 * PI), &half_turn(1.0)) };
        let merge = |a: Option<&Scan>, b: Option<&Scan>| {
            let mut out = Out::new();
            MergeScans.process(a, b, &mut out).map(|()| out.get().cloned())
        };
        let both = merge(Some(&front), Some(&rear)).expect("the same beams").expect("a scan");
        let towards = |degree: usize| both.range(2 * (degree + 180)).map(libm::roundf);
        // Forward, to the left, and to the right; nothing behind on the right.
        assert_eq!([towards(0), both.range(180).map(libm::roundf)], [Some(1.0), Some(2.0)]);
        assert_eq!((towards(90), both.range(90), both.stamp), (Some(1.0), None, Time::from_secs(1)));
        assert_eq!(merge(None, None), Ok(None));
        assert_eq!(
            merge(None, Some(&rear)).map(|scan| scan.map(|s| s.points().count())),
            Ok(Some(rear.points().count()))
        );
        assert_eq!(merge(Some(&half_turn(1.0)), Some(&rear)), Err(OtherBeams));
    }
}
