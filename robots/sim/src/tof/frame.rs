use super::{
    TofCamera,
    optics::Optics,
    ray::Ray,
    sight::Sight,
    space::{Hit, Space, Truth},
    vector::{Turn, V3, add, dot, norm, scale, unit},
};
use crate::Random;
use apex_nodes::{
    cloud::{CloudPoint, PointCloud},
    scan::{Point2, Pose2},
};
use apex_rt::Time;
use core::f32::consts::TAU;

/// Measurement of a camera.
#[derive(Debug, Clone, Default)]
pub struct TofFrame {
    /// Points in the frame of the camera, with intensities in raw units.
    pub cloud: PointCloud,
    /// True class of each pixel, in the order of the cloud.
    pub truth: Vec<Truth>,
    /// Number of the solid that most of the rays of each pixel meet, or `None`.
    pub solids: Vec<Option<usize>>,
    /// Table of the camera that took the last frame.
    optics: Optics,
    /// Solids before it.
    sight: Sight,
}

/// Standard deviations of a distance up to amplitudes, in m and raw units, as measured on a camera; beyond: the last.
const NOISE: [(f32, f32); 5] = [(100.0, 0.0188), (200.0, 0.0122), (400.0, 0.0058), (800.0, 0.0037), (1600.0, 0.0024)];
const LEAST_NOISE: f32 = 0.0019;
/// Standard deviation of an intensity: relative, and in raw units.
const LIGHT_NOISE: [f32; 2] = [0.01, 1.0];

/// Share of the rays of a pixel that show one surface if the pixel is labelled.
const CLEAR_SHARE: f32 = 0.7;
/// Maximum distance of a measurement from the surface that its pixel shows, in m.
const SURFACE: f32 = 0.05;

/// Light of a pixel.
#[derive(Debug, Clone, Copy, Default)]
struct Light {
    re: f32,
    im: f32,
}

/// Rays of a pixel that meet the same class of surface.
#[derive(Debug, Clone, Copy)]
struct Share {
    truth: Truth,
    solid: Option<usize>,
    count: u32,
    near: f32,
    far: f32,
    is_clear: bool,
}

impl TofCamera {
    /// Takes a frame of `space` when the robot is at `pose`. Reuses the storage of `frame`.
    pub fn take(&self, space: &Space, pose: &Pose2, stamp: Time, random: &mut Random, frame: &mut TofFrame) {
        frame.cloud.reset(stamp, (self.width, self.height));
        let count = frame.cloud.points().len();
        frame.truth.clear();
        frame.truth.resize(count, Truth::Unlabelled);
        frame.solids.clear();
        frame.solids.resize(count, None);
        let mut shares = Vec::new();
        frame.optics.prepare(self);
        let place = pose.to_outer(Point2::new(self.position[0], self.position[1]));
        let from = View { origin: [place.x, place.y, self.position[2]], heading: Turn::new(pose.theta) };
        frame.sight.look(space, &frame.optics, &Pose2 { theta: pose.theta, x: place.x, y: place.y });
        for i in 0..count {
            let solids = frame.sight.of(frame.optics.block(i));
            let rays = frame.optics.rays(i).map(|ray| from.ray(*ray));
            let light = self.collect(space, rays, solids, &mut shares);
            let Some(main) = shares.iter().copied().max_by_key(|share| share.count) else { continue };
            let amplitude = light.amplitude();
            if amplitude < self.least_amplitude {
                continue;
            }
            let distance = light.distance(self.wavelength);
            frame.truth[i] = self.truth(&main, distance);
            frame.solids[i] = main.solid;
            frame.cloud.points_mut()[i] = self.point(frame.optics.pixel(i), distance, amplitude, random);
        }
    }

    /// Adds the light of all rays of a pixel, and counts the surfaces that they meet.
    fn collect(
        &self,
        space: &Space,
        rays: impl Iterator<Item = Ray>,
        solids: impl Iterator<Item = (usize, f32)> + Clone,
        shares: &mut Vec<Share>,
    ) -> Light {
        shares.clear();
        let (mut light, mut middle) = (Light::default(), None);
        let side = self.rays.max(1);
        for ray in rays {
            let (mut weight, mut skipped, mut is_first) = (1.0 / (side * side) as f32, None, true);
            while let Some(hit) = space.nearest(&ray, skipped, solids.clone()) {
                light.add(weight * self.amplitude(&ray, &hit), hit.entry.distance, self.wavelength);
                if is_first {
                    Share::count(shares, &hit);
                    middle.get_or_insert((ray, hit));
                }
                let passed = hit.material.transmission * hit.material.transmission;
                // One transparent solid before another is seen as one.
                if passed == 0.0 || hit.solid.is_none() || !is_first {
                    break;
                }
                (weight, skipped, is_first) = (weight * passed, hit.solid, false);
            }
        }
        if let Some((ray, hit)) = middle.filter(|(_, hit)| hit.truth == Truth::Floor) {
            self.add_indirect(space, &ray, &hit, &mut light);
        }
        light
    }

