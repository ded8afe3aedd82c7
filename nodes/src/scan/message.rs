//! ROS 2 messages of scans, poses and points, which Foxglove and Python can show.

pub(crate) use super::foreign::{FromPose, poses};
use super::{Point2, Pose2, Ranges, Scan, UncertainPose};
use apex_messages::{
    Foreign, Reason, converted,
    geometry_msgs::{
        Point, PointStamped, Pose, PoseStamped, PoseWithCovariance, PoseWithCovarianceStamped, Quaternion, Transform,
        TwistWithCovariance, Vector3,
    },
    nav_msgs::Odometry,
    sensor_msgs::LaserScan,
    std_msgs::Header,
};
use apex_rt::Time;
use core::f32::consts::PI;

/// Frame of all messages. Types do not name their frame, so all are shown in the same one.
pub(crate) const FRAME: &str = "robot";

impl From<&Scan> for LaserScan {
    fn from(scan: &Scan) -> Self {
        Self {
            header: Header::new(scan.stamp, FRAME),
            angle_min: scan.angle_min,
            angle_max: scan.angle(scan.ranges.len().saturating_sub(1)),
            angle_increment: scan.angle_increment,
            time_increment: scan.time_increment,
            // The time until the next scan is unknown.
            scan_time: 0.0,
            range_min: scan.range_min,
            range_max: scan.range_max,
            ranges: scan.ranges.to_vec(),
            intensities: vec![],
        }
    }
}

impl TryFrom<LaserScan> for Scan {
    type Error = Reason;

    fn try_from(message: LaserScan) -> Result<Self, Reason> {
        let LaserScan { header, angle_min, angle_increment, time_increment, range_min, range_max, .. } = message;
        let mut ranges = Ranges::new();
        for range in message.ranges {
            ranges.push(range).map_err(|error| error.to_string())?;
        }
        Ok(Self {
            angle_min,
            angle_increment,
            range_min,
            range_max,
            stamp: header.stamp.into(),
            time_increment,
            ranges,
        })
    }
}

converted!(Scan as LaserScan);

impl From<&Pose2> for PoseStamped {
    fn from(pose: &Pose2) -> Self {
        Self { header: Header::new(Time::ZERO, FRAME), pose: pose.into() }
    }
}

/// Odometry of which the pose alone is known: the twist is zero, and so are all covariances.
impl From<&Pose2> for Odometry {
    fn from(pose: &Pose2) -> Self {
        Self {
            header: Header::new(Time::ZERO, FRAME),
            child_frame_id: "base_link".to_owned(),
            pose: PoseWithCovariance { pose: seen(pose), ..PoseWithCovariance::default() },
            twist: TwistWithCovariance::default(),
        }
    }
}

impl TryFrom<PoseStamped> for Pose2 {
    type Error = Reason;

    fn try_from(PoseStamped { pose, .. }: PoseStamped) -> Result<Self, Reason> {
        let Quaternion { y, z, w, .. } = pose.orientation;
        // An angle that no quaternion can hold, which is in x.
        if y == 0.0 && z == 0.0 && w == 0.0 { Ok((&pose).into()) } else { Self::from_pose(&pose) }
    }
}

converted!(Pose2 as PoseStamped, outside = |pose| PoseStamped { pose: seen(pose), ..pose.into() }, others = poses());

/// Places of x, y and heading among the six of a covariance in a message.
const PLACES: [usize; 3] = [0, 1, 5];

impl UncertainPose {
    /// The message with this orientation.
    fn message(&self, pose: Pose) -> PoseWithCovarianceStamped {
        let mut covariance = [0.0; 36];
        for (row, i) in self.covariance.iter().zip(PLACES) {
            row.iter().zip(PLACES).for_each(|(value, j)| covariance[6 * i + j] = f64::from(*value));
        }
        let pose = PoseWithCovariance { pose, covariance };
        PoseWithCovarianceStamped { header: Header::new(Time::ZERO, FRAME), pose }
    }
}

