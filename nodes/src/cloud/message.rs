//! ROS 2 message of point clouds, which Foxglove and Python can show.

use super::{
    CloudPoint, MAX_POINTS, PointCloud, RingCloud,
    gather::{RingPoint, gather},
};
use crate::scan::message::FRAME;
use apex_messages::{
    Reason, converted,
    sensor_msgs::{PointCloud2, PointField},
    std_msgs::Header,
};
use apex_rt::Time;

/// Fields of a point, each a number of four bytes.
const FIELDS: [&str; 4] = ["x", "y", "z", "intensity"];
/// Fields of a point of a scanner with rings: the last is its time after that of the cloud, in s.
const RING_FIELDS: [&str; 5] = ["x", "y", "z", "intensity", "time"];

/// Fields of the points of scanners with rings, in the clouds of their drivers: after the intensity two names for the
/// ring, and three for the time. It is in s or in ns after that of the cloud, or in s since 1970.
const DRIVERS: [&str; 9] = ["x", "y", "z", "intensity", "ring", "channel", "time", "t", "timestamp"];

/// Message of `height` rows of points, each of some numbers.
fn message<const N: usize>(
    stamp: Time,
    (width, height): (usize, usize),
    names: [&str; N],
    points: impl Iterator<Item = [f32; N]>,
) -> PointCloud2 {
    let step = 4 * N as u32;
    let field = |(i, name): (usize, &&str)| PointField {
        name: (*name).to_owned(),
        offset: 4 * i as u32,
        datatype: PointField::FLOAT32,
        count: 1,
    };
    PointCloud2 {
        header: Header::new(stamp, FRAME),
        height: height as u32,
        width: width as u32,
        fields: names.iter().enumerate().map(field).collect(),
        is_bigendian: false,
        point_step: step,
        row_step: step * width as u32,
        data: points.flatten().flat_map(f32::to_le_bytes).collect(),
        is_dense: false,
    }
}

impl From<&PointCloud> for PointCloud2 {
    fn from(cloud: &PointCloud) -> Self {
        let points = cloud.points().iter().map(|p| [p.x, p.y, p.z, p.intensity]);
        message(cloud.stamp, cloud.size(), FIELDS, points)
    }
}

/// A row is a ring, the uppermost first.
impl From<&RingCloud> for PointCloud2 {
    fn from(cloud: &RingCloud) -> Self {
        let (rings, columns) = (cloud.rings(), cloud.columns());
        let all = (0..rings).flat_map(|ring| (0..columns).map(move |column| (ring, column)));
        let points = all.map(|(ring, column)| {
            let point = cloud.points()[column * rings + ring];
            [point.x, point.y, point.z, point.intensity, cloud.times()[column]]
        });
        message(cloud.stamp, (columns, rings), RING_FIELDS, points)
    }
}

/// The points of a message, whose layout has been checked.
struct Points {
    stamp: Time,
    width: usize,
    height: usize,
    /// Size of a point and of a row, in bytes.
    step: usize,
    row: usize,
    is_bigendian: bool,
    data: Vec<u8>,
}

impl Points {
    /// The points of a message, and the places of some of its fields in a point: the first three have to be there.
    fn of<const N: usize>(message: PointCloud2, names: [&str; N]) -> Result<(Self, [Option<Place>; N]), Reason> {
        let PointCloud2 { header, fields, is_bigendian, data, .. } = message;
        let (height, width) = (message.height as usize, message.width as usize);
        let (step, row) = (message.point_step as usize, message.row_step as usize);
        let places = places(&fields, names)?;
        let points = width.checked_mul(height).filter(|points| *points <= MAX_POINTS);
        points.ok_or_else(|| format!("{width} x {height} points are more than {MAX_POINTS}"))?;
        let is_inside = places.iter().flatten().all(|place| place.end().is_some_and(|end| end <= step));
        let fits =
            width.checked_mul(step).is_some_and(|size| size <= row) && row.checked_mul(height) == Some(data.len());
        if !is_inside || !fits {
            let count = data.len();
            return Err(format!("it has {count} bytes for {height} rows of {row} bytes with {width} x {step}").into());
        }
        let stamp = header.stamp.into();
        Ok((Self { stamp, width, height, step, row, is_bigendian, data }, places))
    }

