use super::{Camera, GrayImage};
use crate::scan::{BeamDirections, Pose2, Scan};
use apex_rt::{Out, node};

/// Keeps the part of an image between two heights above the points of a laser scan and blackens the rest (thesis 4.3.1,
/// figure 4.3b): on a wall of known height, only the band with targets or signs remains.
///
/// Two neighbouring measured points, at both heights each, are the corners of a part of the band. The output is ⊥ if
/// the size of the image is not that of the camera. It is black if no measured point is in view.
#[node]
#[derive(Debug, Clone)]
pub struct LaserMask {
    /// Lower limit of the band, above the origin of the robot.
    #[param(unit = "m", default = 0.3, range = -10.0..=10.0)]
    low: f32,
    /// Upper limit of the band, above the origin of the robot.
    #[param(unit = "m", default = 0.65, range = -10.0..=10.0)]
    high: f32,
    /// Forward position of the scanner in the frame of the robot.
    #[param(unit = "m", default = 0.0, range = -10.0..=10.0)]
    scanner_x: f32,
    /// Position of the scanner to the left.
    #[param(unit = "m", default = 0.0, range = -10.0..=10.0)]
    scanner_y: f32,
    /// Rotation of the scanner to the left.
    #[param(unit = "rad", default = 0.0, range = -3.15..=3.15)]
    scanner_yaw: f32,
    directions: BeamDirections,
}

#[node]
impl LaserMask {
    fn process(&mut self, image: &GrayImage, camera: &Camera, scan: &Scan, masked: &mut Out<GrayImage>) {
        if !camera.takes(image.size()) {
            return;
        }
        let masked = masked.get_mut();
        masked.reset(image.stamp, image.size());
        let scanner = Pose2::new(self.scanner_x, self.scanner_y, self.scanner_yaw).transform();
        let mut before: Option<[[f32; 2]; 2]> = None;
        for (_, point) in self.directions.points(scan) {
            let point = scanner.to_outer(point);
            let at = |height| camera.project([point.x, point.y, height]);
            let column = at(self.low).zip(at(self.high)).map(|(low, high)| [low, high]);
            if let (Some([low, high]), Some([low_before, high_before])) = (column, before) {
                reveal(image, masked, &[low_before, low, high, high_before]);
            }
            before = column;
        }
    }
}

/// Copies the pixels inside a polygon, row by row.
fn reveal(image: &GrayImage, masked: &mut GrayImage, corners: &[[f32; 2]; 4]) {
    let (width, height) = image.size();
    let rows = pixels(corners.iter().map(|c| c[1]), height);
    for row in rows {
        let columns = pixels(crossings(corners, row as f32), width);
        let start = row as usize * width as usize;
        let span = start + columns.start as usize..start + columns.end as usize;
        // Few pixels: copied one by one, which is faster than as a block.
        let (to, from) = (&mut masked.pixels.as_mut()[span.clone()], &image.pixels.as_raw()[span]);
        to.iter_mut().zip(from).for_each(|(to, from)| *to = *from);
    }
}

/// Intersections of a row with the sides of a polygon. For a convex polygon their range is exact; otherwise it is too
/// wide.
fn crossings(corners: &[[f32; 2]; 4], row: f32) -> impl Iterator<Item = f32> {
    (0..4).filter_map(move |i| {
        let ([u, v], [u_next, v_next]) = (corners[i], corners[(i + 1) % 4]);
        let along = (row - v) / (v_next - v);
        (0.0..=1.0).contains(&along).then_some(u + along * (u_next - u))
    })
}

/// Pixels from the least to the greatest value, clipped to `0..count`.
fn pixels(values: impl Iterator<Item = f32>, count: u32) -> std::ops::Range<u32> {
    let (low, high) = values.fold((f32::MAX, f32::MIN), |(low, high), x| (low.min(x), high.max(x)));
    // Casts round towards zero and saturate.
    let end = if high < 0.0 { 0 } else { (high as u32).saturating_add(1).min(count) };
    (low as u32).min(end)..end
}

#[cfg(test)]
mod tests {
    use super::*;
    use ::image::{ImageBuffer, Luma};
    use apex_rt::Construct;

    fn wall(distance: f32) -> Scan {
        let mut scan = Scan { angle_min: -1.0, angle_increment: 0.02, ..Scan::default() };
        scan.ranges.extend((0..101).map(|i| distance / (-1.0 + 0.02 * i as f32).cos()));
        scan
    }

    fn mask(image: &GrayImage, camera: &Camera, scan: &Scan) -> Option<GrayImage> {
        let mut out = Out::new();
        LaserMask::construct((0.0, 0.35, 0.0, 0.0, 0.0)).process(image, camera, scan, &mut out);
        out.get().cloned()
    }

    #[test]
    fn a_wall_shows_a_band() {
        let camera = Camera { position: [0.0, 0.0, 0.5], ..Camera::new(64, 48, 1.0) };
        let white = GrayImage::from(ImageBuffer::from_pixel(64, 48, Luma([200])));
        let masked = mask(&white, &camera, &wall(2.0)).expect("an image");
        let [_, top] = camera.project([2.0, 0.0, 0.35]).expect("ahead");
        let [_, bottom] = camera.project([2.0, 0.0, 0.0]).expect("ahead");
        for (u, v, pixel) in masked.pixels.enumerate_pixels() {
            let (above, below) = ((v as f32) < top - 1.0, v as f32 > bottom + 1.0);
            let inside = v as f32 > top && (v as f32) < bottom;
            assert!(!(above || below) || pixel.0 == [0], "{u} {v}");
            assert!(!inside || pixel.0 == [200], "{u} {v}");
        }
    }

    #[test]
    fn what_cannot_be_seen_shows_nothing() {
        let camera = Camera::new(64, 48, 1.0);
        let white = GrayImage::from(ImageBuffer::from_pixel(64, 48, Luma([200])));
        let black = |scan: &Scan| mask(&white, &camera, scan).expect("an image").pixels.pixels().all(|p| p.0 == [0]);
        assert!(black(&Scan::default()));
        let mut behind = wall(2.0);
        behind.angle_min += std::f32::consts::PI;
        assert!(black(&behind));
        let mut odd = wall(1e-30);
        odd.ranges[50] = f32::NAN;
        odd.range_max = f32::INFINITY;
        mask(&white, &camera, &odd).expect("an image, of whatever");
        assert!(mask(&GrayImage::default(), &camera, &wall(2.0)).is_none());
        assert_eq!(mask(&GrayImage::default(), &Camera::default(), &wall(2.0)), Some(GrayImage::default()));
    }
}