impl From<&UncertainPose> for PoseWithCovarianceStamped {
    fn from(estimate: &UncertainPose) -> Self {
        estimate.message((&estimate.pose).into())
    }
}

/// Pose as seen from above. Height and tilt are left out, and so are their variances.
impl TryFrom<PoseWithCovariance> for UncertainPose {
    type Error = Reason;

    fn try_from(PoseWithCovariance { pose, covariance }: PoseWithCovariance) -> Result<Self, Reason> {
        let covariance = PLACES.map(|i| PLACES.map(|j| covariance[6 * i + j] as f32));
        Ok(Self { pose: PoseStamped { pose, ..PoseStamped::default() }.try_into()?, covariance })
    }
}

impl TryFrom<PoseWithCovarianceStamped> for UncertainPose {
    type Error = Reason;

    fn try_from(message: PoseWithCovarianceStamped) -> Result<Self, Reason> {
        message.pose.try_into()
    }
}

converted!(
    UncertainPose as PoseWithCovarianceStamped,
    outside = |estimate| estimate.message(seen(&estimate.pose)),
    others = vec![
        Foreign::of::<PoseWithCovariance>(|message, _| Self::try_from(PoseWithCovariance::read(message)?).map(Some)),
        Foreign::of::<Odometry>(|message, _| Self::try_from(Odometry::read(message)?.pose).map(Some)),
    ]
);

/// Pose with the orientation as a rotation, which is the same for a heading of a turn more.
pub(crate) fn seen(pose: &Pose2) -> Pose {
    let (z, w) = libm::sincos(0.5 * f64::from(pose.theta));
    Pose { position: (&pose.position()).into(), orientation: Quaternion { x: 0.0, y: 0.0, z, w } }
}

/// Transform to a frame at this pose.
impl From<&Pose2> for Transform {
    fn from(pose: &Pose2) -> Self {
        let Pose { position: Point { x, y, z }, orientation } = seen(pose);
        Self { translation: Vector3 { x, y, z }, rotation: orientation }
    }
}

impl From<&Pose2> for Pose {
    fn from(pose: &Pose2) -> Self {
        let (z, w) = libm::sincos(0.5 * f64::from(pose.theta));
        // A quaternion cannot hold more than half a turn or NaN. Such an angle is stored in x, with z = w = 0.
        let is_same = angle(z, w).to_bits() == pose.theta.to_bits() && pose.theta.abs() <= PI;
        let (x, z, w) = if is_same { (0.0, z, w) } else { (f64::from(pose.theta), 0.0, 0.0) };
        Self { position: (&pose.position()).into(), orientation: Quaternion { x, y: 0.0, z, w } }
    }
}

/// Pose as seen from above.
impl From<&Pose> for Pose2 {
    fn from(pose: &Pose) -> Self {
        Self::new(pose.position.x as f32, pose.position.y as f32, heading(&pose.orientation))
    }
}

/// Heading of a quaternion, in rad: the direction in which the x axis points, seen from above.
fn heading(&Quaternion { x, y, z, w }: &Quaternion) -> f32 {
    // An angle that no quaternion can hold: x is NaN, or longer than that of a quaternion.
    if y == 0.0 && z == 0.0 && w == 0.0 && (x.is_nan() || x.abs() > 1.0) {
        return x as f32;
    }
    let exact = angle(z, w);
    if x == 0.0 && y == 0.0 && exact.abs() <= PI {
        return exact;
    }
    libm::atan2(2.0 * (w * z + x * y), w * w + x * x - y * y - z * z) as f32
}

/// Angle of a rotation about the vertical axis, in rad. Double precision makes the rounded `f32` exact.
fn angle(z: f64, w: f64) -> f32 {
    (2.0 * libm::atan2(z, w)) as f32
}

impl From<&Point2> for Point {
    fn from(point: &Point2) -> Self {
        Self { x: f64::from(point.x), y: f64::from(point.y), z: 0.0 }
    }
}

