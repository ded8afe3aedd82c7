use super::GrayImage;
use apex_rt::{Out, node};

/// Threshold that follows the light (thesis figure 9.1): a pixel becomes white if it differs from the mean of the
/// square around it by at least `offset`, and black otherwise. With `dark` these are the pixels that are darker, and
/// without it those that are lighter.
///
/// The mean is rounded, and pixels beyond the border are those of the border, as with `adaptiveThreshold` of OpenCV:
/// its `ADAPTIVE_THRESH_MEAN_C` with `THRESH_BINARY_INV` and `C = offset`, or with `THRESH_BINARY` and `C = 1 -
/// offset`. The time does not depend on the radius.
#[node]
#[derive(Debug, Clone)]
pub struct AdaptiveThreshold {
    /// Half the side of the square, in pixels.
    #[param(default = 15, range = 1..=200)]
    radius: usize,
    /// Minimum difference from the mean, of 255.
    #[param(default = 10, range = 1..=255)]
    offset: u8,
    /// `true` for pixels that are darker than the mean.
    #[param(default = true)]
    dark: bool,
    /// Sums of the pixels of each column in the rows about the current one, with a frame of `radius` columns.
    columns: Vec<u32>,
    /// Sums of the squares about the pixels of the current row.
    sums: Vec<u32>,
}

#[node]
impl AdaptiveThreshold {
    fn process(&mut self, image: &GrayImage, binary: &mut Out<GrayImage>) {
        let binary = binary.get_mut();
        binary.reset(image.stamp, image.size());
        let [width, height] = [image.size().0, image.size().1].map(|side| side as usize);
        if width == 0 || height == 0 {
            return;
        }
        let radius = self.radius;
        let pixels = image.pixels.as_raw();
        let row = |y: isize| &pixels[y.clamp(0, height as isize - 1) as usize * width..][..width];
        self.columns.clear();
        self.columns.resize(width + 2 * radius, 0);
        for y in -(radius as isize)..=radius as isize {
            add(&mut self.columns[radius..][..width], row(y));
        }
        for (y, to) in binary.pixels.chunks_exact_mut(width).enumerate() {
            self.sum_up(width);
            self.compare(&pixels[y * width..][..width], to);
            let (next, last) = (row((y + radius + 1) as isize), row(y as isize - radius as isize));
            let inner = &mut self.columns[radius..][..width];
            for ((sum, next), last) in inner.iter_mut().zip(next).zip(last) {
                *sum = sum.wrapping_add(u32::from(*next)).wrapping_sub(u32::from(*last));
            }
        }
    }

    /// Sums up the columns about each pixel of a row.
    fn sum_up(&mut self, width: usize) {
        let radius = self.radius;
        let [first, last] = [radius, radius + width - 1].map(|at| self.columns[at]);
        self.columns[..radius].fill(first);
        self.columns[radius + width..].fill(last);
        let side = 2 * radius + 1;
        let mut sum: u32 = self.columns[..side].iter().sum();
        self.sums.clear();
        self.sums.push(sum);
        let (leaves, comes) = (&self.columns[..width - 1], &self.columns[side..]);
        self.sums.extend(leaves.iter().zip(comes).map(|(leaves, comes)| {
            // In this order one addition waits for the last one, not two.
            sum = sum.wrapping_add(comes.wrapping_sub(*leaves));
            sum
        }));
    }

    /// Compares the pixels of a row with their means.
    fn compare(&self, row: &[u8], to: &mut [u8]) {
        let (count, offset) = (((2 * self.radius + 1) * (2 * self.radius + 1)) as i32, i32::from(self.offset));
        // The rounded mean m of a sum s of n pixels is the whole part of (2 s + n) / (2 n): a number k is at most m if
        // 2 n k ≤ 2 s + n.
        let pixels = to.iter_mut().zip(row).zip(&self.sums);
        let doubled = |sum: &u32| 2 * *sum as i32 + count;
        if self.dark {
            pixels.for_each(|((to, pixel), sum)| {
                *to = if 2 * count * (i32::from(*pixel) + offset) <= doubled(sum) { 255 } else { 0 };
            });
        } else {
            pixels.for_each(|((to, pixel), sum)| {
                *to = if 2 * count * (i32::from(*pixel) - offset + 1) > doubled(sum) { 255 } else { 0 };
            });
        }
    }
}

