//! ROS 2 and Foxglove messages of maps, which Foxglove and Python can show.

use super::{Grid, Occupancy, Raster};
use crate::scan::{
    Pose2,
    message::{FRAME, pose_definition, read_pose, write_pose},
};
use apex_rt::{
    Time,
    record::{
        Message, Reason,
        cdr::{Reader, Writer},
    },
};

/// Values of the cells of an occupancy grid: −1 if unknown, otherwise the probability of an obstacle in %. Of other
/// programs, cells from 65 on are occupied and those up to 19 free, as map servers of ROS have it.
const UNKNOWN: i8 = -1;
const FREE: i8 = 0;
const MOSTLY_FREE: i8 = 19;
const MOSTLY_OCCUPIED: i8 = 65;
const OCCUPIED: i8 = 100;
/// Angle up to which an origin is along the axes, in rad.
const LEVEL: f32 = 1e-6;

impl Message for Grid<Occupancy> {
    const NAME: &'static str = "nav_msgs/msg/OccupancyGrid";
    const DEFINITION: &'static str = concat!(
        "\
std_msgs/Header header
nav_msgs/MapMetaData info
int8[] data
================================================================================
MSG: nav_msgs/MapMetaData
builtin_interfaces/Time map_load_time
float32 resolution
uint32 width
uint32 height
geometry_msgs/Pose origin",
        pose_definition!()
    );

    fn write(&self, message: &mut Writer<'_>) {
        let Raster { resolution, width, height, .. } = *self.raster();
        message.header(Time::ZERO, FRAME);
        // The load time is not used.
        message.i32(0);
        message.u32(0);
        message.f32(resolution);
        message.u32(width as u32);
        message.u32(height as u32);
        write_pose(&origin(self.raster()), message);
        message.u32(self.cells().len() as u32);
        for cell in self.cells() {
            message.i8(match cell {
                Occupancy::Unknown => UNKNOWN,
                Occupancy::Free => FREE,
                Occupancy::Occupied => OCCUPIED,
            });
        }
    }

    fn read(message: &mut Reader<'_>) -> Result<Self, Reason> {
        message.header()?;
        let (_, _) = (message.i32()?, message.u32()?);
        let (resolution, width, height) = (message.f32()?, message.u32()?, message.u32()?);
        let origin = read_pose(message)?;
        if origin.theta.abs() > LEVEL {
            let turn = origin.theta.to_degrees();
            return Err(format!("its origin is turned by {turn:.1}°: only maps along the axes can be read").into());
        }
        let raster = raster(&origin, resolution, width, height);
        let count = message.u32()?;
        let cells = message.bytes(count as usize)?.iter().map(|byte| match *byte as i8 {
            UNKNOWN => Ok(Occupancy::Unknown),
            FREE..=MOSTLY_FREE => Ok(Occupancy::Free),
            MOSTLY_OCCUPIED..=OCCUPIED => Ok(Occupancy::Occupied),
            between if (FREE..OCCUPIED).contains(&between) => Ok(Occupancy::Unknown),
            other => Err(format!("a cell is {other}, not in -1..=100")),
        });
        grid(raster, cells.collect::<Result<_, _>>()?)
    }
}

/// Number of bytes per cell of a map of numbers.
const STRIDE: u32 = 4;
/// Number type of the cells.
const FLOAT32: u8 = 7;

