//! Inputs of the kernels, as files that all processes read: an image `NAME` of bytes, with its size in `NAME.size`, and
//! points as numbers of 32 bits.

use apex_nodes::{
    cloud::{Columns, VoxelGrid, Voxels},
    image::{AdaptiveThreshold, Edges, GrayImage, Region},
    math::Random,
};
use apex_rt::{Construct, Out};
use image::{ImageBuffer, Luma, Rgb, imageops::FilterType};
use std::{fs, path::Path};

/// Points of a cloud: as many as a turn of a scanner with 16 rings has.
const POINTS: usize = 28_800;
/// Things of the cloud.
const THINGS: usize = 150;

/// Writes all inputs. Those of recordings are left out if the recordings are missing.
pub fn write(folder: &Path) -> Result<(), String> {
    for (name, size) in [("large", (640, 480)), ("small", (320, 240))] {
        let image = picture(&mut Random::new(5), size);
        write_image(folder, name, &image)?;
        write_image(folder, &format!("{name}_binary"), &binary(&image))?;
        write_image(folder, &format!("{name}_edges"), &edges(&image))?;
    }
    let cloud = cloud(&mut Random::new(7));
    write_points(folder, "cloud", &cloud)?;
    write_points(folder, "voxels", &voxels(&columns(&cloud)).voxels.iter().map(|v| v.mean).collect::<Vec<_>>())?;
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/data");
    if let Ok(bytes) = fs::read(data.join("persons_image/frames/f0000.jpg")) {
        fs::write(folder.join("photo.jpg"), &bytes).map_err(|e| e.to_string())?;
        let photo = image::load_from_memory(&bytes).map_err(|e| e.to_string())?;
        let photo = photo.resize_exact(640, 480, FilterType::Triangle);
        let photo = photo.to_luma8();
        let color = |x, y| {
            let gray = photo[(x, y)].0[0];
            Rgb([gray, 255 - gray, 60 + gray / 2])
        };
        let colors = ImageBuffer::from_fn(640, 480, color);
        colors.save(folder.join("colors.jpg")).map_err(|e| e.to_string())?;
        write_image(folder, "photo", &GrayImage::from(photo))?;
    }
    if let Ok(code) = image::open(data.join("barcodes/code128-1/1.png")) {
        write_image(folder, "code128", &GrayImage::from(code.to_luma8()))?;
    }
    Ok(())
}

fn write_image(folder: &Path, name: &str, image: &GrayImage) -> Result<(), String> {
    let (width, height) = image.pixels.dimensions();
    let written = fs::write(folder.join(name), image.pixels.as_raw());
    let written = written.and_then(|()| fs::write(folder.join(format!("{name}.size")), format!("{width} {height}")));
    written.map_err(|e| format!("{}: {e}", folder.display()))
}

/// Reads an image; `None` if there is none.
pub fn read(folder: &Path, name: &str) -> Option<GrayImage> {
    let size = fs::read_to_string(folder.join(format!("{name}.size"))).ok()?;
    let (width, height) = size.split_once(' ')?;
    let bytes = fs::read(folder.join(name)).ok()?;
    Some(ImageBuffer::from_raw(width.parse().ok()?, height.parse().ok()?, bytes)?.into())
}

fn write_points(folder: &Path, name: &str, points: &[[f32; 3]]) -> Result<(), String> {
    let bytes: Vec<u8> = points.as_flattened().iter().flat_map(|c| c.to_le_bytes()).collect();
    fs::write(folder.join(name), bytes).map_err(|e| format!("{}: {e}", folder.display()))
}

/// Reads the cloud; `None` if there is none.
pub fn read_cloud(folder: &Path) -> Option<Columns> {
    let bytes = fs::read(folder.join("cloud")).ok()?;
    let numbers: Vec<f32> = bytes.as_chunks().0.iter().map(|c| f32::from_le_bytes(*c)).collect();
    Some(columns(numbers.as_chunks().0))
}

/// Upright things of the size of a person, on a field of 60 m × 60 m.
fn cloud(random: &mut Random) -> Vec<[f32; 3]> {
    let mut points = vec![];
    for _ in 0..THINGS {
        let [x, y] = [(); 2].map(|()| random.uniform(-30.0, 30.0));
        points.extend((0..POINTS / THINGS).map(|_| {
            let [dx, dy] = [(); 2].map(|()| random.uniform(-0.2, 0.2));
            [x + dx, y + dy, random.uniform(0.0, 1.8)]
        }));
    }
    points
}

fn columns(points: &[[f32; 3]]) -> Columns {
    let of = |axis: usize| points.iter().map(|point| point[axis]).collect();
    let intensity = vec![0.0; points.len()];
    Columns { height: 16, x: of(0), y: of(1), z: of(2), intensity, ..Columns::default() }
}

/// Grid that the robot that follows a runner has.
pub fn grid() -> VoxelGrid {
    VoxelGrid::construct((0.2, 35.0))
}

/// Voxels of a cloud.
pub fn voxels(columns: &Columns) -> Voxels {
    let mut out = Out::new();
    grid().process(columns, None, &mut out);
    out.get().cloned().unwrap_or_default()
}

/// Discs and bars with noise, on a ground whose light changes.
pub fn picture(random: &mut Random, (width, height): (u32, u32)) -> GrayImage {
    let scale = width as f32 / 640.0;
    let discs: Vec<[f32; 3]> = (0..40)
        .map(|_| [random.uniform(0.0, width as f32), random.uniform(0.0, height as f32), random.uniform(2.0, 20.0)])
        .collect();
    ImageBuffer::from_fn(width, height, |x, y| {
        let (x, y) = (x as f32, y as f32);
        let disc = discs.iter().any(|[u, v, radius]| (x - u).hypot(y - v) < radius * scale);
        let bar = (((x + 0.4 * y) / (37.0 * scale)) as u32).is_multiple_of(5);
        let light = 60.0 + 150.0 * x / width as f32;
        let shade = if disc {
            -50.0
        } else if bar {
            30.0
        } else {
            0.0
        };
        Luma([(light + shade + random.normal(6.0)).clamp(0.0, 255.0) as u8])
    })
    .into()
}

fn binary(image: &GrayImage) -> GrayImage {
    let mut out = Out::new();
    AdaptiveThreshold::construct((15, 10, true)).process(image, &mut out);
    out.get().cloned().unwrap_or_default()
}

fn edges(image: &GrayImage) -> GrayImage {
    let mut out = Out::new();
    Edges::construct((150.0, 60.0, 0)).process(image, &[whole(image)].into(), &mut out);
    out.get().cloned().unwrap_or_default()
}

/// Region of the whole image.
pub fn whole(image: &GrayImage) -> Region {
    let (width, height) = image.size();
    Region { width, height, ..Region::default() }
}
