//! Digits as they stand on forms, for measurements: in a window on a box, of which more or fewer sides are in view.
//! Nothing here is shared with what the network is trained on.

use apex_nodes::{image::GrayImage, math::Random};
use image::{ImageBuffer, Luma};

/// Light digit on dark ground.
pub type Digit = ImageBuffer<Luma<u8>, Vec<u8>>;

/// Printed digits and their classes, of files in the format of MNIST, unpacked.
pub fn digits(images: &[u8], labels: &[u8]) -> Vec<(Digit, usize)> {
    let size = |at: usize| images.get(at..at + 4).map_or(0, |b| b.iter().fold(0, |sum, b| sum << 8 | u32::from(*b)));
    let (height, width) = (size(8), size(12));
    let pixels = images.get(16..).unwrap_or_default().chunks_exact((width * height).max(1) as usize);
    let digit = |bytes: &[u8]| ImageBuffer::from_raw(width, height, bytes.to_vec());
    let classes = labels.get(8..).unwrap_or_default().iter().map(|class| usize::from(*class));
    pixels.zip(classes).filter_map(|(bytes, class)| Some((digit(bytes)?, class))).collect()
}

/// First and last column, first and last row with ink.
fn extent(digit: &Digit) -> [[i32; 2]; 2] {
    let inked = digit.enumerate_pixels().filter(|(_, _, p)| p.0[0] > 100);
    inked.fold([[i32::MAX / 2, 0]; 2], |[x, y], (u, v, _)| {
        let grown = |[low, high]: [i32; 2], at: u32| [low.min(at as i32), high.max(at as i32)];
        [grown(x, u), grown(y, v)]
    })
}

/// Digit in a box of a form, in a window in which at least one side of the box is at least partly in view.
pub fn framed(digit: &Digit, random: &mut Random) -> GrayImage {
    let [x, y] = extent(digit);
    let whole = |random: &mut Random, low: f32, high: f32| random.uniform(low, high) as i32;
    // Distances of the sides of the box and of the window from the ink: left, right, above, below.
    let sides: [i32; 4] = std::array::from_fn(|_| whole(random, 2.0, 8.0));
    let thick = whole(random, 1.0, 3.9);
    let mut window: [i32; 4] = std::array::from_fn(|_| whole(random, 1.0, 12.0));
    let is_seen = |window: &[i32; 4]| window.iter().zip(&sides).any(|(window, side)| window >= &(side + thick));
    while !is_seen(&window) {
        window = std::array::from_fn(|_| whole(random, 1.0, 12.0));
    }
    // Worn print: a line is interrupted.
    let gap = random.chance(0.3).then(|| [whole(random, 0.0, 20.0), whole(random, 2.0, 12.0)]);
    let shade = random.uniform(120.0, 255.0) as u8;
    view(digit, [x, y], window, |u, v| {
        let out = [x[0] - u, u - x[1], y[0] - v, v - y[1]];
        let in_line = out.iter().zip(&sides).any(|(out, side)| (*side..side + thick).contains(out));
        let in_box = out.iter().zip(&sides).all(|(out, side)| *out < side + thick);
        let worn = gap.is_some_and(|[from, length]| (from..from + length).contains(&((u + v - x[0] - y[0]).abs())));
        if in_line && in_box && !worn { shade } else { 0 }
    })
}

/// Digit that the window cuts off at one side: 45 to 60 % of it are missing.
pub fn cut(digit: &Digit, random: &mut Random) -> GrayImage {
    let [x, y] = extent(digit);
    let side = (random.bits() % 4) as usize;
    let [low, high] = if side < 2 { x } else { y };
    let mut window = [2; 4];
    // Negative: inside the ink.
    window[side] = -(random.uniform(0.45, 0.6) * (high - low + 1) as f32) as i32;
    view(digit, [x, y], window, |_, _| 0)
}

/// Window on a digit, with other ink. Beyond the window there is nothing, but a margin.
fn view(digit: &Digit, [x, y]: [[i32; 2]; 2], window: [i32; 4], other: impl Fn(i32, i32) -> u8) -> GrayImage {
    let (left, top) = (x[0] - window[0], y[0] - window[2]);
    let (width, height) = (x[1] + window[1] - left + 1, y[1] + window[3] - top + 1);
    let pixel = |u: u32, v: u32| {
        let (u, v) = (u as i32 - 1, v as i32 - 1);
        if u < 0 || v < 0 || u >= width || v >= height {
            return Luma([0]);
        }
        let (u, v) = (u + left, v + top);
        let own = u32::try_from(u).ok().zip(u32::try_from(v).ok());
        let own = own.and_then(|(u, v)| digit.get_pixel_checked(u, v)).map_or(0, |p| p.0[0]);
        Luma([own.max(other(u, v))])
    };
    ImageBuffer::from_fn(width.max(1) as u32 + 2, height.max(1) as u32 + 2, pixel).into()
}
