use super::GrayImage;
use ::image::{GenericImageView, Luma};
use apex_rt::{Out, node};
use imageproc::region_labelling::{Connectivity, connected_components};

/// The most regions of one image.
pub const MAX_REGIONS: usize = 64;

/// The regions of one image.
pub type Regions = heapless::Vec<Region, MAX_REGIONS>;

/// An upright rectangle of an image around something.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Region {
    /// The first column.
    pub left: u32,
    /// The first row.
    pub top: u32,
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// So many pixels of it belong to the thing.
    pub area: u32,
}

impl Region {
    /// The region of one pixel.
    const fn of(x: u32, y: u32) -> Self {
        Self { left: x, top: y, width: 1, height: 1, area: 1 }
    }

    /// Takes in a pixel that comes later, row by row.
    fn push(&mut self, x: u32, y: u32) {
        let right = (self.left + self.width).max(x + 1);
        self.left = self.left.min(x);
        self.width = right - self.left;
        self.height = y + 1 - self.top;
        self.area += 1;
    }

    /// The rectangle with `margin` more pixels to each side, as far as an image of this size has them.
    #[must_use]
    pub fn grown(&self, margin: u32, (width, height): (u32, u32)) -> Self {
        let (left, top) = (self.left.saturating_sub(margin).min(width), self.top.saturating_sub(margin).min(height));
        let end = |first: u32, count: u32, end: u32| first.saturating_add(count).saturating_add(margin).min(end);
        let (right, bottom) = (end(self.left, self.width, width), end(self.top, self.height, height));
        Self { left, top, width: right.saturating_sub(left), height: bottom.saturating_sub(top), area: self.area }
    }

    /// The place in its middle: u and v.
    pub fn middle(&self) -> [f32; 2] {
        let middle = |first: u32, count: u32| first as f32 + 0.5 * (count as f32 - 1.0);
        [middle(self.left, self.width), middle(self.top, self.height)]
    }

    /// Whether a place in the image lies in it.
    pub fn contains(&self, [u, v]: [f32; 2]) -> bool {
        let inside = |x: f32, first: u32, count: u32| x >= first as f32 && x < first as f32 + count as f32;
        inside(u, self.left, self.width) && inside(v, self.top, self.height)
    }
}

/// Shows dark things that are thinner than twice the radius, on light ground (thesis 4.3.1): the morphological closing
/// by a square, minus the image. Everything else becomes black.
#[node]
#[derive(Debug, Clone)]
pub struct BlackHat {
    /// Half the side of the square, in pixels.
    #[param(default = 10, range = 1..=200)]
    radius: usize,
    line: Vec<u8>,
    queue: Vec<usize>,
}

#[node]
impl BlackHat {
    fn process(&mut self, image: &GrayImage, dark: &mut Out<GrayImage>) {
        let dark = dark.get_mut();
        dark.clone_from(image);
        // Light is stretched, then what it swallowed comes back as far as it was large.
        self.extremes(dark, |a, b| a >= b);
        self.extremes(dark, |a, b| a <= b);
        for (closed, original) in dark.pixels.iter_mut().zip(image.pixels.iter()) {
            *closed = closed.saturating_sub(*original);
        }
    }

    /// Replaces each pixel by the one of the square around it that beats all others.
    fn extremes(&mut self, image: &mut GrayImage, beats: impl Fn(u8, u8) -> bool) {
        let (width, height) = (image.size().0 as usize, image.size().1 as usize);
        let pixels: &mut [u8] = image.pixels.as_mut();
        for row in 0..height {
            self.along(pixels, row * width, 1, width, &beats);
        }
        for column in 0..width {
            self.along(pixels, column, width, height, &beats);
        }
    }

    /// The same along one line of `count` pixels. Those that may still win wait in a queue, the best first
    /// (Lemire 2006).
    fn along(&mut self, pixels: &mut [u8], start: usize, step: usize, count: usize, beats: &impl Fn(u8, u8) -> bool) {
        self.line.clear();
        self.line.extend((0..count).map(|i| pixels[start + i * step]));
        self.queue.clear();
        let mut first = 0;
        for next in 0..count + self.radius {
            if next < count {
                while self.queue.len() > first && beats(self.line[next], self.line[self.queue[self.queue.len() - 1]]) {
                    self.queue.pop();
                }
                self.queue.push(next);
            }
            let Some(at) = next.checked_sub(self.radius) else { continue };
            while self.queue[first] + self.radius < at {
                first += 1;
            }
            pixels[start + at * step] = self.line[self.queue[first]];
        }
    }
}

