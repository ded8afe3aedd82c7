use crate::{
    Random, Scene,
    scene::{Hit, Look},
};
use apex_nodes::{
    image::{Camera, GrayImage},
    nav::Twist,
    scan::{Point2, Pose2},
};
use apex_rt::Time;

/// Lighting of an image.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Light {
    /// Factor of all brightnesses.
    pub gain: f32,
    /// Horizontal gradient of the brightness: 0.2 is 10 % more at the left side and 10 % less at the right.
    pub slope: f32,
    /// Offset of all brightnesses, 0 to 255: fog on the lens.
    pub haze: f32,
}

/// Simulated level camera that takes images of a [`Scene`].
#[derive(Debug, Clone)]
pub struct CameraSim {
    camera: Camera,
    /// Exposure time, in s. Rotation during the exposure blurs the image.
    pub exposure: f32,
    /// Standard deviation of the brightness of a pixel, of 255.
    pub noise: f32,
    /// Image in the order of drawing, column by column, as walls are upright.
    columns: Vec<u8>,
    row: Vec<u8>,
}

/// Error of a camera that is not level. Its images cannot be rendered, as walls would not be upright in them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NotLevel(pub Camera);

impl core::fmt::Display for NotLevel {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(f, "images of a camera with a pitch of {} rad cannot be made: only those of level ones", self.0.pitch)
    }
}

impl core::error::Error for NotLevel {}

/// Unchanged brightnesses.
impl Default for Light {
    fn default() -> Self {
        Self { gain: 1.0, slope: 0.0, haze: 0.0 }
    }
}

impl CameraSim {
    /// Creates a camera with an exposure of 10 ms and a noise of 2.
    ///
    /// # Errors
    /// If the camera is not level.
    pub fn new(camera: Camera) -> Result<Self, NotLevel> {
        if camera.pitch != 0.0 {
            return Err(NotLevel(camera));
        }
        Ok(Self { camera, exposure: 0.01, noise: 2.0, columns: vec![], row: vec![] })
    }

    /// Replaces `image` by the image of `scene` when the robot is at `pose` and moves with `twist`. Only the rotation
    /// blurs the image.
    #[allow(clippy::too_many_arguments, reason = "all of them make an image")]
    pub fn take(
        &mut self,
        scene: &Scene,
        pose: &Pose2,
        twist: &Twist,
        light: &Light,
        stamp: Time,
        random: &mut Random,
        image: &mut GrayImage,
    ) {
        let camera = self.camera;
        image.reset(stamp, (camera.width, camera.height));
        let origin = pose.to_outer(Point2::new(camera.position[0], camera.position[1]));
        let ahead = Pose2 { theta: pose.theta + camera.yaw, ..Pose2::default() };
        let (mut hits, mut columns) = (vec![], std::mem::take(&mut self.columns));
        columns.resize(camera.width as usize * camera.height as usize, 0);
        for (u, column) in columns.chunks_exact_mut(camera.height.max(1) as usize).enumerate() {
            let left = (camera.principal_point[0] - u as f32) / camera.focal_length;
            scene.look(origin, ahead.to_outer(Point2::new(1.0, left)), &mut hits);
            self.column(scene, &hits, column);
        }
        transpose(&columns, camera.height as usize, &mut image.pixels);
        self.columns = columns;
        self.blur(twist.omega.abs() * self.exposure * camera.focal_length, image);
        expose(light, self.noise, random, image);
    }

    /// Row of the image that shows a height above the floor at a distance.
    fn row_of(&self, height: f32, distance: f32) -> f32 {
        self.camera.principal_point[1] - self.camera.focal_length * (height - self.camera.position[2]) / distance
    }

