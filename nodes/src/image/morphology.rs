use super::{GrayImage, window::Squares};
use apex_rt::{Out, node};

/// Replaces each pixel by the darkest one of the square around it (erosion, thesis figure 9.1): light areas shrink, and
/// those narrower than the square vanish.
///
/// Pixels beyond the border do not count, as with OpenCV. The time grows with the logarithm of the radius.
#[node]
#[derive(Debug, Clone)]
pub struct Erode {
    /// Half the side of the square, in pixels.
    #[param(default = 1, range = 0..=200)]
    radius: usize,
    squares: Squares,
}

#[node]
impl Erode {
    fn process(&mut self, image: &GrayImage, result: &mut Out<GrayImage>) {
        let (result, width) = (result.get_mut(), image.size().0 as usize);
        result.resize(image.stamp, image.size());
        self.squares.darkest(&image.pixels, width, self.radius).write(&mut result.pixels);
    }
}

/// Replaces each pixel by the lightest one of the square around it (dilation): light areas grow, and gaps narrower than
/// the square vanish.
#[node]
#[derive(Debug, Clone)]
pub struct Dilate {
    /// Half the side of the square, in pixels.
    #[param(default = 1, range = 0..=200)]
    radius: usize,
    squares: Squares,
}

#[node]
impl Dilate {
    fn process(&mut self, image: &GrayImage, result: &mut Out<GrayImage>) {
        let (result, width) = (result.get_mut(), image.size().0 as usize);
        result.resize(image.stamp, image.size());
        self.squares.lightest(&image.pixels, width, self.radius).write(&mut result.pixels);
    }
}

/// Removes light areas that are narrower than the square, such as noise, and leaves the others as they are: an erosion,
/// then a dilation.
#[node]
#[derive(Debug, Clone)]
pub struct Open {
    /// Half the side of the square, in pixels.
    #[param(default = 1, range = 0..=200)]
    radius: usize,
    squares: Squares,
}

#[node]
impl Open {
    fn process(&mut self, image: &GrayImage, result: &mut Out<GrayImage>) {
        let (result, width) = (result.get_mut(), image.size().0 as usize);
        result.resize(image.stamp, image.size());
        self.squares.darkest(&image.pixels, width, self.radius).write(&mut result.pixels);
        self.squares.lightest(&result.pixels, width, self.radius).write(&mut result.pixels);
    }
}

/// Closes gaps and holes of light areas that are narrower than the square: a dilation, then an erosion.
#[node]
#[derive(Debug, Clone)]
pub struct Close {
    /// Half the side of the square, in pixels.
    #[param(default = 1, range = 0..=200)]
    radius: usize,
    squares: Squares,
}

#[node]
impl Close {
    fn process(&mut self, image: &GrayImage, result: &mut Out<GrayImage>) {
        let (result, width) = (result.get_mut(), image.size().0 as usize);
        result.resize(image.stamp, image.size());
        self.squares.lightest(&image.pixels, width, self.radius).write(&mut result.pixels);
        self.squares.darkest(&result.pixels, width, self.radius).write(&mut result.pixels);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Random;
    use ::image::{ImageBuffer, Luma};
    use apex_rt::Construct;
    use imageproc::morphology::{Mask, grayscale_close, grayscale_dilate, grayscale_erode, grayscale_open};

    #[test]
    fn results_are_those_of_imageproc() {
        let mut random = Random::new(1);
        for (width, height, radius) in [(30, 20, 1), (17, 40, 3), (5, 3, 10), (1, 1, 2), (9, 9, 0)] {
            let image = GrayImage::from(ImageBuffer::from_fn(width, height, |_, _| Luma([random.bits() as u8])));
            let mask = Mask::square(radius as u8);
            /// Compares a node with a function.
            macro_rules! same {
                ($node:ident, $reference:ident) => {
                    let mut out = Out::new();
                    $node::construct((radius,)).process(&image, &mut out);
                    let expected = $reference(&image.pixels, &mask);
                    assert_eq!(out.get().map(|image| &image.pixels), Some(&expected), "{width} x {height}, {radius}");
                };
            }
            same!(Erode, grayscale_erode);
            same!(Dilate, grayscale_dilate);
            same!(Open, grayscale_open);
            same!(Close, grayscale_close);
        }
        let mut out = Out::new();
        Open::construct((3,)).process(&GrayImage::default(), &mut out);
        assert_eq!(out.get(), Some(&GrayImage::default()));
    }
}
