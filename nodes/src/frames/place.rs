use super::Pose3;
#[cfg(feature = "std")]
use crate::cloud::{CloudPoint, PointCloud};
use crate::scan::{BeamDirections, Point2, Pose2, Scan, around};
use apex_rt::{Out, node};

/// Pose as seen from above: height and tilt are left out.
#[node]
pub fn seen_from_above(pose: &Pose3) -> Pose2 {
    pose.into()
}

/// Turns a scan into one of a virtual scanner at the origin of another frame, in which the scanner has the pose `pose`
/// when it scans. It may be tilted, or hang upside down: its points are seen from above.
///
/// The result has the beams of [`MountScan`](crate::scan::MountScan), which is for a scanner that does not move on its
/// robot.
#[node]
#[derive(Debug, Clone, Default)]
pub struct PlaceScan {
    directions: BeamDirections,
}

#[node]
impl PlaceScan {
    fn process(&mut self, scan: &Scan, pose: &Pose3, placed: &mut Out<Scan>) {
        let [[xx, xy, _], [yx, yy, _], _] = pose.rotation.matrix();
        let turned = |point: Point2| {
            let (x, y) = (f64::from(point.x), f64::from(point.y));
            (xx * x + xy * y, yx * x + yy * y)
        };
        let to_outer = |point| {
            let (x, y) = turned(point);
            Point2::new((pose.x + x) as f32, (pose.y + y) as f32)
        };
        let direction = |angle| {
            let (x, y) = turned(Point2::polar(1.0, angle));
            libm::atan2(y, x) as f32
        };
        around(scan, &mut self.directions, to_outer, direction, placed.get_mut());
    }
}

/// Turns a point cloud into another frame, in which that of the cloud has the pose `pose`.
#[cfg(feature = "std")]
#[node]
pub fn place_cloud(cloud: &PointCloud, pose: &Pose3, placed: &mut Out<PointCloud>) {
    let placed = placed.get_mut();
    placed.clone_from(cloud);
    let (rows, origin) = (pose.rotation.matrix(), pose.position());
    for point in placed.points_mut() {
        let CloudPoint { x, y, z, intensity } = *point;
        let (a, b, c) = (f64::from(x), f64::from(y), f64::from(z));
        let [x, y, z] = core::array::from_fn(|i| {
            let [p, q, r] = rows[i];
            (origin[i] + p * a + q * b + r * c) as f32
        });
        *point = CloudPoint { x, y, z, intensity };
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frames::Rotation;
    use core::f32::consts::{FRAC_PI_2, PI};

    /// A scan of a quarter turn to the left.
    fn quarter(range: f32) -> Scan {
        let mut scan = Scan { angle_increment: FRAC_PI_2 / 90.0, ..Scan::default() };
        scan.ranges.extend([range; 91]);
        scan
    }

    fn placed(scan: &Scan, pose: &Pose3) -> Scan {
        let mut out = Out::new();
        PlaceScan::default().process(scan, pose, &mut out);
        out.get().expect("a scan").clone()
    }

    #[test]
    fn a_scan_in_the_plane_is_a_mounted_one() {
        use crate::scan::MountScan;
        use apex_rt::Construct as _;
        let mut scan = quarter(2.0);
        scan.ranges[..10].fill(f32::INFINITY);
        let (mut mounted, pose) = (Out::new(), Pose2::new(0.3, -0.2, 2.5));
        MountScan::construct((pose.x, pose.y, pose.theta)).process(&scan, &mut mounted);
        let found = placed(&scan, &(&pose).into());
        let same = |(a, b): (&f32, &f32)| (a - b).abs() < 1e-5 || a.to_bits() == b.to_bits();
        assert!(found.ranges.iter().zip(&mounted.get().expect("a scan").ranges).all(same));
    }

    #[test]
    fn a_scanner_upside_down_sees_the_other_side() {
        let pose = Pose3::new([0.0, 0.0, 1.0], Rotation::from_rpy(core::f64::consts::PI, 0.0, 0.0));
        for range in [2.0, f32::INFINITY] {
            let found = placed(&quarter(range), &pose);
            let beams = (0..720).filter(|beam| !found.ranges[*beam].is_nan());
            assert!(beams.clone().all(|beam| (-0.5 * PI - 0.01..=0.01).contains(&found.angle(beam))));
            assert_eq!(beams.count(), 91);
        }
    }

    #[test]
    fn a_tilted_scanner_sees_the_floor_from_above() {
        // Down by 60°: a beam of 2 m ends 1 m ahead.
        let pose = Pose3::new([0.5, 0.0, 1.7], Rotation::from_rpy(0.0, core::f64::consts::FRAC_PI_3, 0.0));
        let found = placed(&quarter(2.0), &pose);
        assert!(found.range(360).is_some_and(|range| (range - 1.5).abs() < 1e-5), "{:?}", found.range(360));
        assert_eq!(seen_from_above(&pose), Pose2::new(0.5, 0.0, 0.0));
    }

    #[cfg(feature = "std")]
    #[test]
    fn a_cloud_is_turned_point_by_point() {
        let mut cloud = PointCloud::default();
        cloud.reset(apex_rt::Time::from_millis(3), (2, 1));
        cloud.points_mut()[0] = CloudPoint { x: 1.0, y: 2.0, z: 3.0, intensity: 7.0 };
        let pose = Pose3::new([10.0, 0.0, 0.5], Rotation::from_rpy(0.0, 0.0, core::f64::consts::FRAC_PI_2));
        let mut out = Out::new();
        place_cloud(&cloud, &pose, &mut out);
        let placed = out.get().expect("a cloud");
        let CloudPoint { x, y, z, intensity } = placed.points()[0];
        assert!((x - 8.0).abs() < 1e-6 && (y - 1.0).abs() < 1e-6 && (z - 3.5).abs() < 1e-6 && intensity == 7.0);
        assert!(!placed.points()[1].is_measured() && placed.stamp == cloud.stamp);
    }
}
