use super::{GrayImage, Region, Regions};
use ::image::imageops;
use apex_rt::{Out, node};
use imageproc::edges::canny;

/// Edges in each region of an image (Canny 1986; thesis 4.3.1): 255 on an edge, 0 elsewhere.
#[node]
#[derive(Debug, Clone)]
pub struct Edges {
    /// Minimum gradient at which an edge begins. From black to white the gradient is about 1000.
    #[param(default = 150.0, range = 1.0..=1150.0)]
    high: f32,
    /// Minimum gradient at which an edge continues.
    #[param(default = 60.0, range = 1.0..=1150.0)]
    low: f32,
    /// Margin added around each region, in pixels.
    #[param(default = 4, range = 0..=1000)]
    margin: u32,
}

/// Minimum width and height of a region. The filters need a neighbourhood, so smaller regions have no edges.
const MIN_SIDE: u32 = 8;

#[node]
impl Edges {
    fn process(&mut self, image: &GrayImage, regions: &Regions, edges: &mut Out<GrayImage>) {
        let edges = edges.get_mut();
        edges.reset(image.stamp, image.size());
        for region in regions {
            let Region { left, top, width, height, .. } = region.grown(self.margin, image.size());
            if width < MIN_SIDE || height < MIN_SIDE {
                continue;
            }
            let part = imageops::crop_imm(&image.pixels, left, top, width, height).to_image();
            for (x, y, pixel) in canny(&part, self.low.min(self.high), self.high).enumerate_pixels() {
                if pixel.0[0] > 0 {
                    edges.pixels.put_pixel(left + x, top + y, *pixel);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ::image::{ImageBuffer, Luma};
    use apex_rt::Construct;

    #[test]
    fn edges_are_found_in_regions_only() {
        let step = GrayImage::from(ImageBuffer::from_fn(60, 40, |x, _| Luma([if x < 30 { 0 } else { 255 }])));
        let region = Region { left: 20, top: 10, width: 20, height: 10, area: 1 };
        let mut out = Out::new();
        Edges::construct((150.0, 60.0, 0)).process(&step, &[region].into(), &mut out);
        let found: Vec<(u32, u32)> = out
            .get()
            .expect("edges")
            .pixels
            .enumerate_pixels()
            .filter_map(|(x, y, p)| (p.0[0] == 255).then_some((x, y)))
            .collect();
        assert!(
            found.len() >= 8 && found.iter().all(|(x, y)| (29..=30).contains(x) && (10..20).contains(y)),
            "{found:?}"
        );
    }

    #[test]
    fn odd_regions_have_no_edges() {
        let flat = GrayImage::from(ImageBuffer::from_pixel(30, 30, Luma([9])));
        let odd = [Region::default(), Region { left: 29, top: 900, width: 5, height: u32::MAX, area: 0 }];
        let mut out = Out::new();
        for image in [&flat, &GrayImage::default()] {
            Edges::construct((1.0, 1000.0, 0)).process(image, &odd.into(), &mut out);
            assert!(out.get().is_some_and(|e| e.size() == image.size() && e.pixels.iter().all(|p| *p == 0)));
        }
    }
}
