//! ROS 2 message of point clouds, which Foxglove and Python can show.

use super::{CloudPoint, MAX_POINTS, PointCloud};
use crate::scan::message::FRAME;
use apex_rt::record::{
    Message,
    cdr::{Reader, Writer},
};

/// Fields of a point, each a number of four bytes.
const FIELDS: [&str; 4] = ["x", "y", "z", "intensity"];
/// Size of a point, in bytes.
const STEP: u32 = 4 * FIELDS.len() as u32;
/// Number type of the fields.
const FLOAT32: u8 = 7;

impl Message for PointCloud {
    const NAME: &'static str = "sensor_msgs/msg/PointCloud2";
    const DEFINITION: &'static str = "\
std_msgs/Header header
uint32 height
uint32 width
sensor_msgs/PointField[] fields
bool is_bigendian
uint32 point_step
uint32 row_step
uint8[] data
bool is_dense
================================================================================
MSG: sensor_msgs/PointField
string name
uint32 offset
uint8 datatype
uint32 count";

    fn write(&self, message: &mut Writer<'_>) {
        let (width, height) = self.size();
        message.header(self.stamp, FRAME);
        message.u32(height as u32);
        message.u32(width as u32);
        message.u32(FIELDS.len() as u32);
        for (i, name) in FIELDS.iter().enumerate() {
            message.text(name);
            message.u32(4 * i as u32);
            message.u8(FLOAT32);
            message.u32(1);
        }
        message.u8(0);
        message.u32(STEP);
        message.u32(STEP * width as u32);
        message.u32(STEP * self.points().len() as u32);
        for p in self.points() {
            let numbers = [p.x, p.y, p.z, p.intensity];
            numbers.iter().flat_map(|number| number.to_le_bytes()).for_each(|byte| message.u8(byte));
        }
        message.u8(0);
    }

    fn read(message: &mut Reader<'_>) -> Option<Self> {
        let stamp = message.header()?;
        let (height, width) = (message.u32()? as usize, message.u32()? as usize);
        if message.u32()? as usize != FIELDS.len() {
            return None;
        }
        for (i, name) in FIELDS.iter().enumerate() {
            let field = (message.text()?, message.u32()?, message.u8()?, message.u32()?);
            if field != (*name, 4 * i as u32, FLOAT32, 1) {
                return None;
            }
        }
        let (_, step, _) = (message.u8()?, message.u32()?, message.u32()?);
        let count = message.u32()? as usize;
        let points = width.checked_mul(height).filter(|points| *points <= MAX_POINTS)?;
        if step != STEP || points.checked_mul(STEP as usize)? != count {
            return None;
        }
        // Read number by number: a broken file may announce more bytes than it has.
        let mut read = Vec::new();
        for _ in 0..points {
            let mut number = || Some(f32::from_le_bytes([message.u8()?, message.u8()?, message.u8()?, message.u8()?]));
            read.push(CloudPoint { x: number()?, y: number()?, z: number()?, intensity: number()? });
        }
        message.u8()?;
        let mut cloud = Self::default();
        cloud.reset(stamp, (width, height));
        cloud.points_mut().copy_from_slice(&read);
        Some(cloud)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scan::message::tests::{again, bytes};
    use apex_rt::Time;

    #[test]
    fn clouds_come_back_and_parts_of_them_do_not() {
        let mut cloud = PointCloud::default();
        assert_eq!(again(&bytes(&cloud)), Some(cloud.clone()));
        cloud.reset(Time::from_nanos(-7), (3, 2));
        cloud.points_mut().fill(CloudPoint { x: 1.0, y: -2.0, z: 0.5, intensity: 9.0 });
        let whole = bytes(&cloud);
        assert_eq!(again(&whole), Some(cloud));
        assert!((0..whole.len()).all(|len| again::<PointCloud>(&whole[..len]).is_none()));
    }
}