    /// Adds the light that comes to a point of the floor from the next upright surface behind it, which the camera
    /// lights too. The surface is taken as a diffuse one, lit up to its top or to the upper edge of the image.
    fn add_indirect(&self, space: &Space, ray: &Ray, floor: &Hit, light: &mut Light) {
        let point = ray.at(floor.entry.distance);
        let ahead = unit([ray.direction[0], ray.direction[1], 0.0]);
        let Some(wall) = space.hit(&Ray { origin: add(point, [0.0, 0.0, 0.1]), direction: ahead }, None) else {
            return;
        };
        let Some(top) = wall.solid.map(|i| space.solids()[i].shape.top()) else { return };
        let (gap, whole) = (wall.entry.distance, wall.entry.distance + floor.entry.distance);
        let facing = -dot(ahead, wall.entry.normal);
        let lit = top.min(0.5 * whole);
        // Form factor of an upright strip, seen from a horizontal patch at its foot.
        let form = 1.0 - gap / libm::sqrtf(gap * gap + lit * lit);
        let albedo = wall.material.albedo * floor.material.albedo;
        let amplitude = 0.5 * self.gain * albedo * facing * form / (whole * whole);
        light.add(amplitude, 0.5 * (whole + gap + floor.entry.distance), self.wavelength);
    }

    fn amplitude(&self, ray: &Ray, hit: &Hit) -> f32 {
        let facing = -dot(ray.direction, hit.entry.normal);
        let distance = hit.entry.distance;
        // Glass is bright where it faces the camera.
        let shine = if hit.material.transmission > 0.0 && facing > 0.97 { 0.3 } else { 0.0 };
        self.gain * (hit.material.albedo * facing + shine + hit.material.retro) / (distance * distance)
    }

    fn truth(&self, main: &Share, distance: f32) -> Truth {
        let total = (self.rays.max(1) * self.rays.max(1)) as f32;
        let on_surface = (main.near - SURFACE..=main.far + SURFACE).contains(&distance);
        // The floor before a wall bends, but is floor.
        let bends = main.truth == Truth::Floor && distance >= main.near && distance < 0.5 * self.wavelength;
        if !(on_surface || bends || main.is_clear) {
            return Truth::Artefact;
        }
        if main.count as f32 >= CLEAR_SHARE * total { main.truth } else { Truth::Unlabelled }
    }

    /// Measured point, with noise and static errors, in the frame of the camera.
    fn point(&self, (direction, error): (V3, f32), distance: f32, amplitude: f32, random: &mut Random) -> CloudPoint {
        let range = 0.5 * self.wavelength;
        let sigma = NOISE.iter().find(|(limit, _)| amplitude < *limit).map_or(LEAST_NOISE, |(_, sigma)| *sigma);
        let wiggling = self.distortion.wiggling * libm::sinf(4.0 * TAU * distance / range);
        let error = error + wiggling + random.normal(sigma);
        let intensity = amplitude * (1.0 + random.normal(LIGHT_NOISE[0])) + random.normal(LIGHT_NOISE[1]);
        let [x, y, z] = scale(direction, (distance + error).max(0.0));
        CloudPoint { x, y, z, intensity: intensity.round().max(0.0).min(self.saturation) }
    }
}

/// Place and heading of a camera.
#[derive(Debug, Clone, Copy)]
struct View {
    origin: V3,
    heading: Turn,
}

impl View {
    /// Ray in the frame of the world. `direction` is in that of the robot.
    fn ray(&self, direction: V3) -> Ray {
        Ray { origin: self.origin, direction: self.heading.of(direction) }
    }
}

impl Light {
    fn add(&mut self, amplitude: f32, distance: f32, wavelength: f32) {
        // To the surface and back.
        let (sin, cos) = libm::sincosf(2.0 * TAU * distance / wavelength);
        self.re += amplitude * cos;
        self.im += amplitude * sin;
    }

    fn amplitude(&self) -> f32 {
        norm([self.re, self.im, 0.0])
    }

    /// Distance from 0 to half the wavelength.
    fn distance(&self, wavelength: f32) -> f32 {
        let phase = libm::atan2f(self.im, self.re);
        (if phase < 0.0 { phase + TAU } else { phase }) / TAU * 0.5 * wavelength
    }
}

