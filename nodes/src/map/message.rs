//! ROS 2 and Foxglove messages of maps, which Foxglove and Python can show.

use super::{Grid, Occupancy, Raster, check_level};
use crate::scan::{Pose2, message::FRAME};
use apex_messages::{
    Reason, builtin_interfaces, converted,
    foxglove_msgs::{self, PackedElementField, Vector2},
    geometry_msgs::Pose,
    nav_msgs::{MapMetaData, OccupancyGrid},
    std_msgs::Header,
};
use apex_rt::Time;

/// Values of the cells of an occupancy grid: −1 if unknown, otherwise the probability of an obstacle in %.
const UNKNOWN: i8 = -1;
const FREE: i8 = 0;
const OCCUPIED: i8 = 100;

impl From<&Grid<Occupancy>> for OccupancyGrid {
    fn from(grid: &Grid<Occupancy>) -> Self {
        let Raster { resolution, width, height, .. } = *grid.raster();
        let cell = |cell: &Occupancy| match cell {
            Occupancy::Unknown => UNKNOWN,
            Occupancy::Free => FREE,
            Occupancy::Occupied | Occupancy::Low => OCCUPIED,
        };
        Self {
            header: Header::new(Time::ZERO, FRAME),
            info: MapMetaData {
                map_load_time: builtin_interfaces::Time::default(),
                resolution,
                width: width as u32,
                height: height as u32,
                origin: origin(grid.raster()),
            },
            data: grid.cells().iter().map(cell).collect(),
        }
    }
}

impl TryFrom<OccupancyGrid> for Grid<Occupancy> {
    type Error = Reason;

    fn try_from(OccupancyGrid { info, data, .. }: OccupancyGrid) -> Result<Self, Reason> {
        let origin = Pose2::from(&info.origin);
        check_level(origin.theta)?;
        let cells = data.into_iter().map(|cell| match cell {
            UNKNOWN => Ok(Occupancy::Unknown),
            FREE..=OCCUPIED => Ok(Occupancy::of_percent(f32::from(cell))),
            other => Err(format!("a cell is {other}, not in -1..=100")),
        });
        grid(raster(&origin, info.resolution, info.width, info.height), cells.collect::<Result<_, _>>()?)
    }
}

converted!(Grid<Occupancy> as OccupancyGrid);

/// Number of bytes per cell of a map of numbers.
const STRIDE: u32 = 4;

impl From<&Grid<f32>> for foxglove_msgs::Grid {
    fn from(grid: &Grid<f32>) -> Self {
        let Raster { resolution, width, height, .. } = *grid.raster();
        let side = f64::from(resolution);
        Self {
            timestamp: builtin_interfaces::Time::default(),
            frame_id: FRAME.to_owned(),
            pose: origin(grid.raster()),
            column_count: width as u32,
            cell_size: Vector2 { x: side, y: side },
            // The message stores the row stride in bytes. Without columns, the number of rows is stored in its place.
            row_stride: if width == 0 { height as u32 } else { STRIDE * width as u32 },
            cell_stride: STRIDE,
            fields: vec![PackedElementField {
                name: "value".to_owned(),
                offset: 0,
                r#type: PackedElementField::FLOAT32,
            }],
            data: grid.cells().iter().flat_map(|cell| cell.to_le_bytes()).collect(),
        }
    }
}

impl TryFrom<foxglove_msgs::Grid> for Grid<f32> {
    type Error = Reason;

    fn try_from(message: foxglove_msgs::Grid) -> Result<Self, Reason> {
        let foxglove_msgs::Grid { pose, column_count: width, cell_size, row_stride: row, data, .. } = message;
        let is_one_number =
            matches!(&message.fields[..], [PackedElementField { offset: 0, r#type: PackedElementField::FLOAT32, .. }]);
        if message.cell_stride != STRIDE || !is_one_number {
            return Err("its cells are not a single `float32`".into());
        }
        let bytes = data.len() as u32;
        let height = if width == 0 { row } else { bytes.checked_div(row).ok_or("its rows have no bytes")? };
        let (cells, _) = data.as_chunks();
        let raster = raster(&(&pose).into(), cell_size.x as f32, width, height);
        grid(raster, cells.iter().map(|cell| f32::from_le_bytes(*cell)).collect())
    }
}

converted!(Grid<f32> as foxglove_msgs::Grid);

/// Pose of the corner of a raster. Its sides are parallel to the axes.
fn origin(raster: &Raster) -> Pose {
    (&Pose2::new(raster.corner.x, raster.corner.y, 0.0)).into()
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
    use apex_messages::Message as _;
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
        let mut message = OccupancyGrid::from(&filled(1, 1, &[Occupancy::Free]));
        message.info.origin = (&Pose2::new(-1.0, -2.0, 0.5)).into();
        let turned = message.to_bytes();
        let refused = reason::<Grid<Occupancy>>(&turned).expect_err("it is turned");
        assert_eq!(refused, "its origin is turned by 28.6°: only maps along the axes can be read");
    }
}
