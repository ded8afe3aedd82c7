use super::{
    Features,
    gradient::{WINDOW, Window},
};
use crate::image::{GrayImage, Region};
use apex_rt::{Out, node};

/// Rows and columns of pixels that are added up.
const CELL: usize = 4;

/// Columns and rows of a channel.
const CELLS: (usize, usize) = (WINDOW.0 / CELL, WINDOW.1 / CELL);

/// Orientations of gradients.
const BINS: usize = 6;

/// Channels: intensity, magnitude of the gradient, and this magnitude by orientation.
const CHANNELS: usize = 2 + BINS;

/// Pixels on each side over which the magnitude is normalized.
const REACH: usize = 5;

/// Number of features of [`acf_features`].
pub const ACF_FEATURES: usize = CHANNELS * CELLS.0 * CELLS.1;

/// Aggregated channel features of a region (ACF; thesis 6.8.1; Dollár et al. 2014): 1024 features for a classifier.
///
/// The region is scaled as for [`hog_features`](super::hog_features). The channels are the intensity, the magnitude of
/// the gradient, normalized by that of its surroundings, and the magnitude in each of 6 orientations; a feature is the
/// mean of a channel over 4 × 4 pixels. ⊥ if the region has no pixels.
#[node]
pub fn acf_features(image: &GrayImage, region: &Region, features: &mut Out<Features>) {
    let Some(window) = Window::new(image, region) else { return };
    let features = features.get_mut();
    features.clear();
    // Cannot fail: there are as many as `MAX_FEATURES`.
    let _ = features.resize(ACF_FEATURES, 0.0);
    let sums = magnitude_sums(&window);
    for y in 0..WINDOW.1 {
        let gradients = window.gradients(y);
        for (x, intensity) in window.intensities(y).iter().enumerate() {
            let magnitude = gradients.magnitudes[x] / (surroundings(&sums, x, y) + 0.01);
            let cell = y / CELL * CELLS.0 + x / CELL;
            let mut add = |channel: usize, value: f32| {
                features[channel * CELLS.0 * CELLS.1 + cell] += value / (CELL * CELL) as f32;
            };
            add(0, *intensity);
            add(1, magnitude);
            let bin = gradients.orientations[x] * BINS as f32;
            let (low, part) = (bin as usize % BINS, bin - bin.floor());
            add(2 + low, magnitude * (1.0 - part));
            add(2 + (low + 1) % BINS, magnitude * part);
        }
    }
}

/// Sums of magnitudes over all pixels above and to the left.
type Sums = [[f32; WINDOW.0 + 1]; WINDOW.1 + 1];

fn magnitude_sums(window: &Window) -> Sums {
    let mut sums = [[0.0; WINDOW.0 + 1]; WINDOW.1 + 1];
    for y in 0..WINDOW.1 {
        let mut row = 0.0;
        for (x, magnitude) in window.gradients(y).magnitudes.into_iter().enumerate() {
            row += magnitude;
            sums[y + 1][x + 1] = sums[y][x + 1] + row;
        }
    }
    sums
}

/// Mean magnitude around a pixel.
fn surroundings(sums: &Sums, x: usize, y: usize) -> f32 {
    let range = |at: usize, end: usize| (at.saturating_sub(REACH), (at + REACH + 1).min(end));
    let ((left, right), (top, bottom)) = (range(x, WINDOW.0), range(y, WINDOW.1));
    let sum = sums[bottom][right] - sums[bottom][left] - sums[top][right] + sums[top][left];
    sum.max(0.0) / ((right - left) * (bottom - top)) as f32
}

#[cfg(test)]
mod tests {
    use super::*;
    use ::image::{ImageBuffer, Luma};

    fn features(image: &GrayImage, region: Region) -> Option<Features> {
        let mut out = Out::new();
        acf_features(image, &region, &mut out);
        out.get().cloned()
    }

    #[test]
    fn channels_show_light_and_edges() {
        // Dark above, light below.
        let image = GrayImage::from(ImageBuffer::from_fn(80, 120, |_, y| Luma([if y < 60 { 51 } else { 204 }])));
        let found = features(&image, Region { left: 20, top: 20, width: 40, height: 80, area: 0 }).expect("features");
        assert_eq!(found.len(), ACF_FEATURES);
        let channel = |channel: usize, row: usize| found[channel * 128 + row * 8 + 4];
        assert!((channel(0, 2) - 0.2).abs() < 0.01 && (channel(0, 13) - 0.8).abs() < 0.01);
        assert!(channel(1, 7) + channel(1, 8) > 10.0 * (channel(1, 2) + channel(1, 13)));
        // The gradient points down: half of half a turn.
        assert!(channel(5, 7) > 10.0 * channel(2, 7), "{} {}", channel(5, 7), channel(2, 7));
    }

    #[test]
    fn odd_regions_are_bottom_or_finite() {
        let image = GrayImage::from(ImageBuffer::from_pixel(20, 10, Luma([70])));
        let region = |left, top, width, height| Region { left, top, width, height, area: 0 };
        assert_eq!(features(&image, Region::default()), None);
        assert_eq!(features(&GrayImage::default(), region(0, 0, 5, 5)), None);
        for odd in [region(0, 0, 1, 1), region(19, 9, u32::MAX, u32::MAX), region(0, 0, 1000, 1)] {
            assert!(features(&image, odd).is_some_and(|f| f.iter().all(|x| x.is_finite())), "{odd:?}");
        }
    }
}
