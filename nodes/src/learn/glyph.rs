use super::Features;
use crate::image::{GrayImage, Region};
use apex_rt::{Out, node};

/// Number of rows and columns of a glyph.
pub const GLYPH_SIDE: usize = 20;

/// Longer side of the drawn part of a glyph; the rest is a margin.
const INK_SIDE: f32 = 16.0;

/// Minimum contrast of a glyph, in intensities.
const MIN_CONTRAST: f32 = 16.0;

/// Features of the glyph in a region of an image, for a [`Classifier`](super::Classifier) (thesis 4.3.2): 20 rows of 20
/// values from 0 (ground) to 1 (ink).
///
/// The ink is scaled to 16 rows or columns, whichever is longer, and centred. It may be dark on light or light on dark.
/// ⊥ if the region has no pixels, or if all have about the same intensity.
#[node]
pub fn glyph_features(image: &GrayImage, region: &Region, features: &mut Out<Features>) {
    if let Some(ink) = Ink::find(image, region) {
        let features = features.get_mut();
        features.clear();
        features.extend((0..GLYPH_SIDE * GLYPH_SIDE).map(|i| ink.cell(i % GLYPH_SIDE, i / GLYPH_SIDE)));
    }
}

/// Ink in an image.
struct Ink<'a> {
    image: &'a GrayImage,
    /// Intensity of the ground, and that of the ink minus it.
    ground: f32,
    contrast: f32,
    /// Bounding box of the ink: first and last column, first and last row.
    columns: [u32; 2],
    rows: [u32; 2],
}

impl<'a> Ink<'a> {
    fn find(image: &'a GrayImage, region: &Region) -> Option<Self> {
        let Region { left, top, width, height, .. } = region.grown(0, image.size());
        let (right, bottom) = ((left + width).checked_sub(1)?, (top + height).checked_sub(1)?);
        let places = || (top..=bottom).flat_map(move |y| (left..=right).map(move |x| (x, y)));
        let mut border = [0_u32; 256];
        let mut all = [0_u32; 256];
        for (x, y) in places() {
            let level = usize::from(image.pixels[(x, y)].0[0]);
            all[level] += 1;
            border[level] += u32::from(x == left || x == right || y == top || y == bottom);
        }
        let ground = quantile(&border, 0.5);
        // Quantiles, as a few pixels may be lighter or darker than the ink.
        let (dark, light) = (quantile(&all, 0.02) - ground, quantile(&all, 0.98) - ground);
        let contrast = if dark.abs() > light.abs() { dark } else { light };
        if contrast.abs() < MIN_CONTRAST {
            return None;
        }
        let mut ink = Self { image, ground, contrast, columns: [u32::MAX, 0], rows: [u32::MAX, 0] };
        for (x, y) in places().filter(|(x, y)| ink.at(i64::from(*x), i64::from(*y)) >= 0.5).collect::<Vec<_>>() {
            ink.columns = [ink.columns[0].min(x), ink.columns[1].max(x)];
            ink.rows = [ink.rows[0].min(y), ink.rows[1].max(y)];
        }
        (ink.columns[0] <= ink.columns[1]).then_some(ink)
    }

    /// Amount of ink in a pixel, from 0 to 1.
    fn at(&self, x: i64, y: i64) -> f32 {
        let pixel = u32::try_from(x).ok().zip(u32::try_from(y).ok());
        let pixel = pixel.and_then(|(x, y)| self.image.pixels.get_pixel_checked(x, y));
        pixel.map_or(0.0, |p| ((f32::from(p.0[0]) - self.ground) / self.contrast).clamp(0.0, 1.0))
    }