impl Message for Grid<f32> {
    const NAME: &'static str = "foxglove_msgs/msg/Grid";
    const DEFINITION: &'static str = concat!(
        "\
builtin_interfaces/Time timestamp
string frame_id
geometry_msgs/Pose pose
uint32 column_count
foxglove_msgs/Vector2 cell_size
uint32 row_stride
uint32 cell_stride
foxglove_msgs/PackedElementField[] fields
uint8[] data
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
================================================================================
MSG: foxglove_msgs/Vector2
float64 x
float64 y
================================================================================
MSG: foxglove_msgs/PackedElementField
uint8 UNKNOWN=0
uint8 UINT8=1
uint8 INT8=2
uint8 UINT16=3
uint8 INT16=4
uint8 UINT32=5
uint8 INT32=6
uint8 FLOAT32=7
uint8 FLOAT64=8
string name
uint32 offset
uint8 type",
        pose_definition!()
    );

    fn write(&self, message: &mut Writer<'_>) {
        let Raster { resolution, width, height, .. } = *self.raster();
        // Time and frame have the same bytes as a header.
        message.header(Time::ZERO, FRAME);
        write_pose(&origin(self.raster()), message);
        message.u32(width as u32);
        message.f64(f64::from(resolution));
        message.f64(f64::from(resolution));
        // The message stores the row stride in bytes. Without columns, the number of rows is stored in its place.
        message.u32(if width == 0 { height as u32 } else { STRIDE * width as u32 });
        message.u32(STRIDE);
        message.u32(1);
        message.text("value");
        message.u32(0);
        message.u8(FLOAT32);
        message.u32(STRIDE * self.cells().len() as u32);
        self.cells().iter().flat_map(|cell| cell.to_le_bytes()).for_each(|byte| message.u8(byte));
    }

    fn read(message: &mut Reader<'_>) -> Result<Self, Reason> {
        message.header()?;
        let corner = read_pose(message)?;
        let (width, resolution, _) = (message.u32()?, message.f64()? as f32, message.f64()?);
        let (row, cell, fields) = (message.u32()?, message.u32()?, message.u32()?);
        let (_, offset, kind, bytes) = (message.text()?, message.u32()?, message.u8()?, message.u32()?);
        if (cell, fields, offset, kind) != (STRIDE, 1, 0, FLOAT32) {
            return Err("its cells are not a single `float32`".into());
        }
        let height = if width == 0 { row } else { bytes.checked_div(row).ok_or("its rows have no bytes")? };
        let (cells, _) = message.bytes(bytes as usize)?.as_chunks();
        grid(raster(&corner, resolution, width, height), cells.iter().map(|cell| f32::from_le_bytes(*cell)).collect())
    }
}

/// Pose of the corner of a raster. Its sides are parallel to the axes.
fn origin(raster: &Raster) -> Pose2 {
    Pose2::new(raster.corner.x, raster.corner.y, 0.0)
}

fn raster(origin: &Pose2, resolution: f32, width: u32, height: u32) -> Raster {
    Raster { corner: origin.position(), resolution, width: width as usize, height: height as usize }
}

