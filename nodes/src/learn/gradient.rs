use crate::image::{GrayImage, Region};
use std::array;

/// Columns and rows of the window that a region is scaled to.
pub const WINDOW: (usize, usize) = (32, 64);

/// Window with the pixels around it, which its gradients need.
const FRAMED: (usize, usize) = (WINDOW.0 + 2, WINDOW.1 + 2);

/// Share of the height of a window that the region fills.
const FILLED: f32 = 0.8;

/// Largest number of samples per pixel along each axis, when a region is reduced.
const MAX_SAMPLES: usize = 4;

/// Polynomial of the arc tangent from 0 to 1, by odd powers, with an error below 1e-5 (Abramowitz and Stegun 4.4.47).
const ARC_TANGENT: [f32; 5] = [0.999_866, -0.330_299_5, 0.180_141, -0.085_133, 0.020_835_1];

/// Intensities of a region, scaled to a window with room around the region.
pub struct Window {
    /// Rows of the window, with one more pixel on each side, from 0 to 1.
    pixels: [[f32; FRAMED.0]; FRAMED.1],
    /// Their square roots.
    roots: [[f32; FRAMED.0]; FRAMED.1],
}

/// Gradients of the pixels of a row.
pub struct Gradients {
    /// Changes per pixel.
    pub magnitudes: [f32; WINDOW.0],
    /// Directions as parts of half a turn, from 0 to 1: opposite directions are the same.
    pub orientations: [f32; WINDOW.0],
}

impl Window {
    /// Scales a region, so that its height and that of the window correspond. `None` without pixels.
    ///
    /// The window is as wide as its height demands, and reaches beyond the region. Pixels outside of the image are
    /// those of its border.
    pub fn new(image: &GrayImage, region: &Region) -> Option<Self> {
        let (width, height) = image.size();
        if region.width == 0 || region.height == 0 || region.left >= width || region.top >= height {
            return None;
        }
        let [u, v] = region.grown(0, (width, height)).middle();
        let scale = region.grown(0, (width, height)).height as f32 / (FILLED * WINDOW.1 as f32);
        let samples = (scale.ceil() as usize).clamp(1, MAX_SAMPLES);
        let mut rows = Rows::new(image, Axis { middle: u, scale, samples, size: width });
        let down = Axis { middle: v, scale, samples, size: height };
        let mut pixels = [[0.0; FRAMED.0]; FRAMED.1];
        for (pixels, along_y) in pixels.iter_mut().zip(down.samples::<{ FRAMED.1 }>()) {
            for sample in &along_y[..samples] {
                for (row, weight) in sample.ends.into_iter().zip(sample.weights) {
                    pixels.iter_mut().zip(rows.get(row)).for_each(|(pixel, value)| *pixel += weight * value);
                }
            }
            pixels.iter_mut().for_each(|pixel| *pixel /= (255 * samples * samples) as f32);
        }
        let roots = pixels.map(|row| row.map(f32::sqrt));
        Some(Self { pixels, roots })
    }

    /// Intensities of a row, from 0 to 1.
    pub fn intensities(&self, row: usize) -> &[f32] {
        &self.pixels[row + 1][1..=WINDOW.0]
    }

    /// Gradients of a row, of the square roots of the intensities, which depend less on the light.
    pub fn gradients(&self, row: usize) -> Gradients {
        let [above, here, below] = [0, 1, 2].map(|i| &self.roots[row + i]);
        let mut gradients = Gradients { magnitudes: [0.0; WINDOW.0], orientations: [0.0; WINDOW.0] };
        for x in 0..WINDOW.0 {
            let (dx, dy) = (here[x + 2] - here[x], below[x + 1] - above[x + 1]);
            gradients.magnitudes[x] = (dx * dx + dy * dy).sqrt();
            gradients.orientations[x] = orientation(dx, dy);
        }
        gradients
    }
}

/// Direction of a vector as a part of half a turn, from 0 to 1. Written without branches, for vector instructions.
fn orientation(dx: f32, dy: f32) -> f32 {
    let (width, height) = (dx.abs(), dy.abs());
    let is_steep = height > width;
    let (short, long) = if is_steep { (width, height) } else { (height, width) };
    let tangent = short / if long > 0.0 { long } else { 1.0 };
    let square = tangent * tangent;
    let [a, b, c, d, e] = ARC_TANGENT;
    let angle = tangent * (a + square * (b + square * (c + square * (d + square * e)))) * core::f32::consts::FRAC_1_PI;
    let from_axis = if is_steep { 0.5 - angle } else { angle };
    let turned = if dx * dy < 0.0 { 1.0 - from_axis } else { from_axis };
    if turned < 1.0 { turned } else { 0.0 }
}

/// Samples along an axis of an image.
struct Axis {
    /// Place of the middle of the window, in pixels of the image.
    middle: f32,
    /// Pixels of the image per pixel of the window.
    scale: f32,
    /// Samples per pixel of the window.
    samples: usize,
    /// Pixels of the image.
    size: u32,
}

/// Place between two pixels.
#[derive(Clone, Copy, Default)]
struct Sample {
    ends: [usize; 2],
    weights: [f32; 2],
}

