use crate::image::{GrayImage, Region};
use core::f32::consts::PI;

/// Columns and rows of the window that a region is scaled to.
pub const WINDOW: (usize, usize) = (32, 64);

/// Window with the pixels around it, which its gradients need.
const FRAMED: (usize, usize) = (WINDOW.0 + 2, WINDOW.1 + 2);

/// Share of the height of a window that the region fills.
const FILLED: f32 = 0.8;

/// Largest number of samples per pixel along each axis, when a region is reduced.
const MAX_SAMPLES: usize = 4;

/// Intensities of a region, scaled to a window with room around the region.
pub struct Window {
    /// Rows of the window, with one more pixel on each side, from 0 to 1.
    pixels: [[f32; FRAMED.0]; FRAMED.1],
}

/// Gradient of the intensity at a pixel.
#[derive(Clone, Copy, Default)]
pub struct Gradient {
    /// Change per pixel.
    pub magnitude: f32,
    /// Direction as a part of half a turn, from 0 to 1: opposite directions are the same.
    pub orientation: f32,
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
        let offset = |i: usize| (i as f32 + 0.5) / samples as f32 - 0.5;
        let mut window = Self { pixels: [[0.0; FRAMED.0]; FRAMED.1] };
        for (row, pixels) in window.pixels.iter_mut().enumerate() {
            for (column, pixel) in pixels.iter_mut().enumerate() {
                let (x, y) = (column as f32 - 0.5 * (FRAMED.0 - 1) as f32, row as f32 - 0.5 * (FRAMED.1 - 1) as f32);
                let at = |i: usize, j: usize| between(image, u + scale * (x + offset(i)), v + scale * (y + offset(j)));
                let sum: f32 = (0..samples * samples).map(|k| at(k % samples, k / samples)).sum();
                *pixel = sum / (255 * samples * samples) as f32;
            }
        }
        Some(window)
    }

    /// Intensity of a pixel, from 0 to 1.
    pub const fn intensity(&self, column: usize, row: usize) -> f32 {
        self.pixels[row + 1][column + 1]
    }

    /// Gradient of a pixel, of the square roots of the intensities, which depend less on the light.
    pub fn gradient(&self, column: usize, row: usize) -> Gradient {
        let root = |column: usize, row: usize| libm::sqrtf(self.pixels[row][column]);
        let dx = root(column + 2, row + 1) - root(column, row + 1);
        let dy = root(column + 1, row + 2) - root(column + 1, row);
        let turned = libm::atan2f(dy, dx) / PI;
        let orientation = if turned < 0.0 { turned + 1.0 } else { turned };
        Gradient { magnitude: libm::hypotf(dx, dy), orientation: if orientation >= 1.0 { 0.0 } else { orientation } }
    }
}

/// Interpolated intensity between pixels; that of the border outside of the image.
fn between(image: &GrayImage, x: f32, y: f32) -> f32 {
    let (width, height) = image.size();
    let (x, y) = (x.clamp(0.0, (width - 1) as f32), y.clamp(0.0, (height - 1) as f32));
    let (column, row) = (x as u32, y as u32);
    let (a, b) = (x - column as f32, y - row as f32);
    let at = |i: u32, j: u32| f32::from(image.pixels[((column + i).min(width - 1), (row + j).min(height - 1))].0[0]);
    (1.0 - b) * ((1.0 - a) * at(0, 0) + a * at(1, 0)) + b * ((1.0 - a) * at(0, 1) + a * at(1, 1))
}