/// Finds the things in an image (thesis 4.3.1): connected pixels that are light enough, neighbours by side or corner.
///
/// The [`MAX_REGIONS`] with the most pixels, in the order of their uppermost pixels; maybe none. What reaches the border
/// of the image is cut off there, and left out.
#[node]
#[derive(Debug, Clone)]
pub struct Components {
    /// The least intensity.
    #[param(default = 40, range = 1..=255)]
    threshold: u8,
    /// The least width and height, in pixels.
    #[param(default = 20, range = 1..=10_000)]
    min_side: u32,
    /// The largest width and height, in pixels.
    #[param(default = 500, range = 1..=100_000)]
    max_side: u32,
    found: Vec<Region>,
}

#[node]
impl Components {
    fn process(&mut self, image: &GrayImage, regions: &mut Out<Regions>) {
        let found = &mut self.found;
        found.clear();
        let mut light = image.pixels.clone();
        light.iter_mut().for_each(|pixel| *pixel = u8::from(*pixel >= self.threshold));
        let labels = connected_components(&light, Connectivity::Eight, Luma([0]));
        for (x, y, label) in labels.enumerate_pixels() {
            match label.0[0] as usize {
                0 => {}
                label if label > found.len() => found.push(Region::of(x, y)),
                label => found[label - 1].push(x, y),
            }
        }
        let sides = self.min_side..=self.max_side;
        let (width, height) = image.size();
        let whole = |r: &Region| r.left > 0 && r.top > 0 && r.left + r.width < width && r.top + r.height < height;
        found.retain(|r| sides.contains(&r.width) && sides.contains(&r.height) && whole(r));
        found.sort_by_key(|r| std::cmp::Reverse(r.area));
        found.truncate(MAX_REGIONS);
        found.sort_by_key(|r| (r.top, r.left));
        let regions = regions.get_mut();
        regions.clear();
        regions.extend(found.iter().copied());
    }
}

/// The region with the most pixels in its rectangle; the first of equal ones. ⊥ without regions.
#[node]
pub fn largest(regions: &Regions) -> Option<Region> {
    let size = |region: &&Region| u64::from(region.width) * u64::from(region.height);
    regions.iter().rev().max_by_key(size).copied()
}

/// Stretches the intensities in each region so that the darkest becomes black and the lightest white (thesis 4.3.1):
/// what follows does not depend on the light. The rest of the image stays as it is.
///
/// Where regions overlap, the last one counts.
#[node]
#[derive(Debug, Clone)]
pub struct Normalize {
    /// Pixels around each region that belong to it as well.
    #[param(default = 4, range = 0..=1000)]
    margin: u32,
    /// This part of the pixels at each end becomes all black or all white.
    #[param(default = 0.02, range = 0.0..=0.45)]
    tail: f32,
}

#[node]
impl Normalize {
    fn process(&mut self, image: &GrayImage, regions: &Regions, normal: &mut Out<GrayImage>) {
        let normal = normal.get_mut();
        normal.clone_from(image);
        for region in regions {
            let Region { left, top, width, height, .. } = region.grown(self.margin, image.size());
            if width == 0 || height == 0 {
                continue;
            }
            let source = image.pixels.view(left, top, width, height);
            let (low, high) = bounds(source.pixels().map(|(_, _, p)| p.0[0]), self.tail);
            for (x, y, pixel) in source.pixels() {
                let stretched = (f32::from(pixel.0[0]) - low) / (high - low).max(1.0) * 255.0;
                normal.pixels.put_pixel(left + x, top + y, Luma([stretched as u8]));
            }
        }
    }
}

/// The intensities with `tail` of all below and above.
fn bounds(pixels: impl Iterator<Item = u8>, tail: f32) -> (f32, f32) {
    let mut histogram = [0_u32; 256];
    pixels.for_each(|p| histogram[usize::from(p)] += 1);
    let limit = (histogram.iter().sum::<u32>() as f32 * tail) as u32;
    let bins = histogram.iter().copied().enumerate();
    (beyond(bins.clone(), limit).unwrap_or(0.0), beyond(bins.rev(), limit).unwrap_or(255.0))
}