    /// Draws a column from the farthest object to the nearest.
    fn column(&self, scene: &Scene, hits: &[Hit<'_>], column: &mut [u8]) {
        let rows = column.len();
        let row = |v: f32| (v.ceil().max(0.0) as usize).min(rows);
        let (above, below) = column.split_at_mut(row(self.camera.principal_point[1]));
        above.fill(scene.sky);
        below.fill(scene.floor);
        for hit in hits {
            let (top, bottom) = (self.row_of(hit.top, hit.distance), self.row_of(hit.bottom, hit.distance));
            let Some(drawn) = column.get_mut(row(top)..row(bottom)) else { continue };
            match hit.look {
                Look::Plain(brightness) => drawn.fill(*brightness),
                Look::Picture(picture) => {
                    let Some(level) = picture.at_width(hit.width * self.camera.focal_length / hit.distance) else {
                        continue;
                    };
                    let (columns, lines) = level.size();
                    let across = ((hit.across * columns as f32) as u32).min(columns - 1);
                    let scale = lines as f32 / (bottom - top);
                    for (v, pixel) in (row(top)..).zip(drawn) {
                        let line = (v as f32 - top) * scale;
                        *pixel = level.pixels.get_pixel(across, (line as u32).min(lines - 1)).0[0];
                    }
                }
            }
        }
    }

    /// Blurs each row over this number of pixels.
    fn blur(&mut self, over: f32, image: &mut GrayImage) {
        let width = image.size().0 as usize;
        let half = ((0.5 * over).round() as usize).min(width / 2);
        if half == 0 {
            return;
        }
        let count = 2 * half + 1;
        // A product instead of a quotient, which is exact for sums of so few bytes.
        let part = (1_u64 << 32) / count as u64 + 1;
        for line in image.pixels.chunks_exact_mut(width) {
            self.row.clear();
            self.row.resize(half, line[0]);
            self.row.extend_from_slice(line);
            self.row.resize(width + 2 * half + 1, line[width - 1]);
            let mut sum: u32 = self.row[..count].iter().map(|p| u32::from(*p)).sum();
            let (leaving, entering) = (&self.row, &self.row[count..]);
            for ((pixel, old), new) in line.iter_mut().zip(leaving).zip(entering) {
                *pixel = ((u64::from(sum) * part) >> 32) as u8;
                sum = sum + u32::from(*new) - u32::from(*old);
            }
        }
    }
}

/// Turns columns with `rows` pixels into the rows of an image.
fn transpose(columns: &[u8], rows: usize, image: &mut [u8]) {
    /// Side of a block, chosen so that the block fits in the cache.
    const BLOCK: usize = 32;
    if rows == 0 {
        return;
    }
    let width = columns.len() / rows;
    for (block, lines) in image.chunks_mut(BLOCK * width.max(1)).enumerate() {
        for left in (0..width).step_by(BLOCK) {
            for (i, line) in lines.chunks_exact_mut(width).enumerate() {
                let column = columns[left * rows..].iter().skip(block * BLOCK + i).step_by(rows);
                let part = left..width.min(left + BLOCK);
                line[part].iter_mut().zip(column).for_each(|(pixel, value)| *pixel = *value);
            }
        }
    }
}

/// Applies light and noise to each pixel.
pub fn expose(light: &Light, noise: f32, random: &mut Random, image: &mut GrayImage) {
    let width = image.size().0 as usize;
    if width == 0 {
        return;
    }
    let factors: Vec<f32> =
        (0..width).map(|u| light.gain * (1.0 + light.slope * (0.5 - u as f32 / width as f32))).collect();
    // The sum of four random bytes is nearly normal: mean 510, variance 4·(256² − 1)/12.
    let sigma = noise / libm::sqrtf(65535.0 / 3.0);
    let mut sums = vec![[0; 2]; width.div_ceil(2)];
    for line in image.pixels.chunks_exact_mut(width) {
        sums.fill_with(|| sums_of_four(random.bits()));
        for ((pixel, factor), sum) in line.iter_mut().zip(&factors).zip(sums.as_flattened()) {
            let value = f32::from(*pixel) * factor + light.haze + sigma * (f32::from(*sum) - 510.0);
            // NaN becomes 0. The cast by way of i32 can be vectorized.
            *pixel = (value + 0.5).clamp(0.0, 255.0) as i32 as u8;
        }
    }
}

/// Sum of the lower four bytes, and that of the upper ones.
const fn sums_of_four(bits: u64) -> [u16; 2] {
    const EVEN: u64 = 0x00ff_00ff_00ff_00ff;
    let pairs = (bits & EVEN) + (bits >> 8 & EVEN);
    let sums = pairs + (pairs >> 16);
    [sums as u16, (sums >> 32) as u16]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Look, Panel, Picture, Pillar};
    use core::f32::consts::{FRAC_PI_2, PI};

    /// A room with a bright wall 4 m ahead, 2 m high, and a camera 0.5 m above the floor.
    fn room() -> (Scene, CameraSim) {
        let mut scene = Scene::new(50, 10);
        let (a, b) = (Point2::new(4.0, 5.0), Point2::new(4.0, -5.0));
        scene.panel(Panel { a, b, bottom: 0.0, top: 2.0, look: Look::Plain(200) });
        let camera = Camera { position: [0.0, 0.0, 0.5], ..Camera::new(640, 480, FRAC_PI_2) };
        let mut camera = CameraSim::new(camera).expect("it is level");
        camera.noise = 0.0;
        (scene, camera)
    }

