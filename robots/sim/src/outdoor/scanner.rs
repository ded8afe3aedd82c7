use super::{Attitude, Surface, Terrain, ThingShape, Walker};
use crate::Random;
use apex_nodes::{
    cloud::{CloudPoint, RingCloud},
    scan::{Point2, Pose2, wrap_angle},
};
use apex_rt::Time;
use core::f32::consts::{PI, TAU};
use libm::{asinf, logf, sincosf, sqrtf};

/// Number of rings, elevation of the uppermost one, and angle between them, in rad: those of a VLP-16.
const RINGS: usize = 16;
const TOP: f32 = 15.0 * PI / 180.0;
const APART: f32 = 2.0 * PI / 180.0;
/// Nearest sample of the ground, in m, and ratio of the distances of consecutive samples.
const NEAREST: f32 = 0.8;
const RATIO: f32 = 1.07;
/// Mean way of a ray through grass, in m.
const THROUGH_GRASS: f32 = 0.8;

/// Pose of a base at a time within a turn.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Sample {
    /// Pose.
    pub pose: Pose2,
    /// Inclination and height.
    pub attitude: Attitude,
}

/// Laser scanner with 16 rings that turns ten times a second, on a base on rough ground. Its defaults are those of a
/// VLP-16 on a mast.
#[derive(Debug, Clone)]
pub struct RingScanner {
    /// Number of columns of a turn.
    pub columns: usize,
    /// Height above the ground contact of the base, in m.
    pub height: f32,
    /// Duration of a turn, in s.
    pub duration: f32,
    /// Maximum range, in m.
    pub range: f32,
    /// Standard deviation of a range, in m.
    pub noise: f32,
    /// Probability that a point is missing. Far ones are missing more often.
    pub dropout: f32,
    /// Distances at which the ground is sampled.
    distances: Vec<f32>,
    heights: Vec<f32>,
    /// Things and people in reach.
    targets: Vec<Target>,
    /// Numbers of the targets in each column.
    lists: Vec<Vec<u16>>,
}

#[derive(Debug, Clone, Copy)]
struct Target {
    at: Point2,
    velocity: Point2,
    base: f32,
    shape: ThingShape,
    surface: Surface,
}

/// Ray in the world: its origin, and its direction of length 1.
#[derive(Debug, Clone, Copy)]
struct Ray {
    from: [f32; 3],
    to: [f32; 3],
    /// Horizontal part of the direction.
    level: f32,
}

impl Default for RingScanner {
    fn default() -> Self {
        Self {
            columns: 1800,
            height: 0.85,
            duration: 0.1,
            range: 60.0,
            noise: 0.02,
            dropout: 0.004,
            distances: vec![],
            heights: vec![],
            targets: vec![],
            lists: vec![],
        }
    }
}

impl RingScanner {
    /// Measures a turn, clockwise from behind. `samples` are poses of the base in equal steps from the beginning of the
    /// turn to its end, which is at `stamp`; `people` are where they are at the end. The cloud is in the frame of the
    /// scanner as it was at the time of each column. `truth` tells what each point of the cloud is.
    #[allow(clippy::too_many_arguments, reason = "they are the world, and what is measured in it")]
    pub fn measure(
        &mut self,
        terrain: &Terrain,
        samples: &[Sample],
        people: &[Walker],
        stamp: Time,
        random: &mut Random,
        cloud: &mut RingCloud,
        truth: &mut Vec<Surface>,
    ) {
        cloud.reset(stamp, RINGS, self.columns);
        truth.clear();
        truth.resize(RINGS * self.columns, Surface::None);
        let Some(last) = samples.last() else { return };
        self.prepare(terrain, last, people);
        let elevations: [(f32, f32); RINGS] = core::array::from_fn(|row| sincosf(TOP - APART * row as f32));
        for column in 0..self.columns {
            let part = column as f32 / self.columns as f32;
            let before = (part - 1.0) * self.duration;
            cloud.times_mut()[column] = before;
            let sample = between(samples, part);
            let [forward, left, up] = axes(&sample);
            let Attitude { height, .. } = sample.attitude;
            let mast = up.map(|c| c * self.height);
            let from = [sample.pose.x + mast[0], sample.pose.y + mast[1], height + mast[2]];
            let (sin, cos) = sincosf(PI - TAU * part);
            let flat: [f32; 3] = core::array::from_fn(|i| forward[i] * cos + left[i] * sin);
            self.sample_ground(terrain, from, flat);
            // From the lowest ring up: the higher one, the farther away it meets the ground.
            let mut next = 0;
            for row in (0..RINGS).rev() {
                let (up_part, level_part) = elevations[row];
                let to: [f32; 3] = core::array::from_fn(|i| flat[i] * level_part + up[i] * up_part);
                let ray = Ray { from, to, level: sqrtf(to[0] * to[0] + to[1] * to[1]).max(1e-3) };
                let (distance, surface) = self.trace(terrain, &ray, column, before, &mut next, random);
                let i = column * RINGS + row;
                let part = distance / self.range;
                // False for NaN and infinity.
                let is_measured = part <= 1.0 && !random.chance(self.dropout + 0.3 * part * part);
                if surface == Surface::None || !is_measured {
                    continue;
                }
                let range = (distance + random.normal(self.noise)).max(0.1);
                truth[i] = surface;
                cloud.points_mut()[i] = CloudPoint {
                    x: range * level_part * cos,
                    y: range * level_part * sin,
                    z: range * up_part,
                    intensity: if surface == Surface::Leaves || surface == Surface::Grass { 60.0 } else { 30.0 },
                };
            }
        }
    }

