use super::{
    camera::{Distortion, TofCamera},
    vector::{V3, unit},
};

/// Side of a block of pixels.
const BLOCK: usize = 8;

/// Table of what is the same in all frames of a camera.
#[derive(Debug, Clone, Default)]
pub(super) struct Optics {
    /// Camera that the table is of.
    camera: Option<TofCamera>,
    /// Directions of the rays of each pixel, as the optics bend them, in the frame of the robot.
    rays: Vec<V3>,
    /// Direction of each pixel in the frame of the camera, as its model has it, and error of its distance, in m.
    pixels: Vec<(V3, f32)>,
    /// Directions on the plane between which the rays of each block of pixels lie, in rad.
    blocks: Vec<[f32; 2]>,
}

impl Optics {
    /// Computes the table of a camera, unless it is the last one.
    pub fn prepare(&mut self, camera: &TofCamera) {
        if self.camera.as_ref() == Some(camera) {
            return;
        }
        let lens = Lens::new(camera);
        let side = camera.rays.max(1);
        let within = |k: usize| (k as f32 + 0.5) / side as f32 - 0.5;
        let pixels =
            || (0..camera.width * camera.height).map(|i| ((i % camera.width) as f32, (i / camera.width) as f32));
        self.pixels.clear();
        self.pixels.extend(pixels().map(|(u, v)| lens.pixel(u, v)));
        self.rays.clear();
        self.rays.extend(
            pixels()
                .flat_map(|(u, v)| (0..side * side).map(move |k| (u + within(k % side), v + within(k / side))))
                .map(|(u, v)| lens.ray(u, v)),
        );
        self.camera = Some(camera.clone());
        self.blocks.clear();
        let count = camera.width.div_ceil(BLOCK) * camera.height.div_ceil(BLOCK);
        self.blocks.resize(count, [f32::INFINITY, f32::NEG_INFINITY]);
        for pixel in 0..self.pixels.len() {
            let block = self.block(pixel);
            for [x, y, _] in self.rays(pixel).copied().collect::<Vec<_>>() {
                let (angle, span) = (libm::atan2f(y, x), &mut self.blocks[block]);
                *span = [span[0].min(angle), span[1].max(angle)];
            }
        }
    }

    /// Directions on the plane between which the rays of each block of pixels lie, in rad.
    pub fn blocks(&self) -> &[[f32; 2]] {
        &self.blocks
    }

    /// Number of the block of a pixel.
    pub fn block(&self, pixel: usize) -> usize {
        let width = self.camera.as_ref().map_or(1, |camera| camera.width);
        pixel / width / BLOCK * width.div_ceil(BLOCK) + pixel % width / BLOCK
    }

    /// Directions of the rays of a pixel.
    pub fn rays(&self, pixel: usize) -> core::slice::Iter<'_, V3> {
        let count = self.rays.len() / self.pixels.len().max(1);
        self.rays[pixel * count..(pixel + 1) * count].iter()
    }

    /// Direction of a pixel in the frame of the camera, and error of its distance, in m.
    pub fn pixel(&self, pixel: usize) -> (V3, f32) {
        self.pixels[pixel]
    }
}

/// Directions through the lens of a camera.
struct Lens<'a> {
    camera: &'a TofCamera,
    focal: f32,
    /// Sine and cosine of the pitch.
    pitch: (f32, f32),
}

impl<'a> Lens<'a> {
    fn new(camera: &'a TofCamera) -> Self {
        let focal = 0.5 * camera.width as f32 / libm::tanf(0.5 * camera.field_of_view);
        Self { camera, focal, pitch: libm::sincosf(camera.pitch) }
    }

    fn pixel(&self, u: f32, v: f32) -> (V3, f32) {
        (self.direction(u, v, 0.0), self.distort(&self.camera.distortion.distance, u, v))
    }

    /// Direction of a ray through the point (u, v) of the image, as the optics bend it.
    fn ray(&self, u: f32, v: f32) -> V3 {
        let (sin, cos) = self.pitch;
        let [x, y, z] = self.direction(u, v, self.distort(&self.camera.distortion.elevation, u, v));
        [x * cos + z * sin, y, z * cos - x * sin]
    }

    /// Direction of a point of the image in the frame of the camera, with length 1, bent up by `error`.
    fn direction(&self, u: f32, v: f32, error: f32) -> V3 {
        let middle = |count: usize| 0.5 * (count as f32 - 1.0);
        let left = (middle(self.camera.width) - u) / self.focal;
        let up = (middle(self.camera.height) - v) / self.focal;
        unit([1.0, left, up + error])
    }

    fn distort(&self, coefficients: &[f32; 6], u: f32, v: f32) -> f32 {
        let from_middle = |pixel: f32, count: usize| 2.0 * (pixel + 0.5) / count as f32 - 1.0;
        Distortion::at(coefficients, from_middle(u, self.camera.width), from_middle(v, self.camera.height))
    }
}
