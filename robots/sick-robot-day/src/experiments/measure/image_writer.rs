use apex_nodes::image::{GrayImage, Region};
use image::{DynamicImage, Rgb, RgbImage};
use std::{
    fs::{self, File},
    io::BufWriter,
    path::{Path, PathBuf},
};

/// Colour of the box around a detection.
const FOUND: Rgb<u8> = Rgb([255, 40, 40]);

/// Folder for images with boxes around detections, or none.
#[derive(Debug, Default)]
pub struct ImageWriter {
    folder: Option<PathBuf>,
}

impl ImageWriter {
    /// Creates an album in a new or empty folder.
    ///
    /// # Errors
    /// If the folder is not empty, or cannot be created.
    pub fn new(folder: &Path) -> Result<Self, String> {
        let cannot = |e| format!("cannot make the folder {}: {e}", folder.display());
        fs::create_dir_all(folder).map_err(cannot)?;
        if fs::read_dir(folder).map_err(cannot)?.next().is_some() {
            return Err(format!("{} is not empty; name a new or an empty folder", folder.display()));
        }
        Ok(Self { folder: Some(folder.to_owned()) })
    }

    /// Adds an image with a box around the detection. Does nothing without a folder.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn add(&self, name: &str, image: &GrayImage, found: Option<&Region>) -> Result<(), String> {
        if self.folder.is_none() {
            return Ok(());
        }
        let mut picture = DynamicImage::ImageLuma8(image.pixels.clone()).to_rgb8();
        if let Some(region) = found {
            frame(&mut picture, &region.grown(3, image.size()));
        }
        self.save(name, &picture)
    }

    /// Adds an unchanged image. Does nothing without a folder.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn save(&self, name: &str, picture: &RgbImage) -> Result<(), String> {
        let Some(folder) = &self.folder else { return Ok(()) };
        let path = folder.join(format!("{name}.png"));
        let cannot = |e: String| format!("cannot write {}: {e}", path.display());
        let file = File::create_new(&path).map_err(|e| cannot(e.to_string()))?;
        let written = picture.write_to(&mut BufWriter::new(file), image::ImageFormat::Png);
        written.map_err(|e| cannot(e.to_string()))
    }
}

/// Draws the border of a region.
fn frame(picture: &mut RgbImage, region: &Region) {
    let Region { left, top, width, height, .. } = *region;
    for (x, y) in (top..top + height).flat_map(|y| (left..left + width).map(move |x| (x, y))) {
        if x == left || y == top || x + 1 == left + width || y + 1 == top + height {
            picture.put_pixel(x, y, FOUND);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_show_what_was_found_and_overwrite_nothing() {
        let folder = std::env::temp_dir().join(format!("apex-album-{}", std::process::id()));
        let image_writer = ImageWriter::new(&folder).expect("a new folder");
        let image = GrayImage::from(image::ImageBuffer::from_pixel(40, 30, image::Luma([90])));
        let region = Region { left: 10, top: 10, width: 5, height: 5, area: 1 };
        image_writer.add("seen-1.0m", &image, Some(&region)).expect("room for it");
        let file = ImageWriter::new(&folder.join("seen-1.0m.png")).err();
        let refused = [ImageWriter::new(&folder).err(), image_writer.add("seen-1.0m", &image, None).err(), file];
        let written = image::open(folder.join("seen-1.0m.png")).map(|i| i.to_rgb8());
        fs::remove_dir_all(&folder).expect("it is ours");
        let picture = written.expect("a picture");
        assert_eq!((picture[(7, 7)], picture[(8, 8)]), (FOUND, Rgb([90; 3])));
        assert!(refused.iter().all(Option::is_some), "{refused:?}");
    }
}