    /// Finds things and people in reach, and the columns that they may be in.
    fn prepare(&mut self, terrain: &Terrain, last: &Sample, people: &[Walker]) {
        if self.distances.is_empty() {
            let mut s = NEAREST;
            while s < self.range {
                self.distances.push(s);
                s *= RATIO;
            }
        }
        self.heights.resize(self.distances.len(), 0.0);
        self.lists.resize(self.columns, vec![]);
        self.lists.iter_mut().for_each(Vec::clear);
        self.targets.clear();
        let here = last.pose.position();
        let things = terrain.near(here, self.range).map(|thing| Target {
            at: thing.at,
            velocity: Point2::default(),
            base: thing.base,
            shape: thing.shape,
            surface: thing.surface,
        });
        let persons = people.iter().map(|person| Target {
            at: person.position,
            velocity: person.velocity,
            base: terrain.height(person.position),
            shape: ThingShape::Pole { radius: Walker::RADIUS, height: Walker::HEIGHT },
            surface: Surface::Person,
        });
        for target in things.chain(persons) {
            let place = last.pose.to_inner(target.at);
            let distance = place.norm();
            let (ThingShape::Pole { radius, .. } | ThingShape::Ball { radius, .. }) = target.shape;
            // The robot and the people move during the turn.
            let radius = radius + 0.35;
            if distance > self.range || self.targets.len() >= usize::from(u16::MAX) {
                continue;
            }
            let half = if distance > radius { asinf(radius / distance) + 0.12 } else { PI };
            let per_column = TAU / self.columns as f32;
            let middle = (PI - place.angle()) / per_column;
            let reach = (half / per_column) as i32 + 1;
            let number = self.targets.len() as u16;
            self.targets.push(target);
            for offset in -reach.min(self.columns as i32 / 2)..reach.min(self.columns as i32 / 2) {
                let column = (middle as i32 + offset).rem_euclid(self.columns as i32) as usize;
                self.lists[column].push(number);
            }
        }
    }

    fn sample_ground(&mut self, terrain: &Terrain, from: [f32; 3], flat: [f32; 3]) {
        let level = sqrtf(flat[0] * flat[0] + flat[1] * flat[1]).max(1e-3);
        let step = Point2::new(flat[0] / level, flat[1] / level);
        for (height, distance) in self.heights.iter_mut().zip(&self.distances) {
            *height = terrain.height(Point2::new(from[0], from[1]) + step.scaled(*distance));
        }
    }

    /// Distance at which a ray meets something, in m, and what that is.
    fn trace(
        &self,
        terrain: &Terrain,
        ray: &Ray,
        column: usize,
        time: f32,
        next: &mut usize,
        random: &mut Random,
    ) -> (f32, Surface) {
        let (mut nearest, mut surface) = self.meet_ground(terrain, ray, next, random);
        for number in &self.lists[column] {
            let target = &self.targets[usize::from(*number)];
            if let Some(distance) = ray.meet(target, time)
                && distance < nearest
            {
                (nearest, surface) = (distance, target.surface);
            }
        }
        (nearest, surface)
    }

    fn meet_ground(&self, terrain: &Terrain, ray: &Ray, next: &mut usize, random: &mut Random) -> (f32, Surface) {
        let slope = ray.to[2] / ray.level;
        let above = |i: usize| ray.from[2] + slope * self.distances[i] - self.heights[i];
        while *next < self.distances.len() && above(*next) > 0.0 {
            *next += 1;
        }
        if *next >= self.distances.len() || *next == 0 {
            return (f32::INFINITY, Surface::None);
        }
        let (near, far) = (self.distances[*next - 1], self.distances[*next]);
        let (high, low) = (above(*next - 1).max(1e-4), above(*next));
        let mut s = near + (far - near) * high / (high - low);
        let place =
            |s: f32| Point2::new(ray.from[0], ray.from[1]) + Point2::new(ray.to[0], ray.to[1]).scaled(s / ray.level);
        // Once more, with the height there.
        let height = ray.from[2] + slope * s - terrain.height(place(s));
        s = if height > 0.0 {
            s + (far - s) * height / (height - low).max(1e-4)
        } else {
            near + (s - near) * high / (high - height).max(1e-4)
        };
        let at = place(s);
        if terrain.depth(at) > 0.02 {
            return (s / ray.level, Surface::Ditch);
        }
        let through = s - self.entry(terrain.grass(at), s, *next, above);
        let way = -THROUGH_GRASS * logf(1.0 - random.unit() as f32);
        let stopped = s - through + way;
        let is_in_grass = |s: f32| ray.from[2] + slope * s - terrain.height(place(s)) <= terrain.grass(place(s));
        // The ground may fall between two samples.
        if way < through && is_in_grass(stopped) {
            return ((stopped / ray.level).max(0.3), Surface::Grass);
        }
        (s / ray.level, Surface::Ground)
    }