    /// The numbers of a point at these places, if they are there.
    fn numbers<const N: usize>(&self, row: usize, column: usize, places: [Option<Place>; N]) -> [Option<f64>; N] {
        let point = &self.data[row * self.row + column * self.step..];
        places.map(|place| place.map(|place| place.number(point, self.is_bigendian)))
    }

    /// A point, the number of its ring, and its time in s after that of the cloud, at the places of [`DRIVERS`].
    fn of_ring(&self, row: usize, column: usize, places: [Option<Place>; 9]) -> RingPoint {
        let [x, y, z, intensity, ring, channel, time, t, timestamp] = self.numbers(row, column, places);
        let nanos = t.map(|nanos| nanos * 1e-9);
        let since_epoch = || timestamp.map(|seconds| seconds - self.stamp.as_nanos() as f64 * 1e-9);
        let time = time.or(nanos).or_else(since_epoch).unwrap_or(0.0) as f32;
        RingPoint { point: point([x, y, z, intensity]), ring: ring.or(channel).unwrap_or(0.0) as u32, time }
    }
}

/// A point of these numbers; 0 stands for those that are missing.
fn point(numbers: [Option<f64>; 4]) -> CloudPoint {
    let [x, y, z, intensity] = numbers.map(|number| number.unwrap_or(0.0) as f32);
    CloudPoint { x, y, z, intensity }
}

impl TryFrom<PointCloud2> for PointCloud {
    type Error = Reason;

    fn try_from(message: PointCloud2) -> Result<Self, Reason> {
        let (points, places) = Points::of(message, FIELDS)?;
        let mut cloud = Self::default();
        cloud.reset(points.stamp, (points.width, points.height));
        for (i, to) in cloud.points_mut().iter_mut().enumerate() {
            *to = point(points.numbers(i / points.width, i % points.width, places));
        }
        Ok(cloud)
    }
}

/// A message with a row for each ring is taken as it is: the columns have the times of their uppermost points. In a
/// message with a single row, as many drivers send it, the points say in a field `ring` or `channel` to which ring they
/// belong; the columns are made of their directions. A cloud without times is one of a scanner that stands.
impl TryFrom<PointCloud2> for RingCloud {
    type Error = Reason;

    fn try_from(message: PointCloud2) -> Result<Self, Reason> {
        let (points, places) = Points::of(message, DRIVERS)?;
        let [.., ring, channel, time, _, _] = places;
        if points.height == 1 && ring.or(channel).is_some() {
            let all = (0..points.width).map(|column| points.of_ring(0, column, places)).collect();
            return gather(points.stamp, all).map_err(Reason::from);
        }
        if points.height == 1 && points.width > 1 && time.is_none() {
            let why = "its points are in one row, and have no field `ring`; `PointCloud` takes them";
            return Err(why.into());
        }
        let mut cloud = Self::default();
        cloud.reset(points.stamp, points.height, points.width);
        for column in 0..points.width {
            for ring in 0..points.height {
                let RingPoint { point, time, .. } = points.of_ring(ring, column, places);
                cloud.points_mut()[column * points.height + ring] = point;
                if ring == 0 {
                    cloud.times_mut()[column] = time;
                }
            }
        }
        Ok(cloud)
    }
}

converted!(PointCloud as PointCloud2);
converted!(RingCloud as PointCloud2);

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
    fn number(self, point: &[u8], is_bigendian: bool) -> f64 {
        let bytes = self.end().and_then(|end| point.get(self.offset..end)).unwrap_or_default();
        // The lowest byte first.
        let mut number = [0; 8];
        for (i, to) in number[..bytes.len()].iter_mut().enumerate() {
            *to = bytes[if is_bigendian { bytes.len() - 1 - i } else { i }];
        }
        let bits = u64::from_le_bytes(number);
        match self.datatype {
            PointField::INT8 => f64::from(bits as i8),
            PointField::INT16 => f64::from(bits as i16),
            PointField::INT32 => f64::from(bits as i32),
            PointField::FLOAT32 => f32::from_bits(bits as u32).into(),
            PointField::FLOAT64 => f64::from_bits(bits),
            _ => bits as f64,
        }
    }
}

