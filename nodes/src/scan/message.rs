//! ROS 2 messages of scans and poses, which Foxglove and Python can show.

use super::{Point2, Pose2, Ranges, Scan};
use apex_rt::{
    Time,
    record::{
        Message,
        cdr::{Reader, Writer},
    },
};

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

    fn read(message: &mut Reader<'_>) -> Option<Self> {
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
            scan.ranges.push(message.f32()?).ok()?;
        }
        Some(scan)
    }
}

impl Message for Pose2 {
    const NAME: &'static str = "geometry_msgs/msg/PoseStamped";
    const DEFINITION: &'static str = concat!("std_msgs/Header header\ngeometry_msgs/Pose pose", pose_definition!());

    fn write(&self, message: &mut Writer<'_>) {
        message.header(Time::ZERO, FRAME);
        write_pose(self, message);
    }

    fn read(message: &mut Reader<'_>) -> Option<Self> {
        message.header()?;
        read_pose(message)
    }
}

/// Writes a `geometry_msgs/Pose`.
pub(crate) fn write_pose(pose: &Pose2, message: &mut Writer<'_>) {
    pose.position().write(message);
    let (z, w) = libm::sincos(0.5 * f64::from(pose.theta));
    // A quaternion cannot hold more than a turn or NaN. Such an angle is stored in x, with z = w = 0.
    let (x, z, w) =
        if angle(z, w).to_bits() == pose.theta.to_bits() { (0.0, z, w) } else { (f64::from(pose.theta), 0.0, 0.0) };
    [x, 0.0, z, w].into_iter().for_each(|number| message.f64(number));
}

/// Reads a `geometry_msgs/Pose`.
pub(crate) fn read_pose(message: &mut Reader<'_>) -> Option<Pose2> {
    let position = Point2::read(message)?;
    let (x, _, z, w) = (message.f64()?, message.f64()?, message.f64()?, message.f64()?);
    let theta = if z == 0.0 && w == 0.0 { x as f32 } else { angle(z, w) };
    Some(Pose2::new(position.x, position.y, theta))
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

    fn read(message: &mut Reader<'_>) -> Option<Self> {
        let (x, y, _) = (message.f64()?, message.f64()?, message.f64()?);
        Some(Self::new(x as f32, y as f32))
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use core::f32::consts::{PI, TAU};
    use std::vec::Vec;

    /// Message that contains a token.
    pub(crate) fn bytes(token: &impl Message) -> Vec<u8> {
        let mut bytes = Vec::new();
        token.write(&mut Writer::new(&mut bytes));
        bytes
    }

    /// Token of a message.
    pub(crate) fn again<T: Message>(bytes: &[u8]) -> Option<T> {
        T::read(&mut Reader::new(bytes)?)
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