    /// Mean amount of ink in a cell of the glyph.
    fn cell(&self, column: usize, row: usize) -> f32 {
        const SAMPLES: u8 = 4;
        let length = |ends: [u32; 2]| (ends[1] - ends[0] + 1) as f32;
        let scale = length(self.columns).max(length(self.rows)) / INK_SIDE;
        let first = |ends: [u32; 2]| ends[0] as f32 + 0.5 * (length(ends) - scale * GLYPH_SIDE as f32);
        let sample = |first: f32, cell: usize, part: u8| {
            first + scale * (cell as f32 + (f32::from(part) + 0.5) / f32::from(SAMPLES)) - 0.5
        };
        let parts = (0..SAMPLES).flat_map(|a| (0..SAMPLES).map(move |b| (a, b)));
        let sum: f32 = parts
            .map(|(a, b)| self.between(sample(first(self.columns), column, a), sample(first(self.rows), row, b)))
            .sum();
        sum / f32::from(SAMPLES * SAMPLES)
    }

    /// Interpolated amount of ink between pixels; 0 outside the bounding box.
    fn between(&self, x: f32, y: f32) -> f32 {
        let outside = |at: f32, ends: [u32; 2]| at < ends[0] as f32 - 1.0 || at > ends[1] as f32 + 1.0;
        if outside(x, self.columns) || outside(y, self.rows) {
            return 0.0;
        }
        let (i, j) = (x.floor() as i64, y.floor() as i64);
        let (a, b) = (x - x.floor(), y - y.floor());
        let row = |j: i64| (1.0 - a) * self.at(i, j) + a * self.at(i + 1, j);
        (1.0 - b) * row(j) + b * row(j + 1)
    }
}

/// First level with more than the share `part` of the pixels up to and including it.
fn quantile(histogram: &[u32; 256], part: f32) -> f32 {
    let limit = histogram.iter().sum::<u32>() as f32 * part;
    let mut sum = 0;
    let level = histogram.iter().position(|count| {
        sum += count;
        sum as f32 > limit
    });
    level.unwrap_or(0) as f32
}

#[cfg(test)]
mod tests {
    use super::*;
    use ::image::{ImageBuffer, Luma};

    fn find(image: &GrayImage, region: Region) -> Option<Features> {
        let mut out = Out::new();
        glyph_features(image, &region, &mut out);
        out.get().cloned()
    }

    fn whole(image: &GrayImage) -> Region {
        Region { width: image.size().0, height: image.size().1, ..Region::default() }
    }

    #[test]
    fn a_glyph_does_not_depend_on_size_place_or_light() {
        let bar = |side: u32, at: u32, ground: u8, ink: u8| {
            let inside = move |x: u32, y: u32| (at..at + side / 2).contains(&x) && (at..at + side).contains(&y);
            GrayImage::from(ImageBuffer::from_fn(100, 90, |x, y| Luma([if inside(x, y) { ink } else { ground }])))
        };
        let images = [bar(32, 10, 255, 0), bar(32, 30, 20, 200), bar(64, 5, 130, 80)];
        let glyphs = images.map(|image| find(&image, whole(&image)).expect("a glyph"));
        for (i, value) in glyphs[0].iter().enumerate() {
            let (x, y) = (i % GLYPH_SIDE, i / GLYPH_SIDE);
            let inside = (6..14).contains(&x) && (2..18).contains(&y);
            assert!((value - f32::from(u8::from(inside))).abs() < 0.3, "{x} {y}: {value}");
            assert!((value - glyphs[1][i]).abs() < 0.01 && (value - glyphs[2][i]).abs() < 0.2, "{x} {y}");
        }
    }

    #[test]
    fn nothing_is_bottom() {
        let flat = GrayImage::from(ImageBuffer::from_pixel(40, 40, Luma([70])));
        assert_eq!(find(&flat, whole(&flat)), None);
        assert_eq!(find(&GrayImage::default(), Region { width: 5, height: 5, ..Region::default() }), None);
        assert_eq!(find(&flat, Region { left: 50, width: u32::MAX, height: 1, ..Region::default() }), None);
        assert_eq!(find(&flat, Region::default()), None);
    }
}
