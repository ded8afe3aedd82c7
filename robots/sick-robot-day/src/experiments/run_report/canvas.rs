use crate::world::distance;
use apex_nodes::image::GrayImage;
use image::{DynamicImage, Rgb, RgbImage};
use noto_sans_mono_bitmap::{FontWeight, RasterHeight, get_raster, get_raster_width};

/// A colour.
pub type Colour = Rgb<u8>;

/// Position on a canvas, in pixels to the right and down from the upper left corner.
pub type Spot = [f32; 2];

/// Size of a text: the height of a line in pixels.
pub use noto_sans_mono_bitmap::RasterHeight::{Size16 as SMALL, Size24 as LARGE};

pub const WHITE: Colour = Rgb([255; 3]);
pub const BLACK: Colour = Rgb([25; 3]);

/// Anti-aliased drawing canvas. Shapes are clipped to it.
#[derive(Debug, Clone)]
pub struct Canvas(RgbImage);

impl Canvas {
    /// Creates a canvas of one colour.
    pub fn new(width: u32, height: u32, colour: Colour) -> Self {
        Self(RgbImage::from_pixel(width, height, colour))
    }

    /// Creates a canvas with an image on it.
    pub fn over(image: &GrayImage) -> Self {
        Self(DynamicImage::ImageLuma8(image.pixels.clone()).to_rgb8())
    }

    /// The finished picture.
    pub fn finish(self) -> RgbImage {
        self.0
    }

    /// Number of columns and rows.
    pub fn size(&self) -> (u32, u32) {
        self.0.dimensions()
    }

    /// Sets the colour of each pixel by a function of its centre.
    pub fn paint(&mut self, colour: impl Fn(Spot) -> Colour) {
        self.0.enumerate_pixels_mut().for_each(|(x, y, pixel)| *pixel = colour([x as f32 + 0.5, y as f32 + 0.5]));
    }

    /// Draws a line through points.
    pub fn line(&mut self, points: &[Spot], width: f32, colour: Colour) {
        for ends in points.windows(2) {
            let (a, b) = (ends[0], ends[1]);
            let low = [0, 1].map(|i| a[i].min(b[i]) - width);
            let high = [0, 1].map(|i| a[i].max(b[i]) + width);
            self.shape(low, high, colour, |spot| distance(spot, [a, b]) - 0.5 * width);
        }
    }

    /// Draws a filled circle.
    pub fn disc(&mut self, centre: Spot, radius: f32, colour: Colour) {
        let (low, high) = (centre.map(|x| x - radius - 1.0), centre.map(|x| x + radius + 1.0));
        self.shape(low, high, colour, |spot| (spot[0] - centre[0]).hypot(spot[1] - centre[1]) - radius);
    }

    /// Draws a filled box.
    pub fn block(&mut self, low: Spot, high: Spot, colour: Colour) {
        self.shape(low.map(|x| x - 1.0), high.map(|x| x + 1.0), colour, |spot| {
            let beyond = |i: usize| (low[i] - spot[i]).max(spot[i] - high[i]);
            beyond(0).max(beyond(1))
        });
    }

    /// Writes a text. `at` is the left end of its middle line.
    pub fn text(&mut self, at: Spot, size: RasterHeight, text: &str, colour: Colour) {
        if !at.iter().all(|x| x.is_finite()) {
            return;
        }
        let top = at[1] - 0.5 * size.val() as f32;
        for (i, character) in text.chars().enumerate() {
            let glyph = get_raster(character, FontWeight::Regular, size);
            let glyph = glyph.or_else(|| get_raster('?', FontWeight::Regular, size));
            let left = at[0] + i as f32 * advance(size);
            for (y, row) in glyph.iter().flat_map(|glyph| glyph.rows().enumerate()) {
                for (x, ink) in row.iter().enumerate() {
                    let (x, y) = ((left + x as f32).round() as i64, (top + y as f32).round() as i64);
                    self.blend(x, y, f32::from(*ink) / 255.0, colour);
                }
            }
        }
    }

    /// Writes a text on a white background. `at` is its middle.
    pub fn label(&mut self, at: Spot, size: RasterHeight, text: &str, colour: Colour) {
        let half = [0.5 * text_width(text, size), 0.5 * size.val() as f32];
        self.block([at[0] - half[0] - 2.0, at[1] - half[1]], [at[0] + half[0] + 2.0, at[1] + half[1]], WHITE);
        self.text([at[0] - half[0], at[1]], size, text, colour);
    }

