use ::image::{ImageBuffer, Luma, Pixel, Rgb};
use apex_rt::Time;
use std::fmt;

/// Image with a time stamp. The default has no pixels.
pub struct Image<P: Pixel> {
    /// Time of the exposure.
    pub stamp: Time,
    /// Pixels, row by row from the top, each row from the left.
    pub pixels: ImageBuffer<P, Vec<P::Subpixel>>,
}

/// Greyscale image with intensities from 0 (black) to 255 (white).
pub type GrayImage = Image<Luma<u8>>;

/// Colour image with red, green and blue from 0 to 255.
pub type ColorImage = Image<Rgb<u8>>;

impl<P: Pixel> Image<P> {
    /// Width and height, in pixels.
    pub fn size(&self) -> (u32, u32) {
        self.pixels.dimensions()
    }

    /// Replaces the content by a black image (all zeros) of this width and height. Reuses the allocated storage.
    pub fn reset(&mut self, stamp: Time, (width, height): (u32, u32)) {
        self.resize(stamp, (width, height));
        self.pixels.fill(::image::Primitive::DEFAULT_MIN_VALUE);
    }

    /// Changes the size, like `reset`, but leaves any colours in the pixels.
    pub(crate) fn resize(&mut self, stamp: Time, (width, height): (u32, u32)) {
        self.stamp = stamp;
        let mut storage = std::mem::take(&mut self.pixels).into_raw();
        let samples = width as usize * height as usize * usize::from(P::CHANNEL_COUNT);
        storage.resize(samples, ::image::Primitive::DEFAULT_MIN_VALUE);
        self.pixels = ImageBuffer::from_raw(width, height, storage).unwrap_or_default();
    }
}

/// `clone_from` reuses the allocated storage.
impl<P: Pixel> Clone for Image<P> {
    fn clone(&self) -> Self {
        Self { stamp: self.stamp, pixels: self.pixels.clone() }
    }

    fn clone_from(&mut self, source: &Self) {
        self.stamp = source.stamp;
        self.pixels.clone_from(&source.pixels);
    }
}

/// An image without pixels.
impl<P: Pixel> Default for Image<P> {
    fn default() -> Self {
        Self { stamp: Time::ZERO, pixels: ImageBuffer::default() }
    }
}

impl<P: Pixel> PartialEq for Image<P> {
    fn eq(&self, other: &Self) -> bool {
        self.stamp == other.stamp && self.size() == other.size() && self.pixels.as_raw() == other.pixels.as_raw()
    }
}

/// Shows the size instead of the pixels.
impl<P: Pixel> fmt::Debug for Image<P> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (width, height) = self.size();
        f.debug_struct("Image").field("stamp", &self.stamp).field("width", &width).field("height", &height).finish()
    }
}

impl<P: Pixel> From<ImageBuffer<P, Vec<P::Subpixel>>> for Image<P> {
    fn from(pixels: ImageBuffer<P, Vec<P::Subpixel>>) -> Self {
        Self { stamp: Time::ZERO, pixels }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_image_is_overwritten_in_its_storage() {
        let mut image = GrayImage::from(ImageBuffer::from_pixel(4, 4, Luma([7])));
        let storage = image.pixels.as_raw().as_ptr();
        image.reset(Time::from_millis(3), (2, 5));
        assert_eq!((image.size(), image.pixels.as_raw().as_ptr()), ((2, 5), storage));
        assert!(image.pixels.pixels().all(|p| p.0 == [0]));
        let small = GrayImage::from(ImageBuffer::from_pixel(2, 1, Luma([1])));
        image.clone_from(&small);
        assert_eq!((&image, image.pixels.as_raw().as_ptr()), (&small, storage));
    }
}