impl Axis {
    /// Samples of each of `N` pixels of the window. Those outside of the image are at its border.
    fn samples<const N: usize>(&self) -> [[Sample; MAX_SAMPLES]; N] {
        let last = (self.size - 1) as usize;
        array::from_fn(|pixel| {
            array::from_fn(|i| {
                let offset = (i as f32 + 0.5) / self.samples as f32 - 0.5;
                let place = self.middle + self.scale * (pixel as f32 - 0.5 * (N - 1) as f32 + offset);
                let place = place.clamp(0.0, last as f32);
                let before = place as usize;
                let share = place - before as f32;
                Sample { ends: [before, (before + 1).min(last)], weights: [1.0 - share, share] }
            })
        })
    }
}

/// Rows of an image, reduced to the columns of a window: sums of their samples.
struct Rows<'a> {
    image: &'a GrayImage,
    columns: [[Sample; MAX_SAMPLES]; FRAMED.0],
    samples: usize,
    /// Last even and last odd row, with their indices, as neighbouring samples need the same two rows.
    kept: [(usize, [f32; FRAMED.0]); 2],
}

impl<'a> Rows<'a> {
    fn new(image: &'a GrayImage, across: Axis) -> Self {
        let kept = [(usize::MAX, [0.0; FRAMED.0]); 2];
        Self { image, columns: across.samples(), samples: across.samples, kept }
    }

    fn get(&mut self, row: usize) -> &[f32; FRAMED.0] {
        let (kept, sums) = &mut self.kept[row % 2];
        if *kept != row {
            let width = self.image.size().0 as usize;
            let pixels = &self.image.pixels.as_raw()[row * width..][..width];
            for (sum, along_x) in sums.iter_mut().zip(&self.columns) {
                let value = |s: &Sample| (0..2).map(|i| s.weights[i] * f32::from(pixels[s.ends[i]])).sum::<f32>();
                *sum = along_x[..self.samples].iter().map(value).sum();
            }
            *kept = row;
        }
        sums
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Random;
    use ::image::{ImageBuffer, Luma};

    /// Interpolated intensity between pixels; that of the border outside of the image.
    fn between(image: &GrayImage, x: f32, y: f32) -> f32 {
        let (width, height) = image.size();
        let (x, y) = (x.clamp(0.0, (width - 1) as f32), y.clamp(0.0, (height - 1) as f32));
        let (column, row) = (x as u32, y as u32);
        let (a, b) = (x - column as f32, y - row as f32);
        let at =
            |i: u32, j: u32| f32::from(image.pixels[((column + i).min(width - 1), (row + j).min(height - 1))].0[0]);
        (1.0 - b) * ((1.0 - a) * at(0, 0) + a * at(1, 0)) + b * ((1.0 - a) * at(0, 1) + a * at(1, 1))
    }

    /// Mean of samples in a pixel of the window.
    fn by_definition(image: &GrayImage, region: &Region, row: usize, column: usize) -> f32 {
        let [u, v] = region.grown(0, image.size()).middle();
        let scale = region.grown(0, image.size()).height as f32 / (FILLED * WINDOW.1 as f32);
        let samples = (scale.ceil() as usize).clamp(1, MAX_SAMPLES);
        let offset = |i: usize| (i as f32 + 0.5) / samples as f32 - 0.5;
        let (x, y) = (column as f32 - 0.5 * (FRAMED.0 - 1) as f32, row as f32 - 0.5 * (FRAMED.1 - 1) as f32);
        let at = |i: usize, j: usize| between(image, u + scale * (x + offset(i)), v + scale * (y + offset(j)));
        (0..samples * samples).map(|k| at(k % samples, k / samples)).sum::<f32>() / (255 * samples * samples) as f32
    }

    #[test]
    fn windows_are_means_of_samples() {
        let mut random = Random::new(1);
        for (width, height) in [(1, 1), (1, 9), (3, 2), (33, 17), (200, 300)] {
            let image = GrayImage::from(ImageBuffer::from_fn(width, height, |_, _| Luma([random.bits() as u8])));
            let mut below = |end: u32| (random.bits() % u64::from(end)) as u32;
            for _ in 0..20 {
                let (left, top) = (below(width), below(height));
                let region = Region { left, top, width: 1 + below(width), height: 1 + below(height), area: 0 };
                let window = Window::new(&image, &region).expect("a region with pixels");
                for (row, pixels) in window.pixels.iter().enumerate() {
                    for (column, pixel) in pixels.iter().enumerate() {
                        let expected = by_definition(&image, &region, row, column);
                        assert!((pixel - expected).abs() < 2e-6, "{region:?} {row} {column}: {pixel} {expected}");
                    }
                }
            }
        }
    }

    #[test]
    fn orientations_are_those_of_the_arc_tangent() {
        let numbers: Vec<f32> = (-200..=200).map(|i| i as f32 / 200.0).chain([1e-6, -1e-6, -0.0]).collect();
        for (dx, dy) in numbers.iter().flat_map(|x| numbers.iter().map(|y| (*x, *y))) {
            let expected = (f64::from(dy).atan2(f64::from(dx)) / std::f64::consts::PI).rem_euclid(1.0);
            let found = orientation(dx, dy);
            let difference = (f64::from(found) - expected).abs();
            assert!((0.0..1.0).contains(&found) && difference.min(1.0 - difference) < 4e-6, "{dx} {dy}: {found}");
        }
    }
}