    /// Distance at which a ray comes into grass of this height. It meets the ground at `s`, before the sample `next`,
    /// and `above` is its height above the samples.
    fn entry(&self, grass: f32, s: f32, next: usize, above: impl Fn(usize) -> f32) -> f32 {
        let (mut inside, mut left) = (s, 0.0);
        for i in (0..next).rev() {
            let (distance, height) = (self.distances[i], above(i));
            if height >= grass {
                return inside - (inside - distance) * (grass - left) / (height - left).max(1e-4);
            }
            (inside, left) = (distance, height);
        }
        inside
    }
}

impl Ray {
    /// Distance at which the ray enters a target, in m. `time` is that of the ray before the end of the turn, in s.
    fn meet(&self, target: &Target, time: f32) -> Option<f32> {
        let centre = target.at + target.velocity.scaled(time) - Point2::new(self.from[0], self.from[1]);
        match target.shape {
            ThingShape::Pole { radius, height } => {
                let direction = Point2::new(self.to[0] / self.level, self.to[1] / self.level);
                let along = direction.dot(centre);
                let rest = radius * radius - (centre.norm_squared() - along * along);
                if along <= 0.0 || rest <= 0.0 {
                    return None;
                }
                let s = along - sqrtf(rest);
                let z = self.from[2] + s * self.to[2] / self.level - target.base;
                (s > 0.0 && (-0.3..=height).contains(&z)).then(|| s / self.level)
            }
            ThingShape::Ball { radius, middle } => {
                let up = target.base + middle - self.from[2];
                let along = self.to[0] * centre.x + self.to[1] * centre.y + self.to[2] * up;
                let rest = radius * radius - (centre.norm_squared() + up * up - along * along);
                (along > 0.0 && rest > 0.0).then(|| along - sqrtf(rest)).filter(|s| *s > 0.0)
            }
        }
    }
}

/// Pose between two samples, at a part of the turn.
fn between(samples: &[Sample], part: f32) -> Sample {
    let place = part * (samples.len() - 1) as f32;
    let i = place as usize;
    let (a, b) = (samples[i], samples[(i + 1).min(samples.len() - 1)]);
    let t = place - i as f32;
    let mix = |a: f32, b: f32| a + t * (b - a);
    let turn = wrap_angle(b.pose.theta - a.pose.theta);
    let pose = Pose2::new(mix(a.pose.x, b.pose.x), mix(a.pose.y, b.pose.y), a.pose.theta + t * turn);
    let attitude = Attitude {
        height: mix(a.attitude.height, b.attitude.height),
        roll: mix(a.attitude.roll, b.attitude.roll),
        pitch: mix(a.attitude.pitch, b.attitude.pitch),
    };
    Sample { pose, attitude }
}

