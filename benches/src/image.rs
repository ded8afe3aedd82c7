//! The image graph: nodes and their kernels, which the hand-written program also calls.

use apex_rt::prelude::*;
use std::{
    hint::black_box,
    sync::{Arc, LazyLock},
};

/// Pixels per row.
pub const WIDTH: usize = 640;
/// Number of rows.
pub const HEIGHT: usize = 480;
const PIXELS: usize = WIDTH * HEIGHT;

/// A colour image with three bytes per pixel. Copies share the pixels.
#[derive(Clone)]
pub struct Rgb(Arc<[u8]>);

/// An image with one byte per pixel.
#[derive(Clone, Default)]
pub struct Gray(Vec<u8>);

impl Gray {
    fn sized(&mut self) -> &mut [u8] {
        self.0.resize(PIXELS, 0);
        &mut self.0
    }
}

static FRAMES: LazyLock<[Rgb; 8]> = LazyLock::new(|| std::array::from_fn(|i| gen_frame(i as u64)));

/// Random numbers (splitmix64).
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn below(&mut self, n: u64) -> usize {
        (self.next() % n) as usize
    }
}

/// A frame of noise, 40…103, with 24 discs of 160…223.
fn gen_frame(seed: u64) -> Rgb {
    let mut random = Random(seed);
    let mut pixels: Vec<u8> = (0..3 * PIXELS).map(|_| 40 + random.below(64) as u8).collect();
    for _ in 0..24 {
        let (cx, cy, radius) = (random.below(WIDTH as u64), random.below(HEIGHT as u64), 8 + random.below(25));
        for y in cy.saturating_sub(radius)..(cy + radius).min(HEIGHT) {
            for x in cx.saturating_sub(radius)..(cx + radius).min(WIDTH) {
                if x.abs_diff(cx).pow(2) + y.abs_diff(cy).pow(2) <= radius * radius {
                    let at = 3 * (y * WIDTH + x);
                    pixels[at..at + 3].fill_with(|| 160 + random.below(64) as u8);
                }
            }
        }
    }
    Rgb(pixels.into())
}

/// Brightness, (77 R + 150 G + 29 B) / 256.
#[inline(never)]
pub fn gray(rgb: &Rgb, gray: &mut Gray) {
    for (to, from) in gray.sized().iter_mut().zip(rgb.0.chunks_exact(3)) {
        *to = ((77 * u32::from(from[0]) + 150 * u32::from(from[1]) + 29 * u32::from(from[2])) >> 8) as u8;
    }
}

/// Binomial 3×3 filter; pixels at the edges are copied.
#[inline(never)]
pub fn blur(from: &Gray, to: &mut Gray) {
    let (from, to) = (&from.0[..], to.sized());
    to.copy_from_slice(from);
    for y in 1..HEIGHT - 1 {
        let row = |y: usize| &from[y * WIDTH..(y + 1) * WIDTH];
        let (above, here, below) = (row(y - 1), row(y), row(y + 1));
        let column = |x: usize| u16::from(above[x]) + 2 * u16::from(here[x]) + u16::from(below[x]);
        for (x, to) in to[y * WIDTH..(y + 1) * WIDTH].iter_mut().enumerate().take(WIDTH - 1).skip(1) {
            *to = ((column(x - 1) + 2 * column(x) + column(x + 1)) >> 4) as u8;
        }
    }
}

/// 1 where the image is brighter than 120.
#[inline(never)]
pub fn threshold(from: &Gray, to: &mut Gray) {
    for (to, from) in to.sized().iter_mut().zip(&from.0) {
        *to = u8::from(*from > 120);
    }
}

/// Buffers for labelling.
#[derive(Default)]
pub struct Labels {
    of: Vec<u32>,
    parents: Vec<u32>,
    areas: Vec<u32>,
}

/// Counts 4-connected components (two passes, union-find): number | largest area << 32.
#[inline(never)]
pub fn components(mask: &Gray, labels: &mut Labels) -> u64 {
    let Labels { of, parents, areas } = labels;
    of.clear();
    of.resize(PIXELS, 0);
    parents.clear();
    // Label 0 is the background.
    parents.push(0);
    for (at, _) in mask.0.iter().enumerate().filter(|(_, m)| **m != 0) {
        let left = if at % WIDTH > 0 { of[at - 1] } else { 0 };
        let above = if at >= WIDTH { of[at - WIDTH] } else { 0 };
        of[at] = match (left, above) {
            (0, 0) => {
                parents.push(parents.len() as u32);
                parents.len() as u32 - 1
            }
            (label, 0) | (0, label) => label,
            (left, above) => union(parents, left, above),
        };
    }
    areas.clear();
    areas.resize(parents.len(), 0);
    for &label in of.iter().filter(|label| **label != 0) {
        areas[root(parents, label) as usize] += 1;
    }
    let count = areas.iter().filter(|area| **area > 0).count() as u64;
    count | u64::from(areas.iter().copied().max().unwrap_or(0)) << 32
}

fn root(parents: &mut [u32], mut label: u32) -> u32 {
    while parents[label as usize] != label {
        let up = parents[parents[label as usize] as usize];
        parents[label as usize] = up;
        label = up;
    }
    label
}

fn union(parents: &mut [u32], a: u32, b: u32) -> u32 {
    let (a, b) = (root(parents, a), root(parents, b));
    let (low, high) = (a.min(b), a.max(b));
    parents[high as usize] = low;
    low
}

/// Repeats eight frames.
#[node]
#[derive(Default)]
pub struct Camera {
    next: usize,
}

#[node]
impl Camera {
    /// Sends one frame.
    pub fn process(&mut self) -> Rgb {
        let frame = FRAMES[black_box(self.next)].clone();
        self.next = (self.next + 1) % FRAMES.len();
        frame
    }
}

/// Brightness of a colour image.
#[node]
pub fn to_gray(image: &Rgb, out: &mut Out<Gray>) {
    gray(image, out.get_mut());
}

/// Blurred image.
#[node]
pub fn to_blurred(image: &Gray, out: &mut Out<Gray>) {
    blur(image, out.get_mut());
}

/// Mask of bright pixels.
#[node]
pub fn to_mask(image: &Gray, out: &mut Out<Gray>) {
    threshold(image, out.get_mut());
}

/// Number and largest area of the components of a mask.
#[node]
#[derive(Default)]
pub struct Components {
    labels: Labels,
}

#[node]
impl Components {
    fn process(&mut self, mask: &Gray) -> u64 {
        components(mask, &mut self.labels)
    }
}
