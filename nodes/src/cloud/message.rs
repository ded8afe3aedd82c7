//! ROS 2 message of point clouds, which Foxglove and Python can show.

use super::{CloudPoint, MAX_POINTS, PointCloud};
use crate::scan::message::FRAME;
use apex_messages::{
    Reason, converted,
    sensor_msgs::{PointCloud2, PointField},
    std_msgs::Header,
};

/// Fields of a point, each a number of four bytes.
const FIELDS: [&str; 4] = ["x", "y", "z", "intensity"];
/// Size of a point, in bytes.
const STEP: u32 = 4 * FIELDS.len() as u32;

impl From<&PointCloud> for PointCloud2 {
    fn from(cloud: &PointCloud) -> Self {
        let (width, height) = cloud.size();
        let field = |(i, name): (usize, &&str)| PointField {
            name: (*name).to_owned(),
            offset: 4 * i as u32,
            datatype: PointField::FLOAT32,
            count: 1,
        };
        let numbers = cloud.points().iter().flat_map(|p| [p.x, p.y, p.z, p.intensity]);
        Self {
            header: Header::new(cloud.stamp, FRAME),
            height: height as u32,
            width: width as u32,
            fields: FIELDS.iter().enumerate().map(field).collect(),
            is_bigendian: false,
            point_step: STEP,
            row_step: STEP * width as u32,
            data: numbers.flat_map(f32::to_le_bytes).collect(),
            is_dense: false,
        }
    }
}

impl TryFrom<PointCloud2> for PointCloud {
    type Error = Reason;

    fn try_from(message: PointCloud2) -> Result<Self, Reason> {
        let PointCloud2 { header, fields, is_bigendian, data, .. } = message;
        let (height, width) = (message.height as usize, message.width as usize);
        let (step, row) = (message.point_step as usize, message.row_step as usize);
        let places = places(&fields)?;
        let points = width.checked_mul(height).filter(|points| *points <= MAX_POINTS);
        points.ok_or_else(|| format!("{width} x {height} points are more than {MAX_POINTS}"))?;
        let is_inside = places.iter().flatten().all(|place| place.end().is_some_and(|end| end <= step));
        let fits =
            width.checked_mul(step).is_some_and(|size| size <= row) && row.checked_mul(height) == Some(data.len());
        if !is_inside || !fits {
            let count = data.len();
            return Err(format!("it has {count} bytes for {height} rows of {row} bytes with {width} x {step}").into());
        }
        let mut cloud = Self::default();
        cloud.reset(header.stamp.into(), (width, height));
        for (i, point) in cloud.points_mut().iter_mut().enumerate() {
            let start = i / width * row + i % width * step;
            let number = |place: Place| place.number(&data[start..], is_bigendian);
            let [x, y, z, intensity] = places.map(|place| place.map_or(0.0, number));
            *point = CloudPoint { x, y, z, intensity };
        }
        Ok(cloud)
    }
}

converted!(PointCloud as PointCloud2);

/// Place of a field in a point, and the kind of its number.
#[derive(Clone, Copy)]
struct Place {
    offset: usize,
    datatype: u8,
}

impl Place {
    /// Number of bytes before the end of the field; `None` if it has no number.
    fn end(self) -> Option<usize> {
        let size = match self.datatype {
            PointField::INT8 | PointField::UINT8 => 1,
            PointField::INT16 | PointField::UINT16 => 2,
            PointField::INT32 | PointField::UINT32 | PointField::FLOAT32 => 4,
            PointField::FLOAT64 => 8,
            _ => return None,
        };
        self.offset.checked_add(size)
    }

    /// Number in a point.
    fn number(self, point: &[u8], is_bigendian: bool) -> f32 {
        let bytes = self.end().and_then(|end| point.get(self.offset..end)).unwrap_or_default();
        // The lowest byte first.
        let mut number = [0; 8];
        for (i, to) in number[..bytes.len()].iter_mut().enumerate() {
            *to = bytes[if is_bigendian { bytes.len() - 1 - i } else { i }];
        }
        let bits = u64::from_le_bytes(number);
        match self.datatype {
            PointField::INT8 => f32::from(bits as i8),
            PointField::INT16 => f32::from(bits as i16),
            PointField::INT32 => bits as i32 as f32,
            PointField::FLOAT32 => f32::from_bits(bits as u32),
            PointField::FLOAT64 => f64::from_bits(bits) as f32,
            _ => bits as f32,
        }
    }
}

