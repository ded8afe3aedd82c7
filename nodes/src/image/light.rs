//! Search for light pixels. Most pixels of many images are black and are skipped in blocks.

use super::{GrayImage, Region};

/// Number of pixels that are compared in one block.
const BLOCK: usize = 64;

/// Bounding rectangle of all pixels that are not black, with an area of 0, or `None` if all are black.
pub fn bounds(image: &GrayImage) -> Option<Region> {
    let mut columns = vec![0; image.size().0 as usize];
    let mut rows = rows(image).map(|(_, row)| {
        columns.iter_mut().zip(row).for_each(|(sum, pixel)| *sum |= pixel);
        lightest(row) > 0
    });
    let (top, height) = extent(&mut rows)?;
    drop(rows);
    let (left, width) = extent(columns.iter().map(|sum| *sum > 0))?;
    Some(Region { left, top, width, height, area: 0 })
}

/// Rows of an image with their indices; none if the image has no columns.
pub fn rows(image: &GrayImage) -> impl Iterator<Item = (u32, &[u8])> {
    (0..).zip(image.pixels.as_raw().chunks_exact(image.size().0.max(1) as usize))
}

/// Runs of pixels of a row that are at least as light as the threshold: index of the first pixel, and of the one after
/// the last.
pub fn runs(row: &[u8], threshold: u8) -> impl Iterator<Item = (u32, u32)> {
    let mut next = 0;
    std::iter::from_fn(move || {
        let blocks = row[next..].chunks_exact(BLOCK);
        next += BLOCK * blocks.take_while(|block| lightest(block) < threshold).count();
        let first = next + row[next..].iter().position(|pixel| *pixel >= threshold)?;
        next = row[first..].iter().position(|pixel| *pixel < threshold).map_or(row.len(), |count| first + count);
        Some((first as u32, next as u32))
    })
}

fn lightest(pixels: &[u8]) -> u8 {
    pixels.iter().fold(0, |lightest, pixel| lightest.max(*pixel))
}

/// Index of the first `true`, and the number of values from there to the last `true`.
fn extent(holds: impl Iterator<Item = bool>) -> Option<(u32, u32)> {
    let numbers = (0..).zip(holds).filter_map(|(number, holds)| holds.then_some(number));
    let (first, last) = numbers.fold((None, 0), |(first, _), number| (first.or(Some(number)), number));
    first.map(|first: u32| (first, last + 1 - first))
}

#[cfg(test)]
mod tests {
    use super::*;
    use ::image::{ImageBuffer, Luma};

    #[test]
    fn bounds_are_around_all_that_is_not_black() {
        let mut image = GrayImage::from(ImageBuffer::from_pixel(200, 90, Luma([0])));
        assert_eq!((bounds(&image), bounds(&GrayImage::default())), (None, None));
        image.pixels.put_pixel(150, 20, Luma([1]));
        assert_eq!(bounds(&image), Some(Region { left: 150, top: 20, width: 1, height: 1, area: 0 }));
        image.pixels.put_pixel(0, 89, Luma([9]));
        assert_eq!(bounds(&image), Some(Region { left: 0, top: 20, width: 151, height: 70, area: 0 }));
    }

    #[test]
    fn runs_are_what_single_pixels_say() {
        let mut random = crate::math::Random::new(1);
        for rarity in [2, 9, 300] {
            let row: Vec<u8> = (0..500).map(|_| if random.bits().is_multiple_of(rarity) { 7 } else { 6 }).collect();
            let mut light = vec![6; row.len()];
            runs(&row, 7).for_each(|(first, end)| light[first as usize..end as usize].fill(7));
            assert_eq!(light, row);
            assert!(runs(&row, 7).zip(runs(&row, 7).skip(1)).all(|(a, b)| a.1 < b.0), "none touches the next");
            assert_eq!((runs(&row, 8).count(), runs(&row, 6).next()), (0, Some((0, 500))));
        }
    }
}
