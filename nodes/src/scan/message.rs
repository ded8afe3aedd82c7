//! ROS 2 messages of scans and poses, which Foxglove and Python can show.

use super::{Point2, Pose2, Ranges, Scan, foreign};
use apex_rt::{
    Time,
    record::{
        Foreign, Message, Reason,
        cdr::{Reader, Writer},
    },
};
use core::f32::consts::PI;

/// Frame of all messages. Types do not name their frame, so all are shown in the same one.
pub(crate) const FRAME: &str = "robot";

/// Definitions of `geometry_msgs/Pose` and of its parts, for the end of a message definition.
macro_rules! pose_definition {
    () => {
        "
================================================================================
MSG: geometry_msgs/Pose
geometry_msgs/Point position
geometry_msgs/Quaternion orientation
================================================================================
MSG: geometry_msgs/Point
float64 x
float64 y
float64 z
================================================================================
MSG: geometry_msgs/Quaternion
float64 x
float64 y
float64 z
float64 w"
    };
}
pub(crate) use pose_definition;

impl Message for Scan {
    const NAME: &'static str = "sensor_msgs/msg/LaserScan";
    const DEFINITION: &'static str = "\
std_msgs/Header header
float32 angle_min
float32 angle_max
float32 angle_increment
float32 time_increment
float32 scan_time
float32 range_min
float32 range_max
float32[] ranges
float32[] intensities";

    fn write(&self, message: &mut Writer<'_>) {
        message.header(self.stamp, FRAME);
        message.f32(self.angle_min);
        message.f32(self.angle(self.ranges.len().saturating_sub(1)));
        message.f32(self.angle_increment);
        // The beams have no time offsets, and the time until the next scan is unknown.
        message.f32(0.0);
        message.f32(0.0);
        message.f32(self.range_min);
        message.f32(self.range_max);
        message.u32(self.ranges.len() as u32);
        self.ranges.iter().for_each(|range| message.f32(*range));
        message.u32(0);
    }

    fn read(message: &mut Reader<'_>) -> Result<Self, Reason> {
        let stamp = message.header()?;
        let (angle_min, _, angle_increment) = (message.f32()?, message.f32()?, message.f32()?);
        let (_, _) = (message.f32()?, message.f32()?);
        let mut scan = Self {
            angle_min,
            angle_increment,
            range_min: message.f32()?,
            range_max: message.f32()?,
            stamp,
            ranges: Ranges::new(),
        };
        for _ in 0..message.u32()? {
            scan.ranges.push(message.f32()?).map_err(|error| error.to_string())?;
        }
        // Intensities are not used.
        for _ in 0..message.u32()? {
            message.f32()?;
        }
        Ok(scan)
    }
}

impl Message for Pose2 {
    const NAME: &'static str = "geometry_msgs/msg/PoseStamped";
    const DEFINITION: &'static str = concat!("std_msgs/Header header\ngeometry_msgs/Pose pose", pose_definition!());

    fn write(&self, message: &mut Writer<'_>) {
        message.header(Time::ZERO, FRAME);
        write_pose(self, message);
    }

    fn read(message: &mut Reader<'_>) -> Result<Self, Reason> {
        message.header()?;
        read_pose(message)
    }

    fn others() -> Vec<Foreign<Self>> {
        foreign::poses()
    }
}

/// Writes a `geometry_msgs/Pose`.
pub(crate) fn write_pose(pose: &Pose2, message: &mut Writer<'_>) {
    pose.position().write(message);
    let (z, w) = libm::sincos(0.5 * f64::from(pose.theta));
    // A quaternion cannot hold more than half a turn or NaN. Such an angle is stored in x, with z = w = 0.
    let is_same = angle(z, w).to_bits() == pose.theta.to_bits() && pose.theta.abs() <= PI;
    let (x, z, w) = if is_same { (0.0, z, w) } else { (f64::from(pose.theta), 0.0, 0.0) };
    [x, 0.0, z, w].into_iter().for_each(|number| message.f64(number));
}

/// Reads a `geometry_msgs/Pose`, as seen from above.
pub(crate) fn read_pose(message: &mut Reader<'_>) -> Result<Pose2, Reason> {
    let position = Point2::read(message)?;
    let quaternion = [message.f64()?, message.f64()?, message.f64()?, message.f64()?];
    Ok(Pose2::new(position.x, position.y, heading(quaternion)))
}

/// Heading of a quaternion, in rad: the direction in which the x axis points, seen from above.
pub(super) fn heading([x, y, z, w]: [f64; 4]) -> f32 {
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

impl Message for Point2 {
    const NAME: &'static str = "geometry_msgs/msg/Point";
    const DEFINITION: &'static str = "float64 x\nfloat64 y\nfloat64 z";

    fn write(&self, message: &mut Writer<'_>) {
        [self.x, self.y, 0.0].into_iter().for_each(|number| message.f64(f64::from(number)));
    }

    fn read(message: &mut Reader<'_>) -> Result<Self, Reason> {
        let (x, y, _) = (message.f64()?, message.f64()?, message.f64()?);
        Ok(Self::new(x as f32, y as f32))
    }

    fn others() -> Vec<Foreign<Self>> {
        let read = |message: &mut Reader<'_>, _: &str| {
            message.header()?;
            Self::read(message).map(Some)
        };
        vec![Foreign { name: "geometry_msgs/msg/PointStamped", definition: "", read }]
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use core::f32::consts::TAU;
    use std::vec::Vec;

    /// Message that contains a token.
    pub(crate) fn bytes(token: &impl Message) -> Vec<u8> {
        let mut bytes = Vec::new();
        token.write(&mut Writer::new(&mut bytes));
        bytes
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
        let mut many = Vec::new();
        let mut message = Writer::new(&mut many);
        message.header(Time::ZERO, "laser");
        (0..7).for_each(|_| message.f32(0.0));
        message.u32(70_000);
        (0..70_000).for_each(|_| message.f32(1.0));
        message.u32(0);
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
            let found = heading(quaternion);
            assert!((found - expected).abs() < 1e-3, "{quaternion:?}: {found}");
        }
    }

    #[test]
    fn scans_come_back_bit_by_bit() {
        let mut scan = Scan { angle_min: -PI, angle_increment: 0.1, stamp: Time::from_nanos(-1), ..Scan::default() };
        let odd = [f32::from_bits(0x7fc0_1234), f32::NAN, f32::INFINITY, -0.0, 1.5, f32::MIN_POSITIVE / 2.0];
        scan.ranges.extend(odd);
        let read: Scan = again(&bytes(&scan)).expect("what was written");
        assert!(read.ranges.iter().zip(odd).all(|(a, b)| a.to_bits() == b.to_bits()));
        assert_eq!((read.stamp, read.angle_min, read.angle_increment), (scan.stamp, scan.angle_min, 0.1));
        assert_eq!((read.range_min, read.range_max, read.ranges.len()), (scan.range_min, scan.range_max, odd.len()));
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
