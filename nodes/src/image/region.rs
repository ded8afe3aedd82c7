use super::GrayImage;
use ::image::{GenericImageView, Luma};
use apex_rt::{Out, node};

/// Region of an image: an upright rectangle around an object.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Region {
    /// First column.
    pub left: u32,
    /// First row.
    pub top: u32,
    /// Number of columns.
    pub width: u32,
    /// Number of rows.
    pub height: u32,
    /// Number of pixels that belong to the object.
    pub area: u32,
}

/// Maximum number of regions of an image.
pub const MAX_REGIONS: usize = 64;

/// Regions of one image.
pub type Regions = heapless::Vec<Region, MAX_REGIONS>;

impl Region {
    /// Smallest rectangle around both objects.
    pub(super) fn joined(&self, other: &Self) -> Self {
        let (left, top) = (self.left.min(other.left), self.top.min(other.top));
        let (right, bottom) = (
            (self.left + self.width).max(other.left + other.width),
            (self.top + self.height).max(other.top + other.height),
        );
        Self { left, top, width: right - left, height: bottom - top, area: self.area + other.area }
    }

    /// Rectangle with `margin` more pixels on each side, clipped to an image of this width and height.
    #[must_use]
    pub fn grown(&self, margin: u32, (width, height): (u32, u32)) -> Self {
        let (left, top) = (self.left.saturating_sub(margin).min(width), self.top.saturating_sub(margin).min(height));
        let end = |first: u32, count: u32, end: u32| first.saturating_add(count).saturating_add(margin).min(end);
        let (right, bottom) = (end(self.left, self.width, width), end(self.top, self.height, height));
        Self { left, top, width: right.saturating_sub(left), height: bottom.saturating_sub(top), area: self.area }
    }

    /// Centre of the rectangle: u and v, in pixels.
    pub fn middle(&self) -> [f32; 2] {
        let middle = |first: u32, count: u32| first as f32 + 0.5 * (count as f32 - 1.0);
        [middle(self.left, self.width), middle(self.top, self.height)]
    }

    /// Returns `true` if a point of the image is in the rectangle.
    pub fn contains(&self, [u, v]: [f32; 2]) -> bool {
        let inside = |x: f32, first: u32, count: u32| x >= first as f32 && x < first as f32 + count as f32;
        inside(u, self.left, self.width) && inside(v, self.top, self.height)
    }
}

/// Region with the largest rectangle; the first one of equals. ⊥ without regions.
#[node]
pub fn largest(regions: &Regions) -> Option<Region> {
    let size = |region: &&Region| u64::from(region.width) * u64::from(region.height);
    regions.iter().rev().max_by_key(size).copied()
}

/// Stretches the intensities in each region, so that the darkest becomes black and the lightest white (thesis 4.3.1):
/// the following nodes do not depend on the light. The rest of the image is unchanged.
///
/// Where regions overlap, the last one counts.
#[node]
#[derive(Debug, Clone)]
pub struct Normalize {
    /// Margin added around each region, in pixels.
    #[param(default = 4, range = 0..=1000)]
    margin: u32,
    /// Share of the pixels that becomes completely black, and share that becomes completely white.
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

/// Lower and upper intensity with a share `tail` of all pixels beyond each.
fn bounds(pixels: impl Iterator<Item = u8>, tail: f32) -> (f32, f32) {
    let mut histogram = [0_u32; 256];
    pixels.for_each(|p| histogram[usize::from(p)] += 1);
    let limit = (histogram.iter().sum::<u32>() as f32 * tail) as u32;
    let bins = histogram.iter().copied().enumerate();
    (beyond(bins.clone(), limit).unwrap_or(0.0), beyond(bins.rev(), limit).unwrap_or(255.0))
}

/// First level with more than `limit` pixels up to and including it.
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
