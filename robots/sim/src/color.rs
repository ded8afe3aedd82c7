use crate::{Disc, Random, Wall};
use apex_nodes::{
    image::{Camera, ColorImage},
    scan::{Point2, Pose2},
};
use apex_rt::Time;
use image::Rgb;

/// Colour and height of an upright thing on the ground.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Paint {
    /// Red, green and blue.
    pub color: [u8; 3],
    /// Height, in m.
    pub height: f32,
}

/// Round upright thing, such as a rock or a cup.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Post {
    /// Outline on the ground.
    pub disc: Disc,
    /// Look.
    pub paint: Paint,
}

/// Level ground with coloured upright things on it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ColorScene {
    /// Flat things.
    pub walls: Vec<(Wall, Paint)>,
    /// Round things.
    pub posts: Vec<Post>,
    /// Colour of the ground.
    pub ground: [u8; 3],
    /// Colour of the sky.
    pub sky: [u8; 3],
}

/// Level colour camera that takes images of a [`ColorScene`].
#[derive(Debug, Clone, PartialEq)]
pub struct ColorCamera {
    /// Camera. Its pitch does not count, as upright things are drawn upright.
    pub camera: Camera,
    /// Standard deviation of each channel of a pixel, of 255.
    pub noise: f32,
    /// Standard deviation of the brightness of the ground, as a share.
    pub grain: f32,
}

/// Thing that a column of the image shows.
#[derive(Debug, Clone, Copy)]
struct Hit {
    distance: f32,
    paint: Paint,
    /// Factor of the brightness.
    shade: f32,
}

impl ColorScene {
    /// Things along the unit vector `direction` from `origin`, the farthest first.
    fn look(&self, origin: Point2, direction: Point2, hits: &mut Vec<Hit>) {
        hits.clear();
        let flat = self.walls.iter().filter_map(|(wall, paint)| {
            let along = wall.b - wall.a;
            let shade = 0.7 + 0.3 * (direction.perpendicular().dot(along) / along.norm()).abs();
            Some(Hit { distance: wall.hit(origin, direction)?, paint: *paint, shade })
        });
        hits.extend(flat);
        let round = self.posts.iter().filter_map(|Post { disc, paint }| {
            let distance = disc.hit(origin, direction)?;
            let normal = origin + direction.scaled(distance) - disc.centre;
            let shade = 0.6 + 0.4 * (normal.dot(direction) / disc.radius).abs();
            Some(Hit { distance, paint: *paint, shade })
        });
        hits.extend(round);
        hits.sort_by(|a, b| b.distance.total_cmp(&a.distance));
    }
}

impl ColorCamera {
    /// Replaces `image` by the image of `scene` from a robot at `pose`.
    pub fn take(&self, scene: &ColorScene, pose: &Pose2, stamp: Time, random: &mut Random, image: &mut ColorImage) {
        let camera = &self.camera;
        image.reset(stamp, (camera.width, camera.height));
        let origin = pose.to_outer(Point2::new(camera.position[0], camera.position[1]));
        let mut hits = vec![];
        for u in 0..camera.width {
            let left = (camera.principal_point[0] - u as f32) / camera.focal_length;
            let angle = pose.theta + camera.yaw + libm::atanf(left);
            scene.look(origin, Point2::polar(1.0, angle), &mut hits);
            // Rows depend on the depth along the optical axis.
            let slant = 1.0 / libm::sqrtf(1.0 + left * left);
            self.draw_column(scene, &hits, (u, slant), random, image);
        }
        image.pixels.pixels_mut().for_each(|pixel| pixel.0 = self.exposed(pixel.0, random));
    }