    /// Draws a shape, where `outside`, the distance from it in pixels, is negative. The shape is inside `low` and
    /// `high`.
    fn shape(&mut self, low: Spot, high: Spot, colour: Colour, outside: impl Fn(Spot) -> f32) {
        let (width, height) = self.size();
        // Casts saturate to the nearest pixel.
        let [left, top] = low.map(|x| x as u32);
        let (right, bottom) = ((high[0].ceil() as u32).min(width), (high[1].ceil() as u32).min(height));
        for (x, y) in (top..bottom).flat_map(|y| (left..right).map(move |x| (x, y))) {
            let ink = 0.5 - outside([x as f32 + 0.5, y as f32 + 0.5]);
            self.blend(x.into(), y.into(), ink.clamp(0.0, 1.0), colour);
        }
    }

    /// Mixes a share of a colour into a pixel. Does nothing if the share is NaN.
    fn blend(&mut self, x: i64, y: i64, share: f32, colour: Colour) {
        let (Ok(x), Ok(y)) = (u32::try_from(x), u32::try_from(y)) else { return };
        let Some(pixel) = self.0.get_pixel_mut_checked(x, y).filter(|_| share > 0.0) else { return };
        for (old, new) in pixel.0.iter_mut().zip(colour.0) {
            *old = (f32::from(*old) + share * (f32::from(new) - f32::from(*old))).round() as u8;
        }
    }
}

/// Width of a text, in pixels.
pub fn text_width(text: &str, size: RasterHeight) -> f32 {
    text.chars().count() as f32 * advance(size)
}

fn advance(size: RasterHeight) -> f32 {
    get_raster_width(FontWeight::Regular, size) as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    const RED: Colour = Rgb([255, 0, 0]);

    fn drawn(draw: impl Fn(&mut Canvas)) -> RgbImage {
        let mut canvas = Canvas::new(40, 30, WHITE);
        draw(&mut canvas);
        canvas.finish()
    }

    #[test]
    fn shapes_are_where_they_should_be() {
        let line = drawn(|canvas| canvas.line(&[[5.0, 10.0], [20.0, 10.0], [20.0, 25.0]], 4.0, RED));
        assert_eq!([(5, 9), (15, 11), (20, 20)].map(|at| line[at]), [RED; 3]);
        assert_eq!([(15, 13), (15, 6), (25, 20)].map(|at| line[at]), [WHITE; 3]);
        let disc = drawn(|canvas| canvas.disc([10.0, 10.0], 5.0, RED));
        assert_eq!([disc[(10, 10)], disc[(6, 10)], disc[(5, 5)]], [RED, RED, WHITE]);
        let block = drawn(|canvas| canvas.block([3.0, 4.0], [8.0, 6.0], RED));
        assert_eq!(block.pixels().filter(|pixel| **pixel == RED).count(), 10);
    }

    #[test]
    fn edges_are_smooth() {
        let edge = drawn(|canvas| canvas.block([3.5, 4.0], [8.0, 6.0], RED))[(3, 5)];
        assert_eq!(edge, Rgb([255, 128, 128]));
    }

    #[test]
    fn nothing_is_drawn_outside_or_nowhere() {
        let odd = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -1e9, 1e9];
        for (x, y) in odd.iter().flat_map(|x| odd.iter().map(move |y| (*x, *y))) {
            let picture = drawn(|canvas| {
                canvas.disc([x, y], 3.0, RED);
                canvas.line(&[[x, y], [x, y]], 2.0, RED);
                canvas.text([x, y], SMALL, "text", RED);
            });
            assert!(picture.pixels().all(|pixel| *pixel == WHITE), "{x}, {y}");
        }
    }

    #[test]
    fn texts_stand_on_their_middle_line() {
        let picture = drawn(|canvas| canvas.text([2.0, 15.0], SMALL, "é8€", BLACK));
        let inked = |columns: std::ops::Range<u32>, rows: std::ops::Range<u32>| {
            rows.flat_map(|y| columns.clone().map(move |x| (x, y))).filter(|at| picture[*at].0[0] < 128).count()
        };
        let width = advance(SMALL) as u32;
        assert!((0..3).all(|i| inked(2 + i * width..2 + (i + 1) * width, 7..23) > 3));
        assert_eq!(inked(0..40, 0..7) + inked(0..40, 23..30) + inked(2 + 3 * width..40, 0..30), 0);
    }
}
