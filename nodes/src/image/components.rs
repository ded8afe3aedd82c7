use super::{GrayImage, MAX_REGIONS, Region, Regions, light};
use apex_rt::{Out, node};
use std::cmp::Reverse;

/// Finds the objects in an image (thesis 4.3.1): connected components of light pixels, with the 8 neighbours of a
/// pixel.
///
/// At most [`MAX_REGIONS`] regions, those with the most pixels, from top to bottom; the list may be empty. Objects that
/// touch the border of the image are left out.
#[node]
#[derive(Debug, Clone)]
pub struct Components {
    /// Minimum intensity of a light pixel.
    #[param(default = 40, range = 1..=255)]
    threshold: u8,
    /// Minimum width and height, in pixels.
    #[param(default = 20, range = 1..=10_000)]
    min_side: u32,
    /// Maximum width and height, in pixels.
    #[param(default = 500, range = 1..=100_000)]
    max_side: u32,
    things: Things,
    found: Vec<Region>,
}

#[node]
impl Components {
    fn process(&mut self, image: &GrayImage, regions: &mut Out<Regions>) {
        self.things.find(image, self.threshold);
        let sides = self.min_side..=self.max_side;
        let (width, height) = image.size();
        let whole = |r: &Region| r.left > 0 && r.top > 0 && r.left + r.width < width && r.top + r.height < height;
        let fits = |r: &Region| sides.contains(&r.width) && sides.contains(&r.height) && whole(r);
        let found = &mut self.found;
        found.clear();
        found.extend(self.things.whole().map(|thing| thing.region).filter(fits));
        found.sort_by_key(|r| Reverse(r.area));
        found.truncate(MAX_REGIONS);
        found.sort_by_key(|r| (r.top, r.left));
        let regions = regions.get_mut();
        regions.clear();
        regions.extend(found.iter().copied());
    }
}

/// Run of consecutive light pixels in a row.
#[derive(Debug, Clone, Copy)]
struct Run {
    first: u32,
    end: u32,
    /// Number of the object that the pixels belong to.
    thing: usize,
}

/// Object of an image.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Thing {
    pub region: Region,
    /// Sums of the columns and rows of its pixels.
    pub sums: [u64; 2],
}

/// Objects of an image, found row by row (union-find).
#[derive(Debug, Clone, Default)]
pub(super) struct Things {
    /// Each object, with the number of the object that it was merged into: an earlier one, or itself.
    parts: Vec<(usize, Thing)>,
    /// Runs of the previous row, and of the current one.
    above: Vec<Run>,
    row: Vec<Run>,
}

impl Thing {
    fn joined(&self, other: &Self) -> Self {
        let sums = [0, 1].map(|i| self.sums[i] + other.sums[i]);
        Self { region: self.region.joined(&other.region), sums }
    }
}

impl Things {
    /// Finds the objects of pixels that are at least as light as the threshold.
    pub fn find(&mut self, image: &GrayImage, threshold: u8) {
        self.parts.clear();
        self.above.clear();
        for (y, row) in light::rows(image) {
            // Runs that end left of this run cannot touch any of the following runs either.
            let mut from = 0;
            for (first, end) in light::runs(row, threshold) {
                from += self.above[from..].iter().take_while(|above| above.end < first).count();
                let thing = self.thing(first, end, y, from);
                self.row.push(Run { first, end, thing });
            }
            std::mem::swap(&mut self.above, &mut self.row);
            self.row.clear();
        }
    }

    /// Object of a run: that of the touching runs above, including those at a corner, or a new one.
    fn thing(&mut self, first: u32, end: u32, y: u32, from: usize) -> usize {
        let number = self.parts.len();
        let region = Region { left: first, top: y, width: end - first, height: 1, area: end - first };
        let [first_column, count, row] = [first, end - first, y].map(u64::from);
        let sums = [count * first_column + count * (count - 1) / 2, count * row];
        self.parts.push((number, Thing { region, sums }));
        let touching = self.above[from..].iter().take_while(|above| above.first <= end).count();
        (from..from + touching).fold(number, |thing, i| self.join(thing, self.above[i].thing))
    }