/// Places of the fields of a point. Coordinates are of type `float32`; `intensity` may be any number, or missing.
fn places(fields: &[PointField]) -> Result<[Option<Place>; FIELDS.len()], Reason> {
    let mut places = [None; FIELDS.len()];
    for PointField { name, offset, datatype, count } in fields {
        let fits = |field: &usize| *count == 1 && (*datatype == PointField::FLOAT32 || FIELDS[*field] == "intensity");
        if let Some(field) = FIELDS.iter().position(|field| field == name).filter(fits) {
            places[field] = Some(Place { offset: *offset as usize, datatype: *datatype });
        }
    }
    match places {
        [Some(_), Some(_), Some(_), _] => Ok(places),
        _ => {
            let names = fields.iter().map(|field| field.name.as_str()).collect::<Vec<_>>().join("`, `");
            Err(format!("its fields are `{names}`; `x`, `y` and `z` must be of type `float32`").into())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scan::message::tests::{again, bytes, reason};
    use apex_messages::Message as _;
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
        let field = |(i, (name, datatype)): (usize, &(&str, u8))| PointField {
            name: (*name).to_owned(),
            offset: 4 * i as u32,
            datatype: *datatype,
            count: 1,
        };
        PointCloud2 {
            header: Header::new(Time::ZERO, "velodyne"),
            height: 1,
            width: 2,
            fields: fields.iter().enumerate().map(field).collect(),
            is_bigendian: false,
            point_step: step,
            row_step: 4 * numbers.len() as u32,
            data: numbers.iter().flat_map(|number| number.to_le_bytes()).collect(),
            is_dense: true,
        }
        .to_bytes()
    }

    #[test]
    fn clouds_of_other_programs_are_read_by_their_fields() {
        let float = |name| (name, PointField::FLOAT32);
        let plain = foreign(&["x", "y", "z"].map(float), 12, &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
        let cloud: PointCloud = again(&plain).expect("a cloud");
        let point = |x, y, z, intensity| CloudPoint { x, y, z, intensity };
        assert_eq!(cloud.points(), [point(1.0, 2.0, 3.0, 0.0), point(4.0, 5.0, 6.0, 0.0)]);
        let fields = [("ring", 4), float("z"), float("y"), float("x"), float("intensity")];
        let cloud: PointCloud = again(&foreign(&fields, 20, &[0.0, 3.0, 2.0, 1.0, 9.0].repeat(2))).expect("a cloud");
        assert_eq!(cloud.points()[1], point(1.0, 2.0, 3.0, 9.0));
        let refused = reason::<PointCloud>(&foreign(&[float("x"), ("y", 8)], 8, &[0.0; 4])).expect_err("no z");
        assert_eq!(refused, "its fields are `x`, `y`; `x`, `y` and `z` must be of type `float32`");
        for (datatype, intensity) in
            [(1, -1.0), (2, 255.0), (3, -1.0), (4, 65_535.0), (5, -1.0), (6, u32::MAX as f32), (7, f32::NAN)]
        {
            let fields = [float("x"), float("y"), float("z"), ("intensity", datatype)];
            let ones = f32::from_bits(u32::MAX);
            let cloud: PointCloud = again(&foreign(&fields, 16, &[1.0, 2.0, 3.0, ones].repeat(2))).expect("a cloud");
            let found = cloud.points()[1].intensity;
            assert!(found == intensity || found.is_nan() && intensity.is_nan(), "{datatype}: {found}");
        }
        let fields = [float("x"), float("y"), float("z"), ("intensity", 9)];
        assert!(reason::<PointCloud>(&foreign(&fields, 16, &[0.0; 8])).is_err(), "of no kind that is known");
        for step in [8, 16, u32::MAX] {
            let wrong = foreign(&["x", "y", "z"].map(float), step, &[0.0; 6]);
            assert!(reason::<PointCloud>(&wrong).is_err_and(|why| why.contains("it has 24 bytes")), "{step}");
        }
    }
}
