use super::{
    Features,
    gradient::{Gradients, WINDOW, Window},
};
use crate::image::{GrayImage, Region};
use apex_rt::{Out, node};
use std::array;

/// Rows and columns of pixels in a cell.
const CELL: usize = 8;

/// Columns and rows of cells.
const CELLS: (usize, usize) = (WINDOW.0 / CELL, WINDOW.1 / CELL);

/// Orientations of gradients in a cell.
const BINS: usize = 9;

/// Largest value in a normalized block.
const LARGEST: f32 = 0.2;

/// Number of features of [`hog_features`].
pub const HOG_FEATURES: usize = (CELLS.0 - 1) * (CELLS.1 - 1) * 4 * BINS;

/// Histograms of oriented gradients of a region (HOG; thesis 6.8.1; Dalal and Triggs 2005): 756 features for a
/// classifier.
///
/// The region is scaled to 64 rows with room around it, 32 × 64 pixels in cells of 8 × 8. Each block of 2 × 2 cells
/// with 9 orientations is normalized. ⊥ if the region has no pixels.
#[node]
pub fn hog_features(image: &GrayImage, region: &Region, features: &mut Out<Features>) {
    let Some(window) = Window::new(image, region) else { return };
    let cells = cells(&window);
    let features = features.get_mut();
    features.clear();
    for row in 0..CELLS.1 - 1 {
        for column in 0..CELLS.0 - 1 {
            let mut block = [0.0; 4 * BINS];
            for (at, part) in block.chunks_exact_mut(BINS).enumerate() {
                part.copy_from_slice(&cells[row + at / 2][column + at % 2]);
            }
            normalize(&mut block);
            block.iter_mut().for_each(|value| *value = value.min(LARGEST));
            normalize(&mut block);
            // Cannot fail: there are fewer values than `MAX_FEATURES`.
            let _ = features.extend_from_slice(&block);
        }
    }
}

/// Histogram of each cell. Each pixel counts for the nearest cells and orientations, by its distance from them.
fn cells(window: &Window) -> [[[f32; BINS]; CELLS.0]; CELLS.1] {
    let mut cells = [[[0.0; BINS]; CELLS.0]; CELLS.1];
    for y in 0..WINDOW.1 {
        let histograms = row_histograms(&window.gradients(y));
        for (row, weight) in neighbours((y as f32 + 0.5) / CELL as f32 - 0.5) {
            let Some(cells) = usize::try_from(row).ok().and_then(|row| cells.get_mut(row)) else { continue };
            let sums = cells.as_flattened_mut().iter_mut().zip(histograms.as_flattened());
            sums.for_each(|(sum, value)| *sum += weight * value);
        }
    }
    cells
}

/// Histograms of the pixels of a row, for each column of cells.
fn row_histograms(gradients: &Gradients) -> [[f32; BINS]; CELLS.0] {
    // One more cell on each side for what is beyond the window, and one more bin at each end for half turns.
    let mut sums = [[0.0; (BINS + 2).next_power_of_two()]; CELLS.0 + 2];
    for (x, (magnitude, orientation)) in gradients.magnitudes.iter().zip(&gradients.orientations).enumerate() {
        let bin = orientation * BINS as f32 + 0.5;
        let low = bin as usize;
        let high_share = magnitude * (bin - low as f32);
        let low_share = magnitude - high_share;
        let (column, right) = ((x + CELL / 2) / CELL, ((x + CELL / 2) % CELL) as f32 / CELL as f32 + 0.5 / CELL as f32);
        for (column, weight) in [(column, 1.0 - right), (column + 1, right)] {
            let sums = &mut sums[column];
            let size = sums.len();
            sums[low % size] += weight * low_share;
            sums[(low + 1) % size] += weight * high_share;
        }
    }
    array::from_fn(|column| {
        let sums = &sums[column + 1];
        let mut bins: [f32; BINS] = array::from_fn(|bin| sums[bin + 1]);
        bins[BINS - 1] += sums[0];
        bins[0] += sums[BINS + 1];
        bins
    })
}

/// Whole numbers below and above a number, with their weights.
fn neighbours(number: f32) -> [(i32, f32); 2] {
    let low = number.floor();
    [(low as i32, 1.0 - (number - low)), (low as i32 + 1, number - low)]
}

fn normalize(block: &mut [f32]) {
    let squares: f32 = block.iter().map(|x| x * x).sum();
    let factor = 1.0 / (squares + 1e-3).sqrt();
    block.iter_mut().for_each(|x| *x *= factor);
}