    /// Merges two objects into the earlier one.
    fn join(&mut self, a: usize, b: usize) -> usize {
        let (a, b) = (self.root(a), self.root(b));
        let (thing, part) = (a.min(b), a.max(b));
        if thing < part {
            self.parts[part].0 = thing;
            self.parts[thing].1 = self.parts[thing].1.joined(&self.parts[part].1);
        }
        thing
    }

    /// Final object that an object was merged into. Halves the path for the next search.
    fn root(&mut self, mut thing: usize) -> usize {
        while self.parts[thing].0 != thing {
            self.parts[thing].0 = self.parts[self.parts[thing].0].0;
            thing = self.parts[thing].0;
        }
        thing
    }

    /// Objects that were not merged into others, in the order of their first pixels, row by row.
    pub fn whole(&self) -> impl Iterator<Item = Thing> {
        self.parts.iter().enumerate().filter(|(i, (root, _))| i == root).map(|(_, (_, thing))| *thing)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ::image::{ImageBuffer, Luma};
    use apex_rt::Construct;
    use imageproc::region_labelling::{Connectivity, connected_components};

    fn image(width: u32, height: u32, gray: impl Fn(u32, u32) -> u8) -> GrayImage {
        ImageBuffer::from_fn(width, height, |x, y| Luma([gray(x, y)])).into()
    }

    fn find(image: &GrayImage, threshold: u8, min_side: u32, max_side: u32) -> Regions {
        let mut out = Out::new();
        Components::construct((threshold, min_side, max_side)).process(image, &mut out);
        out.get().cloned().expect("a result")
    }

    #[test]
    fn components_are_boxes_around_what_hangs_together() {
        // A diagonal, a block, a pixel that is too small, and objects cut off by the border.
        let picture = image(30, 20, |x, y| match (x, y) {
            (2..8, 2..8) if x == y => 90,
            (15..20, 1..12) => 200,
            (27, 17) => 255,
            (0, 10..18) => 255,
            _ => 10,
        });
        let expected = [
            Region { left: 15, top: 1, width: 5, height: 11, area: 55 },
            Region { left: 2, top: 2, width: 6, height: 6, area: 6 },
        ];
        assert_eq!(find(&picture, 50, 5, 15), expected);
        assert_eq!(find(&GrayImage::default(), 50, 1, 9), []);
    }

    #[test]
    fn things_are_those_of_imageproc() {
        let mut random = crate::math::Random::new(1);
        for (width, height, rarity) in [(40, 30, 2), (70, 50, 3), (200, 60, 5), (1, 9, 2), (9, 1, 2)] {
            let noise =
                ImageBuffer::from_fn(width, height, |_, _| Luma([u8::from(random.bits().is_multiple_of(rarity))]));
            let labels = connected_components(&noise, Connectivity::Eight, Luma([0]));
            let mut expected: Vec<Region> = vec![];
            for (x, y, label) in labels.enumerate_pixels().filter(|(_, _, label)| label.0[0] > 0) {
                let pixel = Region { left: x, top: y, width: 1, height: 1, area: 1 };
                match expected.get_mut(label.0[0] as usize - 1) {
                    Some(region) => *region = region.joined(&pixel),
                    None => expected.push(pixel),
                }
            }
            let mut things = Things::default();
            things.find(&noise.into(), 1);
            let found: Vec<Region> = things.whole().map(|thing| thing.region).collect();
            assert_eq!(found, expected, "{width} x {height}, one of {rarity}");
        }
    }

    #[test]
    fn of_many_components_the_largest_stay() {
        let dots = image(200, 200, |x, y| {
            if x % 2 == 0 && y % 2 == 0 || (2..4).contains(&x) && (2..9).contains(&y) { 255 } else { 0 }
        });
        let regions = find(&dots, 1, 1, 300);
        assert_eq!((regions.len(), regions[0].top, regions[0].area > 8), (MAX_REGIONS, 2, true));
    }
}