/// Forward, left and up direction of a base in the world.
fn axes(sample: &Sample) -> [[f32; 3]; 3] {
    let ((sy, cy), (sp, cp)) = (sincosf(sample.pose.theta), sincosf(sample.attitude.pitch));
    let (sr, cr) = sincosf(sample.attitude.roll);
    [
        [cy * cp, sy * cp, -sp],
        [cy * sp * sr - sy * cr, sy * sp * sr + cy * cr, cp * sr],
        [cy * sp * cr + sy * sr, sy * sp * cr - cy * sr, cp * cr],
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::outdoor::Track;

    fn measure(terrain: &Terrain, samples: &[Sample], people: &[Walker]) -> (RingCloud, Vec<Surface>) {
        let mut scanner = RingScanner { noise: 0.0, dropout: 0.0, ..RingScanner::default() };
        let (mut cloud, mut truth) = (RingCloud::default(), vec![]);
        let stamp = Time::from_millis(100);
        scanner.measure(terrain, samples, people, stamp, &mut Random::new(1), &mut cloud, &mut truth);
        (cloud, truth)
    }

    /// Point of the ring `row` in the direction of an angle, in rad.
    fn at(cloud: &RingCloud, angle: f32, row: usize) -> CloudPoint {
        let column = ((PI - angle) / TAU * 1800.0) as usize % 1800;
        cloud.points()[column * RINGS + row]
    }

    #[test]
    fn rings_on_flat_ground_are_circles() {
        let (cloud, truth) = measure(&Terrain::flat(80.0), &[Sample::default(); 11], &[]);
        assert_eq!((cloud.rings(), cloud.columns(), truth.len()), (16, 1800, 28_800));
        for angle in [0.0, 1.0, -2.0] {
            let p = at(&cloud, angle, 15);
            let radius = libm::hypotf(p.x, p.y);
            assert!((radius - 0.85 / libm::tanf(15.0_f32.to_radians())).abs() < 0.02, "{radius}");
            assert!((p.z + 0.85).abs() < 0.01);
            assert!((libm::atan2f(p.y, p.x) - angle).abs() < 0.01);
        }
        assert!(!at(&cloud, 0.0, 0).is_measured(), "into the sky");
        assert!(truth.contains(&Surface::Ground) && !truth.iter().any(|s| s.is_obstacle()));
    }

    #[test]
    fn a_turn_is_distorted_by_motion_and_has_times() {
        let mut terrain = Terrain::flat(80.0);
        terrain.add(Point2::new(10.0, 0.0), ThingShape::Pole { radius: 0.2, height: 3.0 }, Surface::Trunk);
        // The base turns by 0.2 rad while the scanner does.
        let samples: Vec<Sample> =
            (0..=10).map(|i| Sample { pose: Pose2::new(0.0, 0.0, 0.02 * i as f32), ..Sample::default() }).collect();
        let (cloud, truth) = measure(&terrain, &samples, &[]);
        let seen = truth.iter().enumerate().filter(|(_, s)| **s == Surface::Trunk);
        let angles: Vec<f32> = seen
            .map(|(i, _)| {
                let p = cloud.points()[i];
                libm::atan2f(p.y, p.x)
            })
            .collect();
        let mean = angles.iter().sum::<f32>() / angles.len() as f32;
        assert!(angles.len() > 20 && (mean + 0.1).abs() < 0.01, "in the middle of the turn: {mean}");
        let times = cloud.times();
        assert!((times[0] + 0.1).abs() < 1e-6 && times[1799] < 0.0 && times[1799] > -1e-4);
    }

    #[test]
    fn people_and_ditches_are_seen() {
        let mut terrain = Terrain::flat(80.0);
        terrain.add_ditch(super::super::Ditch {
            ends: [Point2::new(-3.5, -9.0), Point2::new(-3.5, 9.0)],
            half_width: 0.8,
            depth: 0.6,
        });
        let person = Walker { position: Point2::new(6.0, 0.0), velocity: Point2::new(0.0, 2.0) };
        let (cloud, truth) = measure(&terrain, &[Sample::default(); 11], &[person]);
        let of = |surface| truth.iter().enumerate().filter(move |(_, s)| **s == surface).map(|(i, _)| i);
        assert!(of(Surface::Ditch).count() > 100);
        assert!(of(Surface::Ditch).any(|i| cloud.points()[i].z < -0.85 - 0.2));
        let ys: Vec<f32> = of(Surface::Person).map(|i| cloud.points()[i].y).collect();
        let mean = ys.iter().sum::<f32>() / ys.len() as f32;
        assert!(ys.len() > 60 && (mean + 0.1).abs() < 0.05, "half a turn earlier: {mean}");
    }

    /// A ray that grazes the ground of a hill is in the grass only where it is low above the ground.
    #[test]
    fn grass_is_seen_where_it_grows() {
        let mut random = Random::new(5);
        let track = Track::new(&mut random, 300.0);
        let terrain = Terrain::around(&track, &mut random);
        let (mut count, mut grazing) = (0, 0);
        for i in 0..30 {
            let (here, ahead) = (track.way(10.0 * i as f32), track.way(10.0 * i as f32 + 0.5));
            let pose = Pose2::new(here.x, here.y, (ahead - here).angle());
            let attitude = Attitude { height: terrain.height(here), ..Attitude::default() };
            let (cloud, truth) = measure(&terrain, &[Sample { pose, attitude }; 2], &[]);
            for (point, _) in cloud.points().iter().zip(&truth).filter(|(_, what)| **what == Surface::Grass) {
                let place = pose.to_outer(Point2::new(point.x, point.y));
                let above = attitude.height + 0.85 + point.z - terrain.height(place);
                assert!((-0.3..0.15).contains(&above), "{above} m above the ground, {point:?}");
                count += 1;
                grazing += usize::from(point.z.abs() < 0.3);
            }
        }
        assert!(count > 10_000 && grazing > 100, "{count}, {grazing}");
    }
}