impl Share {
    fn count(shares: &mut Vec<Self>, hit: &Hit) {
        let distance = hit.entry.distance;
        match shares.iter_mut().find(|share| share.truth == hit.truth && share.solid == hit.solid) {
            Some(share) => {
                share.count += 1;
                share.near = share.near.min(distance);
                share.far = share.far.max(distance);
            }
            None => shares.push(Self {
                truth: hit.truth,
                solid: hit.solid,
                count: 1,
                near: distance,
                far: distance,
                is_clear: hit.material.transmission > 0.0,
            }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tof::{Distortion, Floor, Material, Shape, Solid, SolidKind, vector::sub};

    fn block(distance: f32, size: [f32; 3], material: Material) -> Solid {
        let centre = [distance + 0.5 * size[0], 0.0, 0.5 * size[2]];
        Solid { shape: Shape::Block { centre, size, yaw: 0.0 }, material, kind: SolidKind::Object }
    }

    fn take(solids: &[Solid], floor: Floor) -> TofFrame {
        let mut space = Space::new(floor);
        solids.iter().for_each(|solid| space.add(*solid));
        let mut frame = TofFrame::default();
        TofCamera::default().take(&space, &Pose2::default(), Time::ZERO, &mut Random::new(1), &mut frame);
        frame
    }

    fn distances(frame: &TofFrame, truth: Truth) -> Vec<f32> {
        let points = frame.cloud.points().iter().zip(&frame.truth);
        let of = points.filter(|(p, t)| **t == truth && p.is_measured());
        of.map(|(p, _)| norm([p.x, p.y, p.z])).collect()
    }

    #[test]
    fn the_floor_is_lost_unless_a_wall_lights_it() {
        let farthest = |frame: &TofFrame| distances(frame, Truth::Floor).into_iter().fold(0.0, f32::max);
        for (albedo, least, most) in [(0.15, 1.3, 1.9), (0.5, 2.0, 2.6)] {
            let seen = farthest(&take(&[], Floor { albedo, ..Floor::default() }));
            assert!((least..most).contains(&seen), "{albedo}: {seen}");
        }
        let wall = block(3.0, [0.1, 8.0, 2.5], Material::plain(0.8));
        let lit = farthest(&take(&[wall], Floor { albedo: 0.3, ..Floor::default() }));
        assert!(lit > 2.7, "{lit}");
    }

    #[test]
    fn edges_have_flying_pixels_and_far_walls_wrap() {
        let wall = block(6.0, [0.1, 20.0, 2.5], Material::plain(0.8));
        let pillar = block(1.0, [0.2, 0.3, 1.0], Material::plain(0.5));
        let flying = distances(&take(&[wall, pillar], Floor::default()), Truth::Artefact);
        assert!(flying.len() > 20 && flying.iter().all(|d| (0.9..7.0).contains(d)), "{}", flying.len());
        let far = take(&[block(10.05, [0.1, 20.0, 2.5], Material::plain(0.8))], Floor::default());
        let wrapped = distances(&far, Truth::Artefact);
        assert!(wrapped.len() > 500 && wrapped.iter().filter(|d| **d < 1.5).count() > 500);
    }

    #[test]
    fn retro_reflectors_are_seen_beyond_three_times_the_range() {
        let reflector = Solid {
            shape: Shape::Block { centre: [31.0, 0.0, 1.0], size: [0.02, 0.8, 0.8], yaw: 0.0 },
            material: Material::RETRO,
            kind: SolidKind::Object,
        };
        let frame = take(&[reflector], Floor::default());
        let wrapped = distances(&frame, Truth::Artefact);
        assert!(!wrapped.is_empty() && wrapped.iter().all(|d| (0.9..1.2).contains(d)), "{wrapped:?}");
        assert!(frame.cloud.points().iter().any(|p| p.intensity == 1024.0));
    }

    #[test]
    fn amplitudes_and_noise_are_those_of_the_table() {
        let frame = take(&[block(2.0, [0.1, 8.0, 2.5], Material::plain(0.8))], Floor::default());
        // Around the point straight ahead of the robot.
        let errors: Vec<f32> = (20..33)
            .flat_map(|v| (70..90).map(move |u| v * 160 + u))
            .map(|i| {
                let p = frame.cloud.points()[i];
                assert!((130.0..165.0).contains(&p.intensity), "{}", p.intensity);
                let (sin, cos) = 15_f32.to_radians().sin_cos();
                p.x * cos + p.z * sin - 2.0
            })
            .collect();
        let sigma = (errors.iter().map(|e| e * e).sum::<f32>() / errors.len() as f32).sqrt();
        assert!((0.010..0.0145).contains(&sigma), "{sigma}");
    }

    #[test]
    fn the_same_seed_gives_the_same_frame_and_a_distorted_floor_is_no_plane() {
        let random = || Random::new(9);
        let space = Space::new(Floor::default());
        let camera = TofCamera { distortion: Distortion::random(&mut random()), ..TofCamera::default() };
        let (mut a, mut b) = (TofFrame::default(), TofFrame::default());
        camera.take(&space, &Pose2::default(), Time::ZERO, &mut random(), &mut a);
        camera.take(&space, &Pose2::new(2.0, 1.0, 0.5), Time::ZERO, &mut random(), &mut b);
        // The floor looks the same from everywhere.
        let same = a.cloud.points().iter().zip(b.cloud.points()).filter(|(a, b)| a.is_measured() && b.is_measured());
        let worst = same.map(|(a, b)| norm(sub([a.x, a.y, a.z], [b.x, b.y, b.z]))).fold(0.0, f32::max);
        assert!(worst < 0.01, "{worst}");
        let (sin, cos) = camera.pitch.sin_cos();
        let heights = a.cloud.points().iter().map(|p| p.z * cos - p.x * sin + 0.1).filter(|z| z.is_finite());
        let (low, high) = heights.fold((f32::MAX, f32::MIN), |(low, high), z| (low.min(z), high.max(z)));
        assert!(high - low > 0.015, "{low} {high}");
    }
}
