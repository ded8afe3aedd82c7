use super::{GrayImage, Region, Regions, canny::Canny};
use apex_rt::{Out, node};

/// Edges in each region of an image (Canny 1986; thesis 4.3.1): 255 on an edge, 0 elsewhere.
///
/// The edges are those of OpenCV: of its `Canny` with `L2gradient`, after its `GaussianBlur` of 7 × 7 pixels with a
/// standard deviation of 1.4.
#[node]
#[derive(Debug, Clone)]
pub struct Edges {
    /// Gradient above which an edge begins. From black to white the gradient is about 1000.
    #[param(default = 150.0, range = 1.0..=1150.0)]
    high: f32,
    /// Gradient above which an edge continues.
    #[param(default = 60.0, range = 1.0..=1150.0)]
    low: f32,
    /// Margin added around each region, in pixels.
    #[param(default = 4, range = 0..=1000)]
    margin: u32,
    canny: Canny,
}

#[node]
impl Edges {
    fn process(&mut self, image: &GrayImage, regions: &Regions, edges: &mut Out<GrayImage>) {
        let edges = edges.get_mut();
        edges.reset(image.stamp, image.size());
        let stride = image.size().0 as usize;
        for region in regions {
            let Region { left, top, width, height, .. } = region.grown(self.margin, image.size());
            if width == 0 || height == 0 {
                continue;
            }
            let [left, top, width, height] = [left, top, width, height].map(|length| length as usize);
            let row = |y: usize| &image.pixels.as_raw()[(top + y) * stride + left..][..width];
            let found = self.canny.find((width, height), row, [self.low.min(self.high), self.high]);
            let rows = edges.pixels.chunks_exact_mut(stride).skip(top);
            for (to, found) in rows.zip(found) {
                to[left..][..width].iter_mut().zip(found).for_each(|(to, found)| *to |= found);
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