/// Point as seen from above.
impl TryFrom<Point> for Point2 {
    type Error = Reason;

    fn try_from(point: Point) -> Result<Self, Reason> {
        Ok(Self::new(point.x as f32, point.y as f32))
    }
}

converted!(
    Point2 as Point,
    others = vec![Foreign::of::<PointStamped>(|message, _| {
        Self::try_from(PointStamped::read(message)?.point).map(Some)
    })]
);

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use apex_messages::{
        Message,
        cdr::{Outside, Reader, Writer},
    };
    use core::f32::consts::TAU;

    /// Message that contains a token.
    pub(crate) fn bytes(token: &impl Message) -> Vec<u8> {
        token.to_bytes()
    }

    /// Token of a message.
    pub(crate) fn again<T: Message>(bytes: &[u8]) -> Option<T> {
        reason(bytes).ok()
    }

    /// Token of a message, or the reason why there is none.
    pub(crate) fn reason<T: Message>(bytes: &[u8]) -> Result<T, Reason> {
        T::read(&mut Reader::new(bytes)?)
    }

    #[test]
    fn scans_of_other_programs_are_read() {
        let scan = Scan { angle_increment: 0.1, ranges: (0..2000).map(|i| i as f32).collect(), ..Scan::default() };
        let mut bytes = bytes(&scan);
        // Two intensities.
        let end = bytes.len();
        bytes[end - 4] = 2;
        bytes.extend([0; 8]);
        let codec = apex_rt::__codec!(Scan).expect("a message");
        assert_eq!((codec.read)(&bytes).map(|scan| scan.ranges.len()), Ok(2000));
        assert!((codec.read)(&bytes[..end + 4]).is_err(), "an intensity is missing");
        let many = LaserScan { ranges: vec![1.0; 70_000], ..LaserScan::default() }.to_bytes();
        assert!(reason::<Scan>(&many).expect_err("too many").starts_with("more than 65535 beams"));
    }

    #[test]
    fn headings_of_other_programs_are_those_from_above() {
        let half = 0.5_f64.sqrt();
        for (quaternion, expected) in [
            ([0.0, 0.0, half, half], 0.5 * PI),
            ([0.0, 0.0, 0.1, -0.995], -0.2003),
            ([0.0, 0.0, -half, -half], 0.5 * PI),
            ([0.0, 0.0, 2.0, 2.0], 0.5 * PI),
            // On its back, looking forward; pitched, and turned by 90° before.
            ([1.0, 0.0, 0.0, 0.0], 0.0),
            ([-0.353, 0.353, 0.612, 0.612], 0.5 * PI),
            ([0.0; 4], 0.0),
        ] {
            let [x, y, z, w] = quaternion;
            let found = heading(&Quaternion { x, y, z, w });
            assert!((found - expected).abs() < 1e-3, "{quaternion:?}: {found}");
        }
    }

    #[test]
    fn stamped_poses_have_rotations_zeros_or_angles() {
        let read = |[x, y, z, w]: [f64; 4]| {
            let pose = Pose { position: Point::default(), orientation: Quaternion { x, y, z, w } };
            reason::<Pose2>(&PoseStamped { pose, ..PoseStamped::default() }.to_bytes()).map(|pose| pose.theta)
        };
        assert_eq!((read([0.0; 4]), read([0.0, 0.0, 0.0, -1.0])), (Ok(0.0), Ok(0.0)));
        assert_eq!(read([7.0, 0.0, 0.0, 0.0]), Ok(7.0));
        for (quaternion, why) in
            [([0.0, 0.0, 0.0, 0.5], "the length of a quaternion is 0.500"), ([0.0, 0.0, 0.0, f64::NAN], "not finite")]
        {
            let refused = read(quaternion).expect_err(why);
            assert!(refused.contains(why), "{refused}");
        }
    }

    #[test]
    fn scans_come_back_bit_by_bit() {
        let stamp = Time::from_nanos(-1);
        let mut scan = Scan { angle_min: -PI, angle_increment: 0.1, time_increment: 1e-4, stamp, ..Scan::default() };
        let odd = [f32::from_bits(0x7fc0_1234), f32::NAN, f32::INFINITY, -0.0, 1.5, f32::MIN_POSITIVE / 2.0];
        scan.ranges.extend(odd);
        let read: Scan = again(&bytes(&scan)).expect("what was written");
        assert!(read.ranges.iter().zip(odd).all(|(a, b)| a.to_bits() == b.to_bits()));
        assert_eq!((read.stamp, read.angle_min, read.angle_increment), (scan.stamp, scan.angle_min, 0.1));
        assert_eq!(read.time_increment, scan.time_increment);
        assert_eq!((read.range_min, read.range_max, read.ranges.len()), (scan.range_min, scan.range_max, odd.len()));
    }

    #[test]
    fn headings_are_rotations_for_other_programs() {
        for theta in [0.0, 3.0, -3.0, 3.5, -40.0, 1e6] {
            let (pose, mut bytes) = (Pose2::new(1.0, 2.0, theta), vec![]);
            let outside = Outside { zero: 0, now: 1, frame: Some("map") };
            pose.write(&mut Writer::new(&mut bytes).for_others(outside));
            let PoseStamped { header, pose: Pose { orientation, .. } } = reason(&bytes).expect("a pose");
            for Quaternion { x, y, z, w } in [orientation, Transform::from(&pose).rotation] {
                assert!((x * x + y * y + z * z + w * w - 1.0).abs() < 1e-9, "{theta}");
                let off = f64::from(theta) - 2.0 * z.atan2(w);
                assert!((0.5 * off).sin().abs() < 1e-6, "{theta}");
            }
            assert_eq!(header, Header::new(Time::from_nanos(1), "map"));
        }
    }

    #[test]
    fn estimates_come_back_with_their_covariances_also_from_odometry() {
        let covariance = [[0.1, 0.01, -0.02], [0.01, 0.2, 0.03], [-0.02, 0.03, 0.3]];
        for theta in [0.4, 40.0] {
            let estimate = UncertainPose { pose: Pose2::new(1.0, 2.0, theta), covariance };
            assert_eq!(reason(&bytes(&estimate)), Ok(estimate));
        }
        let estimate = UncertainPose { pose: Pose2::new(1.0, 2.0, 0.5), covariance };
        let PoseWithCovarianceStamped { pose, .. } = (&estimate).into();
        let odometry = Odometry { pose, ..Odometry::default() };
        let others = UncertainPose::others();
        let of_odometry = others.iter().find(|known| known.name == Odometry::NAME).expect("known");
        let read = Reader::new(&odometry.to_bytes()).and_then(|mut message| (of_odometry.read)(&mut message, ""));
        assert_eq!(read, Ok(Some(estimate)));
        // For others, the orientation is always a rotation.
        let (turned, mut bytes) = (UncertainPose { pose: Pose2::new(1.0, 2.0, 40.0), covariance }, vec![]);
        turned.write(&mut Writer::new(&mut bytes).for_others(Outside { zero: 0, now: 1, frame: Some("map") }));
        let read: UncertainPose = reason(&bytes).expect("a pose");
        assert!((libm::sinf(0.5 * (read.pose.theta - 40.0))).abs() < 1e-5, "{read:?}");
        assert_eq!(read.covariance, covariance);
    }

    #[test]
    fn poses_come_back_bit_by_bit() {
        let steps = (-100_000..=100_000).map(|i| i as f32 * 1e-4);
        let odd = [0.0, -0.0, PI, -PI, TAU, -TAU, 1e9, 1e-40, f32::INFINITY, f32::NAN];
        for theta in steps.chain(odd) {
            let read: Pose2 = again(&bytes(&Pose2::new(1.25, f32::NAN, theta))).expect("what was written");
            assert_eq!(read.theta.to_bits(), theta.to_bits(), "{theta}");
            assert!(read.x == 1.25 && read.y.is_nan());
        }
    }
}