/// Places of fields of a point. The first three are its coordinates, of type `float32`; others may be any numbers, or
/// missing.
fn places<const N: usize>(fields: &[PointField], names: [&str; N]) -> Result<[Option<Place>; N], Reason> {
    let mut places = [None; N];
    for PointField { name, offset, datatype, count } in fields {
        let fits = |field: &usize| *count == 1 && (*datatype == PointField::FLOAT32 || *field > 2);
        if let Some(field) = names.iter().position(|field| field == name).filter(fits) {
            places[field] = Some(Place { offset: *offset as usize, datatype: *datatype });
        }
    }
    match places[..] {
        [Some(_), Some(_), Some(_), ..] => Ok(places),
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

    #[test]
    fn rings_are_rows_and_columns_keep_their_times() {
        let mut cloud = RingCloud::default();
        for (rings, columns) in [(0, 0), (16, 0), (1, 3), (3, 1), (2, 3)] {
            cloud.reset(Time::from_millis(20), rings, columns);
            for (i, point) in cloud.points_mut().iter_mut().enumerate() {
                *point = CloudPoint { x: i as f32, y: -1.0, z: 0.5, intensity: 9.0 };
            }
            cloud.times_mut().iter_mut().rev().zip(1..).for_each(|(time, at)| *time = -0.01 * at as f32);
            assert_eq!(again(&bytes(&cloud)), Some(cloud.clone()));
        }
        let message: PointCloud2 = again(&bytes(&cloud)).expect("a message");
        assert_eq!((message.height, message.width, message.fields[4].name.as_str()), (2, 3, "time"));
        let first_row = message.data.chunks(20).map(|point| f32::from_le_bytes(point[..4].try_into().expect("x")));
        assert_eq!(first_row.take(3).collect::<Vec<_>>(), [0.0, 2.0, 4.0]);
        assert!(again::<PointCloud>(&bytes(&cloud)).is_some_and(|cloud| cloud.size() == (3, 2)));
    }

    #[test]
    fn points_in_one_row_need_the_numbers_of_their_rings() {
        let float = |name| (name, PointField::FLOAT32);
        let plain = foreign(&["x", "y", "z"].map(float), 12, &[1.0; 6]);
        assert!(reason::<RingCloud>(&plain).is_err_and(|why| why.contains("have no field `ring`")));
        // Two points of ring 0, a degree from each other, with times of all kinds.
        let one = f32::from_bits(1_000_000);
        let places = [[1.0, 0.0, 0.0], [1.0, 1_f32.to_radians().tan(), 0.0]];
        for (name, kind, first, second, apart) in [
            ("time", PointField::FLOAT32, -0.1, -0.099, 0.001),
            ("t", PointField::UINT32, 0.0, one, 0.001),
            ("timestamp", PointField::FLOAT32, 0.0, 0.25, 0.25),
            ("range", PointField::FLOAT32, 0.0, 0.25, 0.0),
        ] {
            let fields = [float("x"), float("y"), float("z"), ("ring", PointField::UINT16), (name, kind)];
            let numbers = [places[0].as_slice(), &[0.0, first], &places[1], &[0.0, second]].concat();
            let turn: RingCloud = again(&foreign(&fields, 20, &numbers)).expect("a turn");
            assert_eq!((turn.rings(), turn.columns()), (1, 360), "{name}");
            assert_eq!((turn.points()[0].x, turn.points()[1].x), (1.0, 1.0), "{name}");
            assert!((turn.times()[1] - turn.times()[0] - apart).abs() < 1e-5, "{name}: {:?}", &turn.times()[..2]);
        }
        let told = foreign(&[float("x"), float("y"), float("z"), ("channel", 4)], 16, &[1.0; 8]);
        assert!(reason::<RingCloud>(&told).is_err_and(|why| why.contains("two points in different directions")));
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
