//! ROS 2 message of point clouds, which Foxglove and Python can show.

use super::{CloudPoint, MAX_POINTS, PointCloud};
use crate::scan::message::FRAME;
use apex_rt::record::{
    Message, Reason,
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

    fn read(message: &mut Reader<'_>) -> Result<Self, Reason> {
        let stamp = message.header()?;
        let (height, width) = (message.u32()? as usize, message.u32()? as usize);
        let places = places(message)?;
        let (is_big, step, row) = (message.u8()?, message.u32()? as usize, message.u32()? as usize);
        let count = message.u32()? as usize;
        if is_big != 0 {
            return Err("its numbers are big-endian, which is not supported".into());
        }
        let points = width.checked_mul(height).filter(|points| *points <= MAX_POINTS);
        points.ok_or_else(|| format!("{width} x {height} points are more than {MAX_POINTS}"))?;
        let is_inside = places.iter().flatten().all(|place| place.checked_add(4).is_some_and(|end| end <= step));
        let fits = width.checked_mul(step).is_some_and(|size| size <= row) && row.checked_mul(height) == Some(count);
        if !is_inside || !fits {
            return Err(format!("it has {count} bytes for {height} rows of {row} bytes with {width} x {step}").into());
        }
        let bytes = message.bytes(count)?;
        message.u8()?;
        let mut cloud = Self::default();
        cloud.reset(stamp, (width, height));
        for (i, point) in cloud.points_mut().iter_mut().enumerate() {
            let start = i / width * row + i % width * step;
            let number =
                |place: usize| bytes[start + place..].first_chunk().map_or(f32::NAN, |b| f32::from_le_bytes(*b));
            let [x, y, z, intensity] = places.map(|place| place.map_or(0.0, number));
            *point = CloudPoint { x, y, z, intensity };
        }
        Ok(cloud)
    }
}

/// Reads the fields, and returns the places of those that a point has; `intensity` may be missing.
fn places(message: &mut Reader<'_>) -> Result<[Option<usize>; FIELDS.len()], Reason> {
    let (mut places, mut names) = ([None; FIELDS.len()], vec![]);
    for _ in 0..message.u32()? {
        let (name, offset, kind, count) = (message.text()?, message.u32()?, message.u8()?, message.u32()?);
        let known = FIELDS.iter().position(|field| *field == name).filter(|_| kind == FLOAT32 && count == 1);
        if let Some(field) = known {
            places[field] = Some(offset as usize);
        }
        names.push(name);
    }
    match places {
        [Some(_), Some(_), Some(_), _] => Ok(places),
        _ => Err(format!("its fields are `{}`; `x`, `y` and `z` must be of type `float32`", names.join("`, `")).into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scan::message::tests::{again, bytes, reason};
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

    /// Message of a cloud of two points, with these fields and their kinds, of four bytes each.
    fn foreign(fields: &[(&str, u8)], step: u32, numbers: &[f32]) -> Vec<u8> {
        let mut bytes = vec![];
        let mut message = Writer::new(&mut bytes);
        message.header(Time::ZERO, "velodyne");
        [1, 2, fields.len() as u32].into_iter().for_each(|number| message.u32(number));
        for (i, (name, kind)) in fields.iter().enumerate() {
            message.text(name);
            message.u32(4 * i as u32);
            message.u8(*kind);
            message.u32(1);
        }
        message.u8(0);
        let bytes_of_all = 4 * numbers.len() as u32;
        [step, bytes_of_all, bytes_of_all].into_iter().for_each(|number| message.u32(number));
        numbers.iter().flat_map(|number| number.to_le_bytes()).for_each(|byte| message.u8(byte));
        message.u8(1);
        bytes
    }

    #[test]
    fn clouds_of_other_programs_are_read_by_their_fields() {
        let float = |name| (name, FLOAT32);
        let plain = foreign(&["x", "y", "z"].map(float), 12, &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
        let cloud: PointCloud = again(&plain).expect("a cloud");
        let point = |x, y, z, intensity| CloudPoint { x, y, z, intensity };
        assert_eq!(cloud.points(), [point(1.0, 2.0, 3.0, 0.0), point(4.0, 5.0, 6.0, 0.0)]);
        let fields = [("ring", 4), float("z"), float("y"), float("x"), float("intensity")];
        let cloud: PointCloud = again(&foreign(&fields, 20, &[0.0, 3.0, 2.0, 1.0, 9.0].repeat(2))).expect("a cloud");
        assert_eq!(cloud.points()[1], point(1.0, 2.0, 3.0, 9.0));
        let refused = reason::<PointCloud>(&foreign(&[float("x"), ("y", 8)], 8, &[0.0; 4])).expect_err("no z");
        assert_eq!(refused, "its fields are `x`, `y`; `x`, `y` and `z` must be of type `float32`");
        for step in [8, 16, u32::MAX] {
            let wrong = foreign(&["x", "y", "z"].map(float), step, &[0.0; 6]);
            assert!(reason::<PointCloud>(&wrong).is_err_and(|why| why.contains("it has 24 bytes")), "{step}");
        }
    }
}