/// Grid with these cells.
fn grid<T: Copy + Default>(raster: Raster, cells: Vec<T>) -> Result<Grid<T>, Reason> {
    if raster.width.checked_mul(raster.height) != Some(cells.len()) {
        return Err(format!("it has {} cells for {} x {}", cells.len(), raster.width, raster.height).into());
    }
    let mut grid = Grid::new(raster, T::default()).map_err(|error| error.to_string())?;
    grid.cells_mut().copy_from_slice(&cells);
    Ok(grid)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        map::{Octagon, Sign, Signs, Station},
        scan::{
            Point2,
            message::tests::{again, bytes, reason},
        },
    };
    use apex_rt::record::Codec;

    fn filled<T: Copy + Default>(width: usize, height: usize, values: &[T]) -> Grid<T> {
        let raster = Raster { corner: Point2::new(-1.7, 0.3), resolution: 0.05, width, height };
        let mut grid = Grid::new(raster, T::default()).expect("small");
        grid.cells_mut().iter_mut().zip(values.iter().cycle()).for_each(|(cell, value)| *cell = *value);
        grid
    }

    #[test]
    fn maps_come_back() {
        use Occupancy::{Free, Occupied, Unknown};
        for (width, height) in [(4, 3), (1, 1), (0, 0), (0, 5), (7, 0)] {
            let map = filled(width, height, &[Free, Occupied, Unknown, Free, Unknown]);
            assert_eq!(again(&bytes(&map)), Some(map));
            let costs = filled(width, height, &[0.1_f32, f32::INFINITY, -2.0]);
            assert_eq!(again(&bytes(&costs)), Some(costs));
        }
        assert_eq!(again(&bytes(&Grid::<f32>::default())), Some(Grid::<f32>::default()));
    }

    #[test]
    fn numbers_keep_their_bits() {
        let odd = [f32::from_bits(0x7fc0_1234), -0.0, f32::NEG_INFINITY, f32::MIN_POSITIVE / 2.0];
        let read: Grid<f32> = again(&bytes(&filled(2, 2, &odd))).expect("what was written");
        assert_eq!(read.cells().iter().map(|c| c.to_bits()).collect::<Vec<_>>(), odd.map(f32::to_bits));
    }

    #[test]
    fn a_part_of_a_map_is_none() {
        let (map, costs) = (bytes(&filled(3, 3, &[Occupancy::Free])), bytes(&filled(3, 3, &[1.0_f32])));
        assert!((0..map.len()).all(|length| again::<Grid<Occupancy>>(&map[..length]).is_none()));
        assert!((0..costs.len()).all(|length| again::<Grid<f32>>(&costs[..length]).is_none()));
    }

    #[test]
    fn what_is_found_in_a_map_comes_back() {
        fn again<T: Clone>(codec: Option<Codec<T>>, token: &T) -> Option<T> {
            let (codec, mut bytes) = (codec?, vec![]);
            (codec.write)(token, &mut bytes).then(|| (codec.read)(&bytes).ok())?
        }
        let pose = Pose2::new(1.0, 2.0, 0.5);
        let mut sign = Sign::new(3, &pose);
        sign.add(&Pose2::new(1.1, 1.9, 0.6));
        let signs = Signs::from([sign, Sign::new(4, &pose)]);
        assert_eq!(again(apex_rt::__codec!(Signs), &signs), Some(signs));
        let octagon = Octagon { centre: Point2::new(0.1, 0.2), apothem: 1.4, theta: 0.3 };
        assert_eq!(again(apex_rt::__codec!(Octagon), &octagon), Some(octagon));
        let stations = heapless::Vec::from([Station { pose, free: true }, Station { pose, free: false }]);
        assert_eq!(again(apex_rt::__codec!(heapless::Vec<Station, 4>), &stations), Some(stations));
    }

    #[test]
    fn what_no_map_says_is_none() {
        let mut map = bytes(&filled(3, 3, &[Occupancy::Free]));
        *map.last_mut().expect("a cell") = 101;
        assert_eq!(reason::<Grid<Occupancy>>(&map), Err("a cell is 101, not in -1..=100".into()));
        assert_eq!(again::<Grid<f32>>(&map), None);
    }

    #[test]
    fn probabilities_of_other_programs_become_cells() {
        use Occupancy::{Free, Occupied, Unknown};
        let mut map = bytes(&filled(7, 1, &[Free]));
        let start = map.len() - 7;
        map[start..].copy_from_slice(&[255, 1, 19, 20, 64, 65, 99]);
        let read: Grid<Occupancy> = again(&map).expect("a map");
        assert_eq!(read.cells(), [Unknown, Free, Free, Unknown, Unknown, Occupied, Occupied]);
    }

    #[test]
    fn a_turned_map_is_refused() {
        let mut turned = vec![];
        let mut message = Writer::new(&mut turned);
        message.header(Time::ZERO, "map");
        (0..2).for_each(|_| message.u32(0));
        message.f32(0.05);
        (0..2).for_each(|_| message.u32(1));
        write_pose(&Pose2::new(-1.0, -2.0, 0.5), &mut message);
        message.u32(1);
        message.i8(0);
        let refused = reason::<Grid<Occupancy>>(&turned).expect_err("it is turned");
        assert_eq!(refused, "its origin is turned by 28.6°: only maps along the axes can be read");
    }
}