#[cfg(test)]
mod tests {
    use super::*;
    use ::image::{ImageBuffer, Luma};

    fn features(image: &GrayImage, region: Region) -> Option<Features> {
        let mut out = Out::new();
        hog_features(image, &region, &mut out);
        out.get().cloned()
    }

    #[test]
    fn orientations_are_told_apart() {
        let stripes = |vertical: bool| {
            let light = move |x: u32, y: u32| if (if vertical { x } else { y }) / 4 % 2 == 0 { 40 } else { 200 };
            GrayImage::from(ImageBuffer::from_fn(120, 120, |x, y| Luma([light(x, y)])))
        };
        let region = Region { left: 30, top: 20, width: 40, height: 80, area: 0 };
        let sums = |image: &GrayImage| {
            let found = features(image, region).expect("features");
            assert_eq!(found.len(), HOG_FEATURES);
            let mut sums = [0.0; BINS];
            found.iter().enumerate().for_each(|(i, x)| sums[i % BINS] += x);
            sums
        };
        let (vertical, horizontal) = (sums(&stripes(true)), sums(&stripes(false)));
        assert!(vertical[0] + vertical[8] > 10.0 * vertical[4], "{vertical:?}");
        assert!(horizontal[4] > 10.0 * horizontal[0], "{horizontal:?}");
    }

    #[test]
    fn cells_are_sums_of_weighted_gradients() {
        let mut random = crate::math::Random::new(1);
        let image = GrayImage::from(ImageBuffer::from_fn(70, 90, |_, _| Luma([random.bits() as u8])));
        let window = Window::new(&image, &Region { left: 11, top: 7, width: 40, height: 71, area: 0 }).expect("pixels");
        let mut expected = [[[0.0; BINS]; CELLS.0]; CELLS.1];
        for (y, x) in (0..WINDOW.1).flat_map(|y| (0..WINDOW.0).map(move |x| (y, x))) {
            let gradients = window.gradients(y);
            let place = |pixel: usize| (pixel as f32 + 0.5) / CELL as f32 - 0.5;
            for (row, a) in neighbours(place(y)) {
                for (column, b) in neighbours(place(x)) {
                    for (bin, c) in neighbours(gradients.orientations[x] * BINS as f32 - 0.5) {
                        if (0..CELLS.1 as i32).contains(&row) && (0..CELLS.0 as i32).contains(&column) {
                            let bin = bin.rem_euclid(BINS as i32) as usize;
                            expected[row as usize][column as usize][bin] += a * b * c * gradients.magnitudes[x];
                        }
                    }
                }
            }
        }
        let found = cells(&window);
        for (found, expected) in found.as_flattened().as_flattened().iter().zip(expected.as_flattened().as_flattened())
        {
            assert!((found - expected).abs() < 1e-4 * expected, "{found} {expected}");
        }
    }

    #[test]
    fn light_matters_little() {
        let shade = |x: u32, y: u32| ((x * 7 + y * y) % 90) as f32;
        let image =
            |gain: f32| GrayImage::from(ImageBuffer::from_fn(60, 90, |x, y| Luma([(gain * shade(x, y)) as u8])));
        let region = Region { left: 10, top: 10, width: 30, height: 60, area: 0 };
        let (a, b) =
            (features(&image(1.0), region).expect("features"), features(&image(2.5), region).expect("features"));
        let difference: f32 = a.iter().zip(&b).map(|(a, b)| (a - b).abs()).sum();
        assert!(difference < 0.1 * a.iter().sum::<f32>(), "{difference}");
    }

    #[test]
    fn odd_regions_are_bottom_or_finite() {
        let image = GrayImage::from(ImageBuffer::from_pixel(20, 10, Luma([70])));
        let region = |left, top, width, height| Region { left, top, width, height, area: 0 };
        assert_eq!(features(&image, Region::default()), None);
        assert_eq!(features(&image, region(20, 0, 5, 5)), None);
        assert_eq!(features(&GrayImage::default(), region(0, 0, 5, 5)), None);
        for odd in [region(0, 0, 1, 1), region(19, 9, u32::MAX, u32::MAX), region(0, 0, 1000, 1)] {
            assert!(features(&image, odd).is_some_and(|f| f.iter().all(|x| x.is_finite())), "{odd:?}");
        }
    }
}
