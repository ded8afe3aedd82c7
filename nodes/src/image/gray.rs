use super::{ColorImage, GrayImage};
use apex_rt::{Out, node};

/// Weights of red, green and blue, in parts of 10,000 (ITU-R BT.709).
const WEIGHTS: [u16; 3] = [2126, 7152, 722];

/// Number of pixels that are converted at once.
const BLOCK: usize = 32;

/// Bytes of a block.
const BYTES: usize = 3 * BLOCK;

/// Luminance of a colour image (ITU-R BT.709).
#[node]
pub fn to_gray(image: &ColorImage, gray: &mut Out<GrayImage>) {
    let gray = gray.get_mut();
    gray.resize(image.stamp, image.size());
    let (blocks, rest) = image.pixels.as_raw().as_chunks::<BYTES>();
    let (gray_blocks, gray_rest) = gray.pixels.as_chunks_mut::<BLOCK>();
    for (gray, block) in gray_blocks.iter_mut().zip(blocks) {
        convert(gray, &planes(block));
    }
    for (gray, [red, green, blue]) in gray_rest.iter_mut().zip(rest.as_chunks().0) {
        *gray = luminance(*red, *green, *blue);
    }
}

fn convert(gray: &mut [u8; BLOCK], planes: &[u8; BYTES]) {
    let (red, others) = planes.split_at(BLOCK);
    let (green, blue) = others.split_at(BLOCK);
    for (((gray, red), green), blue) in gray.iter_mut().zip(red).zip(green).zip(blue) {
        *gray = luminance(*red, *green, *blue);
    }
}

/// Reds, then greens, then blues of a block of pixels.
///
/// A perfect shuffle moves byte i of n to 2i modulo n − 1. Five of them move byte 3i of 96 to i, as 32 · 3 = 96. Each
/// is a few instructions of any processor with vectors; to pick every third byte is not.
fn planes(block: &[u8; BYTES]) -> [u8; BYTES] {
    (0..BLOCK.ilog2()).fold(*block, |bytes, _| shuffled(&bytes))
}

/// Bytes of both halves in turn.
fn shuffled(bytes: &[u8; BYTES]) -> [u8; BYTES] {
    let (first, second) = bytes.split_at(BYTES / 2);
    let mut result = [0; BYTES];
    for ((pair, a), b) in result.chunks_exact_mut(2).zip(first).zip(second) {
        pair[0] = *a;
        pair[1] = *b;
    }
    result
}

/// Weighted mean, rounded down: an estimate that is wrong by one at most, and its correction. Numbers of 16 bits
/// suffice, because the remainder is small, and so known from its last 16 bits.
fn luminance(red: u8, green: u8, blue: u8) -> u8 {
    let [red, green, blue] = [red, green, blue].map(u16::from);
    let estimate = (54 * red + 183 * green + 19 * blue) >> 8;
    let [a, b, c] = WEIGHTS;
    let sum = a.wrapping_mul(red).wrapping_add(b.wrapping_mul(green)).wrapping_add(c.wrapping_mul(blue));
    let remainder = sum.wrapping_sub(estimate.wrapping_mul(10_000)) as i16;
    (estimate + u16::from(remainder >= 10_000) - u16::from(remainder < 0)) as u8
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{image::Image, math::Random};
    use ::image::{ImageBuffer, Luma, Pixel, Rgb};

    #[test]
    fn gray_is_as_light_as_the_colour_and_as_large() {
        let color = ColorImage::from(ImageBuffer::from_fn(3, 2, |x, y| Rgb([x as u8 * 100, y as u8 * 100, 0])));
        let mut out = Out::new();
        to_gray(&color, &mut out);
        let gray = out.get().expect("an image");
        assert_eq!((gray.size(), gray.pixels[(0, 0)]), ((3, 2), Luma([0])));
        assert!(gray.pixels[(0, 1)].0[0] > gray.pixels[(1, 0)].0[0], "green is lighter than red");
        to_gray(&ColorImage::default(), &mut out);
        assert_eq!(out.get().map(Image::size), Some((0, 0)));
    }

    #[test]
    fn gray_is_that_of_the_crate_image() {
        let (mut random, mut out) = (Random::new(1), Out::new());
        for (width, height) in [(1, 1), (1, 40), (3, 2), (31, 1), (32, 2), (33, 17), (97, 61)] {
            let color = ImageBuffer::from_fn(width, height, |_, _| {
                let bits = random.bits();
                Rgb([bits as u8, (bits >> 8) as u8, (bits >> 16) as u8])
            });
            to_gray(&ColorImage::from(color.clone()), &mut out);
            let expected = ImageBuffer::from_fn(width, height, |x, y| color[(x, y)].to_luma());
            assert_eq!(out.get().map(|gray| &gray.pixels), Some(&expected), "{width} x {height}");
        }
    }

    #[test]
    fn each_colour_has_its_luminance() {
        for color in 0..1_u32 << 24 {
            let [red, green, blue, _] = color.to_le_bytes();
            let sum: u32 = WEIGHTS.iter().zip([red, green, blue]).map(|(w, c)| u32::from(*w) * u32::from(c)).sum();
            assert!(u32::from(luminance(red, green, blue)) == sum / 10_000, "{red} {green} {blue}");
        }
    }
}
