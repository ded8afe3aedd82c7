use super::ReadError;
use crate::cloud::{CloudPoint, MAX_POINTS, PointCloud};
use apex_rt::Time;
use std::{fs, path::Path};

/// Size of a point, in bytes: four numbers of type `f32`.
const POINT: usize = 16;

/// Reads a point cloud of the KITTI benchmark (`.bin`: x, y, z in m, and reflectance from 0 to 1, for each point as
/// little-endian `f32`), as a cloud with a single row.
///
/// The points are in the frame of the scanner, an HDL-64E, with the axes of a robot, and corrected for its motion. They
/// are not those of a turn with rings: the file does not say which laser and which firing a point belongs to, and
/// leaves out directions without a measurement.
///
/// # Errors
/// If the file cannot be read, has no points, more than [`MAX_POINTS`], or a part of one.
pub fn read_kitti(path: impl AsRef<Path>) -> Result<PointCloud, ReadError> {
    let path = path.as_ref();
    let length = fs::metadata(path).map_err(|error| ReadError::open(path, error))?.len();
    let most = (MAX_POINTS * POINT) as u64;
    if length > most {
        return Err(ReadError::open(
            path,
            format_args!("it has {length} bytes, and at most {most}: {MAX_POINTS} points"),
        ));
    }
    let bytes = fs::read(path).map_err(|error| ReadError::open(path, error))?;
    let (points, rest) = bytes.as_chunks::<POINT>();
    if points.is_empty() || !rest.is_empty() {
        let length = bytes.len();
        let why =
            format_args!("it has {length} bytes, and not some points of {POINT} bytes: it is cut off, or another file");
        return Err(ReadError::open(path, why));
    }
    let mut cloud = PointCloud::default();
    cloud.reset(Time::ZERO, (points.len(), 1));
    cloud.points_mut().iter_mut().zip(points).for_each(|(out, bytes)| *out = point(bytes));
    Ok(cloud)
}

fn point(bytes: &[u8; POINT]) -> CloudPoint {
    let (numbers, _) = bytes.as_chunks::<4>();
    let number = |i: usize| numbers.get(i).map_or(f32::NAN, |bytes| f32::from_le_bytes(*bytes));
    CloudPoint { x: number(0), y: number(1), z: number(2), intensity: number(3) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_are_read_and_parts_of_them_refused() {
        let path = std::env::temp_dir().join(format!("apex-kitti-{}.bin", std::process::id()));
        let bytes: Vec<u8> =
            [1.0, -2.0, 3.5, 0.25, f32::NAN, 0.0, 0.0, 0.0].into_iter().flat_map(f32::to_le_bytes).collect();
        fs::write(&path, &bytes).expect("a temporary file");
        let cloud = read_kitti(&path).expect("a cloud");
        assert_eq!((cloud.size(), cloud.points()[1].is_measured()), ((2, 1), false));
        assert_eq!(cloud.points()[0], CloudPoint { x: 1.0, y: -2.0, z: 3.5, intensity: 0.25 });
        for length in [0, 15, 31] {
            fs::write(&path, &bytes[..length]).expect("a temporary file");
            let message = read_kitti(&path).expect_err("a part").message;
            assert!(message.starts_with(&format!("it has {length} bytes, and not some points")), "{message}");
        }
        assert!(read_kitti("/nowhere/at/all.bin").is_err());
    }
}
