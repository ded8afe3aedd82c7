use super::{GrayImage, Region, light, window::Squares};
use apex_rt::{Out, node};

/// Extracts dark structures on light ground that are thinner than twice the radius (thesis 4.3.1): the morphological
/// closing by a square, minus the image. All other pixels become black.
///
/// Faster for images with more black pixels.
#[node]
#[derive(Debug, Clone)]
pub struct BlackHat {
    /// Half the side of the square, in pixels.
    #[param(default = 10, range = 1..=200)]
    radius: usize,
    part: Vec<u8>,
    squares: Squares,
}

#[node]
impl BlackHat {
    fn process(&mut self, image: &GrayImage, dark: &mut Out<GrayImage>) {
        let dark = dark.get_mut();
        dark.reset(image.stamp, image.size());
        let Some(bounds) = light::bounds(image) else { return };
        // The dilation reaches `radius` pixels beyond the light part. One more pixel is black, as is everything beyond
        // it.
        let part = bounds.grown(self.radius as u32 + 1, image.size());
        let width = part.width as usize;
        self.part.clear();
        rows(image, &part).for_each(|row| self.part.extend_from_slice(row));
        // The closing: a dilation, then an erosion.
        self.squares.lightest(&self.part, width, self.radius).write(&mut self.part);
        self.squares.darkest(&self.part, width, self.radius).write(&mut self.part);
        let whole = image.size().0 as usize;
        let hats = dark.pixels.chunks_exact_mut(whole).skip(part.top as usize);
        for ((hat, closed), original) in hats.zip(self.part.chunks_exact(width)).zip(rows(image, &part)) {
            let hat = &mut hat[part.left as usize..][..width];
            hat.iter_mut().zip(closed).zip(original).for_each(|((hat, closed), original)| *hat = closed - original);
        }
    }
}

/// Rows of a part of an image. The part must be inside the image.
fn rows<'a>(image: &'a GrayImage, part: &Region) -> impl Iterator<Item = &'a [u8]> + use<'a> {
    let (left, width) = (part.left as usize, part.width as usize);
    let all = image.pixels.as_raw().chunks_exact(image.size().0 as usize);
    all.skip(part.top as usize).take(part.height as usize).map(move |row| &row[left..][..width])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Random;
    use ::image::{ImageBuffer, Luma};
    use apex_rt::Construct;
    use imageproc::morphology::{Mask, grayscale_close};

    fn check(image: &GrayImage, radius: usize) {
        let mut out = Out::new();
        BlackHat::construct((radius,)).process(image, &mut out);
        let hat = out.get().expect("a result");
        let closed = grayscale_close(&image.pixels, &Mask::square(radius as u8));
        let same = |(x, y, p): (u32, u32, &Luma<u8>)| p.0[0] == closed[(x, y)].0[0] - image.pixels[(x, y)].0[0];
        assert!(hat.pixels.enumerate_pixels().all(same), "{image:?}, radius {radius}");
    }

    #[test]
    fn the_black_hat_is_that_of_imageproc() {
        let mut random = Random::new(1);
        for (width, height, radius) in [(30, 20, 1), (17, 40, 3), (5, 3, 10), (1, 1, 2)] {
            check(&ImageBuffer::from_fn(width, height, |_, _| Luma([random.bits() as u8])).into(), radius);
        }
    }

    #[test]
    fn so_it_is_where_most_is_black() {
        let mut random = Random::new(1);
        for (radius, left, top) in (0..200).map(|i| (1 + i % 4, i as u32 * 7 % 40, i as u32 * 11 % 30)) {
            let mut gray = |x: u32, y: u32| {
                let inside = (left..left + 9).contains(&x) && (top..top + 6).contains(&y);
                if inside { random.bits() as u8 } else { 0 }
            };
            check(&ImageBuffer::from_fn(50, 37, |x, y| Luma([gray(x, y)])).into(), radius);
        }
        check(&ImageBuffer::from_pixel(7, 5, Luma([0])).into(), 3);
        let mut out = Out::new();
        BlackHat::construct((3,)).process(&GrayImage::default(), &mut out);
        assert_eq!(out.get(), Some(&GrayImage::default()));
    }
}
