use super::{ColorImage, GrayImage, Region, components::Things};
use ::image::Rgb;
use apex_rt::{Out, node};
use std::cmp::Reverse;

/// Maximum number of blobs of an image.
pub const MAX_BLOBS: usize = 64;

/// Blobs of one image.
pub type Blobs = heapless::Vec<Blob, MAX_BLOBS>;

/// Light area of an image, whose pixels touch each other.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Blob {
    /// Column of its centre of mass, in pixels.
    pub u: f32,
    /// Row of its centre of mass, in pixels.
    pub v: f32,
    /// Rectangle around it, and number of its pixels.
    pub region: Region,
}

/// Finds blobs (thesis figure 9.1): light areas, with the 8 neighbours of a pixel, and their centres of mass.
///
/// At most [`MAX_BLOBS`] blobs, the largest ones, from top to bottom; the list may be empty. Those that touch the
/// border of the image are blobs, too.
#[node]
#[derive(Debug, Clone)]
pub struct FindBlobs {
    /// Minimum intensity of a light pixel.
    #[param(default = 128, range = 1..=255)]
    threshold: u8,
    /// Minimum number of pixels.
    #[param(default = 50, range = 1..=100_000_000)]
    min_area: u32,
    /// Maximum number of pixels.
    #[param(default = 100_000, range = 1..=100_000_000)]
    max_area: u32,
    things: Things,
    found: Vec<Blob>,
}

#[node]
impl FindBlobs {
    fn process(&mut self, image: &GrayImage, blobs: &mut Out<Blobs>) {
        self.things.find(image, self.threshold);
        let sizes = self.min_area..=self.max_area;
        let all = self.things.whole().filter(|thing| sizes.contains(&thing.region.area));
        self.found.clear();
        self.found.extend(all.map(|thing| {
            let [u, v] = thing.sums.map(|sum| (sum as f64 / f64::from(thing.region.area)) as f32);
            Blob { u, v, region: thing.region }
        }));
        self.found.sort_unstable_by_key(|blob| (Reverse(blob.region.area), blob.region.top, blob.region.left));
        self.found.truncate(MAX_BLOBS);
        self.found.sort_unstable_by_key(|blob| (blob.region.top, blob.region.left));
        let blobs = blobs.get_mut();
        blobs.clear();
        blobs.extend(self.found.iter().copied());
    }
}

/// Colour of marks.
const MARK: Rgb<u8> = Rgb([255, 64, 0]);
/// Half the length of the lines of a cross, in pixels.
const ARM: i64 = 4;

/// Marks blobs in an image, for people: a rectangle around each, and a cross at its centre.
#[node]
#[derive(Debug, Clone, Default)]
pub struct MarkBlobs;

#[node]
impl MarkBlobs {
    fn process(&mut self, image: &GrayImage, blobs: &Blobs, marked: &mut Out<ColorImage>) {
        let marked = marked.get_mut();
        marked.reset(image.stamp, image.size());
        for (color, gray) in marked.pixels.pixels_mut().zip(image.pixels.pixels()) {
            *color = Rgb([gray.0[0]; 3]);
        }
        for Blob { u, v, region } in blobs {
            let [left, top, width, height] = [region.left, region.top, region.width, region.height].map(i64::from);
            let (right, bottom) = (left + width, top + height);
            let [columns, rows] = [marked.size().0, marked.size().1].map(i64::from);
            for x in left - 1..=right.min(columns) {
                put(marked, x, top - 1);
                put(marked, x, bottom);
            }
            for y in top - 1..=bottom.min(rows) {
                put(marked, left - 1, y);
                put(marked, right, y);
            }
            for arm in -ARM..=ARM {
                put(marked, u.round() as i64 + arm, v.round() as i64);
                put(marked, u.round() as i64, v.round() as i64 + arm);
            }
        }
    }
}

/// Marks a pixel, if it is in the image.
fn put(image: &mut ColorImage, x: i64, y: i64) {
    let pixel = u32::try_from(x).ok().zip(u32::try_from(y).ok());
    if let Some(pixel) = pixel.and_then(|(x, y)| image.pixels.get_pixel_mut_checked(x, y)) {
        *pixel = MARK;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ::image::{ImageBuffer, Luma};
    use apex_rt::Construct;

    fn image(rows: &[&str]) -> GrayImage {
        let light = |x: u32, y: u32| rows[y as usize].as_bytes()[x as usize] == b'#';
        let pixel = |x, y| Luma([if light(x, y) { 255 } else { 0 }]);
        ImageBuffer::from_fn(rows[0].len() as u32, rows.len() as u32, pixel).into()
    }

    fn find(image: &GrayImage, min_area: u32, max_area: u32) -> Blobs {
        let mut out = Out::new();
        FindBlobs::construct((128, min_area, max_area)).process(image, &mut out);
        out.get().expect("a list").clone()
    }

    #[test]
    fn blobs_have_their_centre_of_mass() {
        let picture = image(&["##........", "##...####.", ".....#....", "...#.#....", "..#..#...."]);
        let region = |left, top, width, height, area| Region { left, top, width, height, area };
        let expected = [
            Blob { u: 0.5, v: 0.5, region: region(0, 0, 2, 2, 4) },
            Blob { u: 41.0 / 7.0, v: 13.0 / 7.0, region: region(5, 1, 4, 4, 7) },
            Blob { u: 2.5, v: 3.5, region: region(2, 3, 2, 2, 2) },
        ];
        assert_eq!(find(&picture, 1, 99), expected);
        assert_eq!(find(&picture, 3, 5), expected[..1]);
        assert_eq!(find(&GrayImage::default(), 1, 99), []);
    }

    #[test]
    fn the_largest_stay() {
        let dots = GrayImage::from(ImageBuffer::from_fn(200, 40, |x, y| {
            Luma([if x % 2 == 0 && y % 2 == 0 || (100..102).contains(&x) && y > 30 { 255 } else { 0 }])
        }));
        let blobs = find(&dots, 1, 1000);
        assert_eq!(blobs.len(), MAX_BLOBS);
        assert!(blobs.iter().any(|blob| blob.region.area > 15) && blobs.is_sorted_by_key(|blob| blob.region.top));
    }

    #[test]
    fn marks_stay_in_the_image() {
        let picture = image(&["##..", "##..", "...."]);
        let blobs = find(&picture, 1, 99);
        let mut out = Out::new();
        MarkBlobs.process(&picture, &blobs, &mut out);
        let marked = out.get().expect("an image");
        assert_eq!((marked.size(), marked.pixels[(2, 0)], marked.pixels[(3, 0)]), ((4, 3), MARK, Rgb([0; 3])));
        let far = Blob { u: f32::NAN, v: 1e9, region: Region { left: u32::MAX, top: 0, width: 1, height: 1, area: 1 } };
        MarkBlobs.process(&picture, &[far].into(), &mut out);
        MarkBlobs.process(&GrayImage::default(), &[far].into(), &mut out);
        assert_eq!(out.get().map(ColorImage::size), Some((0, 0)));
    }
}