    fn draw_column(
        &self,
        scene: &ColorScene,
        hits: &[Hit],
        (u, slant): (u32, f32),
        random: &mut Random,
        image: &mut ColorImage,
    ) {
        let Camera { height, focal_length, principal_point, position, .. } = self.camera;
        let row = |z: f32, depth: f32| {
            let v = principal_point[1] - focal_length * (z - position[2]) / depth.max(1e-3);
            (v.ceil().max(0.0) as u32).min(height)
        };
        let horizon = row(position[2], 1.0);
        for v in 0..horizon {
            image.pixels.put_pixel(u, v, Rgb(scene.sky));
        }
        for v in horizon..height {
            image.pixels.put_pixel(u, v, Rgb(shaded(scene.ground, 1.0 + random.normal(self.grain))));
        }
        for Hit { distance, paint, shade } in hits {
            let depth = distance * slant;
            for v in row(paint.height, depth)..row(0.0, depth) {
                image.pixels.put_pixel(u, v, Rgb(shaded(paint.color, *shade)));
            }
        }
    }

    /// Colour with the noise of the sensor.
    fn exposed(&self, color: [u8; 3], random: &mut Random) -> [u8; 3] {
        // The sum of four bytes is nearly normal: mean 510, variance 21845.
        color.map(|channel| {
            let sum: u16 = (random.bits() as u32).to_le_bytes().into_iter().map(u16::from).sum();
            let error = self.noise * (f32::from(sum) - 510.0) / 147.8;
            (f32::from(channel) + error + 0.5) as u8
        })
    }
}

fn shaded(color: [u8; 3], factor: f32) -> [u8; 3] {
    color.map(|channel| (f32::from(channel) * factor) as u8)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn image(pose: &Pose2) -> ColorImage {
        let cup = Paint { color: [20, 60, 220], height: 0.2 };
        let rock = Paint { color: [90, 90, 90], height: 1.0 };
        let disc = |x, y, radius| Disc { centre: Point2::new(x, y), radius };
        let scene = ColorScene {
            walls: vec![(Wall { a: Point2::new(6.0, -3.0), b: Point2::new(6.0, 3.0) }, rock)],
            posts: vec![
                Post { disc: disc(2.0, 0.0, 0.1), paint: cup },
                Post { disc: disc(4.0, 0.0, 0.4), paint: rock },
                Post { disc: disc(5.0, 1.0, 0.1), paint: cup },
            ],
            ground: [180, 130, 90],
            sky: [230, 200, 180],
        };
        let camera = Camera { position: [0.0, 0.0, 0.5], ..Camera::new(320, 240, 1.2) };
        let mut image = ColorImage::default();
        let camera = ColorCamera { camera, noise: 4.0, grain: 0.05 };
        camera.take(&scene, pose, Time::from_secs(1), &mut Random::new(1), &mut image);
        image
    }

    fn is_blue(image: &ColorImage, [u, v]: [f32; 2]) -> bool {
        let [red, _, blue] = image.pixels[(u.round() as u32, v.round() as u32)].0;
        blue > red.saturating_add(60)
    }

    #[test]
    fn things_are_where_a_pinhole_camera_shows_them() {
        let (image, camera) =
            (image(&Pose2::default()), Camera { position: [0.0, 0.0, 0.5], ..Camera::new(320, 240, 1.2) });
        let see = |point: [f32; 3]| is_blue(&image, camera.project(point).expect("in front"));
        assert!(see([1.9, 0.0, 0.03]) && see([1.9, 0.0, 0.17]) && see([1.9, 0.07, 0.1]) && see([4.9, 1.0, 0.1]));
        assert!(!see([1.9, 0.0, -0.03]) && !see([1.9, 0.0, 0.23]) && !see([1.9, 0.13, 0.1]));
        assert_eq!(image.stamp, Time::from_secs(1));
    }

    #[test]
    fn what_is_behind_something_higher_is_hidden() {
        let image = image(&Pose2::new(8.0, 0.0, std::f32::consts::PI));
        assert!(
            image.pixels.pixels().all(|pixel| pixel.0[2] <= pixel.0[0].saturating_add(60)),
            "a wall is before everything"
        );
    }
}