/// Adds the pixels of a row to the sums of their columns.
fn add(sums: &mut [u32], row: &[u8]) {
    sums.iter_mut().zip(row).for_each(|(sum, pixel)| *sum += u32::from(*pixel));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Random;
    use ::image::{ImageBuffer, Luma};
    use apex_rt::Construct;

    fn threshold(image: &GrayImage, radius: usize, offset: u8, dark: bool) -> GrayImage {
        let mut out = Out::new();
        AdaptiveThreshold::construct((radius, offset, dark)).process(image, &mut out);
        out.get().expect("an image").clone()
    }

    /// Numbers of OpenCV 5.0: `cv2.adaptiveThreshold(image, 255, cv2.ADAPTIVE_THRESH_MEAN_C, …)` for the image
    /// `(37 * x * x + 91 * y + 13 * x * y) % 256` of 8 × 6 pixels; one bit for each pixel of a row.
    #[test]
    fn thresholds_are_those_of_opencv() {
        let image = ImageBuffer::from_fn(8, 6, |x, y| Luma([((37 * x * x + 91 * y + 13 * x * y) % 256) as u8])).into();
        let bits = |image: GrayImage| {
            let row = |row: &[u8]| row.iter().fold(0_u8, |bits, pixel| bits << 1 | u8::from(*pixel == 255));
            image.pixels.as_raw().chunks_exact(8).map(row).collect::<Vec<_>>()
        };
        assert_eq!(bits(threshold(&image, 1, 10, true)), DARK);
        assert_eq!(bits(threshold(&image, 2, 20, false)), LIGHT);
    }

    const DARK: [u8; 6] = [0b11011011, 0b10100100, 0b00111000, 0b11000111, 0b00110100, 0b01001011];
    const LIGHT: [u8; 6] = [0b00100100, 0b01011011, 0b11000100, 0b00111000, 0b01000011, 0b10110100];

    #[test]
    fn thresholds_are_what_the_squares_say() {
        let mut random = Random::new(1);
        for (width, height, radius) in [(30, 20, 1), (17, 40, 3), (5, 3, 10), (1, 1, 2), (70, 9, 200)] {
            let image = GrayImage::from(ImageBuffer::from_fn(width, height, |_, _| Luma([random.bits() as u8])));
            let mean = |x: u32, y: u32| {
                let reach = -(radius as i64)..=radius as i64;
                let near = |at: u32, by: i64, end: u32| (i64::from(at) + by).clamp(0, i64::from(end) - 1) as u32;
                let squares = reach.clone().flat_map(|dy| reach.clone().map(move |dx| (dx, dy)));
                let pixel = |(dx, dy)| u32::from(image.pixels[(near(x, dx, width), near(y, dy, height))].0[0]);
                let count = (2 * radius as u32 + 1).pow(2) as f64;
                (f64::from(squares.map(pixel).sum::<u32>()) / count).round() as i32
            };
            for (offset, dark) in [(1, true), (30, true), (1, false), (30, false)] {
                for (x, y, found) in threshold(&image, radius, offset, dark).pixels.enumerate_pixels() {
                    let above = i32::from(image.pixels[(x, y)].0[0]) - mean(x, y);
                    let is_white = if dark { -above } else { above } >= i32::from(offset);
                    assert_eq!(found.0[0] == 255, is_white, "{x} {y} of {width} x {height}, {radius} {offset} {dark}");
                }
            }
        }
        assert_eq!(threshold(&GrayImage::default(), 3, 9, true), GrayImage::default());
    }
}
