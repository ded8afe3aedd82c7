use super::canvas::{BLACK, Canvas, Colour, SMALL, Spot, text_width};
use apex_nodes::image::{GrayImage, Region};
use image::{Rgb, RgbImage};

/// Colour of detections.
const FOUND: Colour = Rgb([255, 40, 40]);
/// Half the width of a cross, in pixels.
const CROSS: f32 = 12.0;

/// Camera image with its detections.
#[derive(Debug, Clone, PartialEq)]
pub struct Frame {
    /// Title of the image.
    pub name: String,
    /// Image of the camera.
    pub image: GrayImage,
    /// Detections.
    pub marks: Vec<Mark>,
}

/// Detection in an image.
#[derive(Debug, Clone, PartialEq)]
pub enum Mark {
    /// A point, in pixels.
    Cross([f32; 2]),
    /// Region of an object, and its label.
    Box(Region, String),
}

impl Frame {
    /// Draws the image with its title and all detections.
    pub(super) fn draw(&self) -> RgbImage {
        let mut canvas = Canvas::over(&self.image);
        for mark in &self.marks {
            match mark {
                Mark::Cross(centre) => draw_cross(&mut canvas, *centre),
                Mark::Box(region, text) => draw_box(&mut canvas, region, text),
            }
        }
        canvas.label([12.0 + 0.5 * text_width(&self.name, SMALL), 16.0], SMALL, &self.name, BLACK);
        canvas.finish()
    }
}

/// Draws a cross. The centre of the first pixel is (0, 0) in an image, and (0.5, 0.5) on a canvas.
fn draw_cross(canvas: &mut Canvas, centre: [f32; 2]) {
    let [x, y]: Spot = centre.map(|x| x + 0.5);
    canvas.line(&[[x - CROSS, y], [x + CROSS, y]], 2.0, FOUND);
    canvas.line(&[[x, y - CROSS], [x, y + CROSS]], 2.0, FOUND);
}

/// Draws a frame around a region, with its label above.
fn draw_box(canvas: &mut Canvas, region: &Region, text: &str) {
    let (left, top) = (region.left as f32 - 2.0, region.top as f32 - 2.0);
    let (right, bottom) = (left + region.width as f32 + 4.0, top + region.height as f32 + 4.0);
    canvas.line(&[[left, top], [right, top], [right, bottom], [left, bottom], [left, top]], 2.0, FOUND);
    if !text.is_empty() {
        canvas.label([left + 0.5 * text_width(text, SMALL), top - 10.0], SMALL, text, FOUND);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::experiments::run_report::canvas::WHITE;
    use image::{ImageBuffer, Luma};

    #[test]
    fn marks_are_where_things_were_detected() {
        let image = GrayImage::from(ImageBuffer::from_pixel(120, 90, Luma([90])));
        let region = Region { left: 20, top: 50, width: 30, height: 20, area: 1 };
        let marks = vec![Mark::Cross([80.0, 40.0]), Mark::Box(region, "sign 3".to_owned())];
        let picture = Frame { name: "search".to_owned(), image, marks }.draw();
        assert_eq!(picture.dimensions(), (120, 90));
        for mark in [(80, 40), (70, 40), (80, 50), (18, 60), (51, 60), (30, 71)] {
            assert_eq!(picture[mark], FOUND, "{mark:?}");
        }
        for bare in [(70, 30), (30, 60), (110, 80)] {
            assert_eq!(picture[bare], Rgb([90; 3]), "{bare:?}");
        }
        let label = |rows: std::ops::Range<u32>| rows.clone().any(|y| (10..60).any(|x| picture[(x, y)] == WHITE));
        assert!(label(8..24) && label(34..46));
    }
}