    fn photo(scene: &Scene, camera: &mut CameraSim, twist: &Twist, light: &Light) -> GrayImage {
        let mut image = GrayImage::default();
        let mut random = Random::new(1);
        camera.take(scene, &Pose2::default(), twist, light, Time::ZERO, &mut random, &mut image);
        image
    }

    #[test]
    fn things_are_where_the_camera_projects_them() {
        let (mut scene, mut camera) = room();
        let mark =
            GrayImage::from(image::GrayImage::from_fn(64, 64, |u, _| image::Luma([if u < 32 { 0 } else { 255 }])));
        scene.sign(&Pose2::new(3.9, 1.0, PI), 1.0, 0.6, Picture::new(mark));
        let image = photo(&scene, &mut camera, &Twist::ZERO, &Light::default());
        let at = |point: [f32; 3]| {
            let [u, v] = camera.camera.project(point).expect("in front");
            image.pixels.get_pixel(u.round() as u32, v.round() as u32).0[0]
        };
        assert_eq!([at([4.0, 0.0, 1.8]), at([2.0, 0.0, 0.0]), at([4.0, 0.0, 2.3])], [200, 50, 10]);
        assert_eq!([at([3.9, 1.2, 1.0]), at([3.9, 0.8, 1.0])], [0, 255], "the left half of the picture is black");
        assert_eq!([at([3.9, 1.2, 1.35]), at([3.9, 1.35, 1.0])], [200, 200], "it ends where it should");
    }

    #[test]
    fn near_things_hide_far_ones() {
        let (mut scene, mut camera) = room();
        scene.pillar(Pillar { centre: Point2::new(2.0, 0.0), radius: 0.3, top: 0.6, look: Look::Plain(77) });
        let image = photo(&scene, &mut camera, &Twist::ZERO, &Light::default());
        let [u, v] = camera.camera.project([1.7, 0.0, 0.3]).expect("in front");
        assert_eq!(image.pixels.get_pixel(u as u32, v as u32).0, [77]);
        let [_, above] = camera.camera.project([1.7, 0.0, 0.7]).expect("in front");
        assert_eq!(image.pixels.get_pixel(u as u32, above as u32).0, [200]);
    }

    #[test]
    fn turning_blurs_upright_edges() {
        let (mut scene, mut camera) = room();
        scene.pillar(Pillar { centre: Point2::new(2.0, 0.0), radius: 0.3, top: 2.0, look: Look::Plain(0) });
        let edge = |image: &GrayImage| {
            image.pixels.rows().nth(230).expect("a row").filter(|p| !matches!(p.0[0], 0 | 200)).count()
        };
        assert_eq!(edge(&photo(&scene, &mut camera, &Twist::ZERO, &Light::default())), 0);
        let blurred = edge(&photo(&scene, &mut camera, &Twist::new(0.0, 0.0, 2.0), &Light::default()));
        assert_eq!(blurred, 12, "two edges of 2 rad/s · 10 ms · 320 px");
    }

    #[test]
    fn light_and_noise_are_as_asked_for() {
        let (scene, mut camera) = room();
        camera.noise = 4.0;
        let light = Light { gain: 0.5, slope: 0.4, haze: 20.0 };
        let image = photo(&scene, &mut camera, &Twist::ZERO, &light);
        let part = |from: u32, to: u32| -> (f32, f32) {
            let wall: Vec<f32> = (230..250)
                .flat_map(|v| (from..to).map(move |u| (u, v)))
                .map(|(u, v)| f32::from(image.pixels.get_pixel(u, v).0[0]))
                .collect();
            let mean = wall.iter().sum::<f32>() / wall.len() as f32;
            (mean, (wall.iter().map(|p| (p - mean).powi(2)).sum::<f32>() / wall.len() as f32).sqrt())
        };
        let ((left, _), (middle, sigma)) = (part(0, 20), part(310, 330));
        assert!(
            (middle - 120.0).abs() < 1.0 && (left - 139.0).abs() < 2.0 && (sigma - 4.0).abs() < 0.5,
            "{left} {middle} {sigma}"
        );
        let dark = photo(&scene, &mut camera, &Twist::ZERO, &Light { gain: f32::NAN, ..light });
        assert!(dark.pixels.iter().all(|p| *p == 0));
    }

    #[test]
    fn a_camera_that_looks_down_is_refused() {
        let camera = Camera { pitch: 0.3, ..Camera::new(64, 48, 1.0) };
        assert_eq!(CameraSim::new(camera).err(), Some(NotLevel(camera)));
    }
}