/// The first level with more than `limit` pixels up to it.
fn beyond(bins: impl Iterator<Item = (usize, u32)>, limit: u32) -> Option<f32> {
    let mut sums = bins.scan(0, |sum, (level, count)| {
        *sum += count;
        Some((level, *sum))
    });
    sums.find(|(_, sum)| *sum > limit).map(|(level, _)| level as f32)
}

#[cfg(test)]
mod tests {
    use super::*;
    use ::image::ImageBuffer;
    use apex_rt::Construct;

    fn image(width: u32, height: u32, gray: impl Fn(u32, u32) -> u8) -> GrayImage {
        ImageBuffer::from_fn(width, height, |x, y| Luma([gray(x, y)])).into()
    }

    fn run<T: Clone>(node: impl FnOnce(&mut Out<T>)) -> T {
        let mut out = Out::new();
        node(&mut out);
        out.get().cloned().expect("a result")
    }

    #[test]
    fn the_black_hat_is_that_of_imageproc() {
        use imageproc::morphology::{Mask, grayscale_close};
        let mut random = crate::math::Random::new(1);
        for (width, height, radius) in [(30, 20, 1), (17, 40, 3), (5, 3, 10), (1, 1, 2)] {
            let noise = GrayImage::from(ImageBuffer::from_fn(width, height, |_, _| Luma([random.bits() as u8])));
            let hat = run(|out| BlackHat::construct((radius,)).process(&noise, out));
            let closed = grayscale_close(&noise.pixels, &Mask::square(radius as u8));
            let same = |(x, y, p): (u32, u32, &Luma<u8>)| p.0[0] == closed[(x, y)].0[0] - noise.pixels[(x, y)].0[0];
            assert!(hat.pixels.enumerate_pixels().all(same), "{width} x {height}, radius {radius}");
        }
    }

    #[test]
    fn components_are_boxes_around_what_hangs_together() {
        // A diagonal, a block, a pixel that is too small, and what the border cuts off.
        let picture = image(30, 20, |x, y| match (x, y) {
            (2..8, 2..8) if x == y => 90,
            (15..20, 1..12) => 200,
            (27, 17) => 255,
            (0, 10..18) => 255,
            _ => 10,
        });
        let regions = run(|out| Components::construct((50, 5, 15)).process(&picture, out));
        let expected = [
            Region { left: 15, top: 1, width: 5, height: 11, area: 55 },
            Region { left: 2, top: 2, width: 6, height: 6, area: 6 },
        ];
        assert_eq!(regions, expected);
        assert_eq!(run(|out| Components::construct((50, 1, 9)).process(&GrayImage::default(), out)), []);
    }

    #[test]
    fn of_many_components_the_largest_stay() {
        let dots = image(200, 200, |x, y| {
            if x % 2 == 0 && y % 2 == 0 || (2..4).contains(&x) && (2..9).contains(&y) { 255 } else { 0 }
        });
        let regions = run(|out| Components::construct((1, 1, 300)).process(&dots, out));
        assert_eq!((regions.len(), regions[0].top, regions[0].area > 8), (MAX_REGIONS, 2, true));
    }

    #[test]
    fn the_largest_region_is_the_first_of_equal_ones() {
        let region = |left: u32, width: u32| Region { left, top: 0, width, height: 5, area: 1 };
        let regions = [region(0, 3), region(1, 7), region(2, 7)].into();
        assert_eq!((largest(&regions), largest(&Regions::new())), (Some(region(1, 7)), None));
    }

    #[test]
    fn normal_regions_use_all_intensities() {
        let dim = image(40, 40, |x, y| 100 + ((x + y) % 20) as u8);
        let region = Region { left: 5, top: 5, width: 10, height: 10, area: 1 };
        let normal = run(|out| Normalize::construct((0, 0.0)).process(&dim, &[region].into(), out));
        let inside: Vec<u8> = normal.pixels.view(5, 5, 10, 10).pixels().map(|(_, _, p)| p.0[0]).collect();
        assert_eq!((inside.iter().min(), inside.iter().max()), (Some(&0), Some(&255)));
        assert_eq!(normal.pixels[(30, 30)], dim.pixels[(30, 30)]);
        let far = Region { left: u32::MAX, top: 3, width: u32::MAX, height: 9, area: 1 };
        assert_eq!(run(|out| Normalize::construct((7, 0.1)).process(&dim, &[far].into(), out)), dim);
    }
}
