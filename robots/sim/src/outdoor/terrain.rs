use super::Track;
use crate::Random;
use apex_nodes::scan::Point2;
use core::f32::consts::{PI, TAU};
use libm::{cosf, fabsf, floorf, sinf, sqrtf};

/// Side of a cell of the height field, in m.
const CELL: f32 = 0.5;
/// Side of a tile that lists what is in it, in m.
const TILE: f32 = 8.0;
/// Width of the country around the track, in m.
const MARGIN: f32 = 45.0;
/// Distance that things keep from the way of the runner, in m: enough for a robot that runs there.
const KEPT: f32 = 0.85;
/// Width of the walls of a ditch, in m.
const WALL: f32 = 0.3;

/// The thing that a ray of a scanner meets.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash)]
pub enum Surface {
    /// Nothing.
    #[default]
    None,
    /// Bare ground.
    Ground,
    /// Blades of grass above the ground.
    Grass,
    /// Walls and bottom of a ditch.
    Ditch,
    /// Rock.
    Rock,
    /// Trunk of a tree.
    Trunk,
    /// Leaves of a tree or a bush.
    Leaves,
    /// Person.
    Person,
}

impl Surface {
    /// Returns `true` for what a robot can drive over.
    pub const fn is_drivable(self) -> bool {
        matches!(self, Self::Ground | Self::Grass)
    }

    /// Returns `true` for what stands on the ground, or hangs above it.
    pub const fn is_obstacle(self) -> bool {
        matches!(self, Self::Rock | Self::Trunk | Self::Leaves | Self::Person)
    }
}

/// Shape of a [`Thing`]. Lengths are in m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ThingShape {
    /// Vertical cylinder on the ground.
    Pole {
        /// Radius.
        radius: f32,
        /// Height.
        height: f32,
    },
    /// Ball.
    Ball {
        /// Radius.
        radius: f32,
        /// Height of its middle above the ground.
        middle: f32,
    },
}

/// Thing that stands on the terrain.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Thing {
    /// Position.
    pub at: Point2,
    /// Height of the ground there, in m.
    pub base: f32,
    /// Shape.
    pub shape: ThingShape,
    /// Material.
    pub surface: Surface,
}

/// Ditch along a straight line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ditch {
    /// Ends of its middle line.
    pub ends: [Point2; 2],
    /// Half of its width at the top, in m.
    pub half_width: f32,
    /// Depth, in m.
    pub depth: f32,
}

/// Part of the terrain with the things, ditches and grass in it.
#[derive(Debug, Clone, Default)]
struct Tile {
    things: Vec<u32>,
    ditches: Vec<u32>,
    /// Height of the grass, in m.
    grass: f32,
}

/// Terrain: a field of heights, and what stands on it.
#[derive(Debug, Clone)]
pub struct Terrain {
    corner: Point2,
    size: [usize; 2],
    heights: Vec<f32>,
    tiles: [usize; 2],
    content: Vec<Tile>,
    things: Vec<Thing>,
    ditches: Vec<Ditch>,
}

impl Thing {
    /// Radius of what a robot on the ground touches, in m: 0 of a crown above it.
    pub fn radius_at_ground(&self) -> f32 {
        match self.shape {
            ThingShape::Pole { radius, .. } => radius,
            ThingShape::Ball { radius, middle } => {
                // Up to a height of 0.9 m.
                let below = middle - middle.clamp(0.0, 0.9);
                sqrtf((radius * radius - below * below).max(0.0))
            }
        }
    }

    /// Largest radius, in m.
    pub const fn radius(&self) -> f32 {
        match self.shape {
            ThingShape::Pole { radius, .. } | ThingShape::Ball { radius, .. } => radius,
        }
    }
}

impl Ditch {
    /// Depth below the ground at a place, in m.
    fn depth_at(&self, place: Point2) -> f32 {
        let [a, b] = self.ends;
        let way = b - a;
        let t = ((place - a).dot(way) / way.norm_squared().max(1e-6)).clamp(0.0, 1.0);
        let distance = (place - (a + way.scaled(t))).norm();
        self.depth * ((self.half_width - distance) / WALL).clamp(0.0, 1.0)
    }
}

impl Terrain {
    /// Flat ground of this half width about the origin, in m, without anything on it.
    pub fn flat(half: f32) -> Self {
        let corner = Point2::new(-half, -half);
        let mut terrain = Self::empty(corner, Point2::new(half, half));
        terrain.heights.fill(0.0);
        terrain
    }

    /// Country around a track: hills, bumps, grass, woods and bushes beside the track, more of them inside of corners,
    /// ditches along it, and rocks beside it and on it, where the runner makes a bow.
    pub fn around(track: &Track, random: &mut Random) -> Self {
        let [low, high] = track.bounds();
        let margin = Point2::new(MARGIN, MARGIN);
        let mut terrain = Self::empty(low - margin, high + margin);
        terrain.raise(random);
        terrain.sow(random);
        terrain.dig(track, random);
        for rock in track.rocks() {
            terrain.put(track, rock.0, Shape::Rock(rock.1), random);
        }
        let mut s = 0.0;
        let mut is_wood = false;
        while s < track.length() {
            if random.chance(0.05) {
                is_wood = !is_wood;
            }
            let bend = track.bend(s);
            let side = if random.chance(0.5) { 1.0 } else { -1.0 };
            // Inside of a corner it is dense, so that who runs around it is hidden.
            let (chance, side, reach) = if fabsf(bend) > 0.1 {
                (0.8, bend.signum(), 3.0)
            } else {
                (if is_wood { 0.6 } else { 0.12 }, side, 9.0)
            };
            if random.chance(chance) {
                let (at, heading) = (track.at(s), track.heading(s));
                let left = Point2::polar(1.0, heading + 0.5 * PI);
                let place = at + left.scaled(side * random.uniform(1.3, 1.3 + reach));
                let shape = match random.unit() {
                    u if u < 0.62 => Shape::Tree,
                    u if u < 0.85 => Shape::Bush,
                    _ => Shape::Rock(random.uniform(0.2, 0.5)),
                };
                terrain.put(track, place, shape, random);
            }
            s += 1.5;
        }
        terrain
    }

    fn empty(low: Point2, high: Point2) -> Self {
        let count = |length: f32, side: f32| (length / side) as usize + 2;
        let extent = high - low;
        let size = [count(extent.x, CELL), count(extent.y, CELL)];
        let tiles = [count(extent.x, TILE), count(extent.y, TILE)];
        Self {
            corner: low,
            size,
            heights: vec![0.0; size[0] * size[1]],
            tiles,
            content: vec![Tile::default(); tiles[0] * tiles[1]],
            things: vec![],
            ditches: vec![],
        }
    }

    /// Raises hills and bumps: waves in random directions.
    fn raise(&mut self, random: &mut Random) {
        let mut wave = |length: [f32; 2], height: f32| {
            let k = TAU / random.uniform(length[0], length[1]);
            let direction = random.uniform(0.0, TAU);
            let phase = random.uniform(0.0, TAU);
            (k * cosf(direction), k * sinf(direction), phase, height)
        };
        let mut waves = vec![];
        for _ in 0..3 {
            waves.push(wave([90.0, 180.0], 1.2));
            waves.push(wave([30.0, 60.0], 0.28));
            waves.push(wave([8.0, 16.0], 0.035));
            waves.push(wave([2.2, 4.0], 0.012));
        }
        // Along a row the phase grows by the same angle, so that a rotation takes the place of a sine.
        for (kx, ky, phase, height) in waves {
            let (turn_sin, turn_cos) = libm::sincosf(kx * CELL);
            for (row, heights) in self.heights.chunks_mut(self.size[0]).enumerate() {
                let start = kx * self.corner.x + ky * (self.corner.y + row as f32 * CELL) + phase;
                let (mut sin, mut cos) = libm::sincosf(start);
                for z in heights {
                    *z += height * sin;
                    (sin, cos) = (sin * turn_cos + cos * turn_sin, cos * turn_cos - sin * turn_sin);
                }
            }
        }
    }

    /// Lets grass grow in patches.
    fn sow(&mut self, random: &mut Random) {
        for tile in &mut self.content {
            tile.grass = if random.chance(0.6) { random.uniform(0.03, 0.14) } else { 0.0 };
        }
    }

    /// Digs ditches along the track, beside it.
    fn dig(&mut self, track: &Track, random: &mut Random) {
        let count = (track.length() / 90.0) as usize;
        for _ in 0..count {
            let s = random.uniform(20.0, track.length());
            let side = if random.chance(0.5) { 1.0 } else { -1.0 };
            let offset = side * random.uniform(2.6, 6.0);
            let length = random.uniform(6.0, 14.0);
            let end = |s: f32| track.at(s) + Point2::polar(1.0, track.heading(s) + 0.5 * PI).scaled(offset);
            let ditch = Ditch {
                ends: [end(s), end(s + length)],
                half_width: random.uniform(0.5, 0.8),
                depth: random.uniform(0.4, 0.7),
            };
            let samples = (0..=10).map(|i| ditch.ends[0] + (ditch.ends[1] - ditch.ends[0]).scaled(0.1 * i as f32));
            if samples.into_iter().all(|p| track.distance(p) > ditch.half_width + 1.2) {
                self.add_ditch(ditch);
            }
        }
    }

    /// Adds a ditch.
    pub fn add_ditch(&mut self, ditch: Ditch) {
        let number = self.ditches.len() as u32;
        let [a, b] = ditch.ends;
        let margin = ditch.half_width + TILE;
        let (low, high) = (Point2::new(a.x.min(b.x), a.y.min(b.y)), Point2::new(a.x.max(b.x), a.y.max(b.y)));
        self.ditches.push(ditch);
        let corner = self.corner;
        for (i, tile) in self.content.iter_mut().enumerate() {
            let x = corner.x + (i % self.tiles[0]) as f32 * TILE;
            let y = corner.y + (i / self.tiles[0]) as f32 * TILE;
            let is_near =
                x < high.x + margin && x + TILE > low.x - margin && y < high.y + margin && y + TILE > low.y - margin;
            if is_near {
                tile.ditches.push(number);
            }
        }
    }

    /// Adds a thing. It stands on the ground at its position.
    pub fn add(&mut self, at: Point2, shape: ThingShape, surface: Surface) {
        let base = self.height(at);
        if let Some(tile) = self.tile(at) {
            self.content[tile].things.push(self.things.len() as u32);
            self.things.push(Thing { at, base, shape, surface });
        }
    }

    fn put(&mut self, track: &Track, at: Point2, shape: Shape, random: &mut Random) {
        let fits = |radius: f32| track.distance(at) > radius + KEPT;
        if self.depth(at) > 0.0 {
            return;
        }
        match shape {
            Shape::Rock(radius) if fits(radius) => {
                self.add(at, ThingShape::Ball { radius, middle: 0.0 }, Surface::Rock);
            }
            Shape::Tree => {
                let radius = random.uniform(0.1, 0.28);
                let height = random.uniform(3.2, 5.5);
                if fits(radius) {
                    self.add(at, ThingShape::Pole { radius, height }, Surface::Trunk);
                    let crown = random.uniform(1.0, 1.8);
                    self.add(at, ThingShape::Ball { radius: crown, middle: height + 0.6 * crown }, Surface::Leaves);
                }
            }
            Shape::Bush => {
                let radius = random.uniform(0.4, 0.9);
                if fits(radius) {
                    self.add(at, ThingShape::Ball { radius, middle: 0.5 * radius }, Surface::Leaves);
                }
            }
            Shape::Rock(_) => {}
        }
    }

    /// All things.
    pub fn things(&self) -> &[Thing] {
        &self.things
    }

    /// All ditches.
    pub fn ditches(&self) -> &[Ditch] {
        &self.ditches
    }

    /// Things whose positions are within some distance of a place, in m, and some beyond it.
    pub fn near(&self, place: Point2, reach: f32) -> impl Iterator<Item = &Thing> {
        let first = |v: f32, corner: f32| ((v - reach - corner) / TILE).max(0.0) as usize;
        let last = |v: f32, corner: f32, most: usize| (((v + reach - corner) / TILE).max(0.0) as usize).min(most - 1);
        let (x0, y0) = (first(place.x, self.corner.x), first(place.y, self.corner.y));
        let (x1, y1) = (last(place.x, self.corner.x, self.tiles[0]), last(place.y, self.corner.y, self.tiles[1]));
        let tiles = (y0..=y1).flat_map(move |y| (x0..=x1).map(move |x| y * self.tiles[0] + x));
        tiles.flat_map(|tile| &self.content[tile].things).map(|i| &self.things[*i as usize])
    }

    fn tile(&self, place: Point2) -> Option<usize> {
        let d = place - self.corner;
        let (x, y) = (d.x / TILE, d.y / TILE);
        // False for NaN.
        let is_inside = x >= 0.0 && y >= 0.0 && x < self.tiles[0] as f32 && y < self.tiles[1] as f32;
        is_inside.then(|| y as usize * self.tiles[0] + x as usize)
    }

    /// Height of the ground at a place, in m; that of the border outside.
    #[inline]
    pub fn height(&self, place: Point2) -> f32 {
        let depth = self.depth(place);
        let limit = |v: f32, count: usize| v.clamp(0.0, (count - 2) as f32 + 0.999);
        let d = (place - self.corner).scaled(1.0 / CELL);
        let (x, y) = (limit(d.x, self.size[0]), limit(d.y, self.size[1]));
        let (i, j) = (floorf(x), floorf(y));
        let (u, v) = (x - i, y - j);
        let at = j as usize * self.size[0] + i as usize;
        let [a, b] = [self.heights[at], self.heights[at + 1]];
        let [c, d] = [self.heights[at + self.size[0]], self.heights[at + self.size[0] + 1]];
        (a * (1.0 - u) + b * u) * (1.0 - v) + (c * (1.0 - u) + d * u) * v - depth
    }

    /// Depth of a ditch at a place below the ground around it, in m; 0 elsewhere.
    #[inline]
    pub fn depth(&self, place: Point2) -> f32 {
        let Some(tile) = self.tile(place) else { return 0.0 };
        let ditches = self.content[tile].ditches.iter().map(|i| self.ditches[*i as usize].depth_at(place));
        ditches.fold(0.0, f32::max)
    }

    /// Height of the grass at a place, in m.
    pub fn grass(&self, place: Point2) -> f32 {
        self.tile(place).map_or(0.0, |tile| self.content[tile].grass)
    }

    /// Returns `true` if a straight line from one place and height to another meets neither the ground nor a thing.
    pub fn is_seen(&self, from: (Point2, f32), to: (Point2, f32)) -> bool {
        let way = to.0 - from.0;
        let length = way.norm();
        let steps = (length / 0.5) as usize + 1;
        let rises = (1..steps).any(|i| {
            let t = i as f32 / steps as f32;
            self.height(from.0 + way.scaled(t)) > from.1 + t * (to.1 - from.1)
        });
        if rises {
            return false;
        }
        let middle = from.0 + way.scaled(0.5);
        let hides = |thing: &Thing| {
            let t = ((thing.at - from.0).dot(way) / way.norm_squared().max(1e-6)).clamp(0.0, 1.0);
            let aside = (thing.at - (from.0 + way.scaled(t))).norm();
            let z = from.1 + t * (to.1 - from.1) - thing.base;
            match thing.shape {
                ThingShape::Pole { radius, height } => aside < radius && z < height,
                ThingShape::Ball { radius, middle } => {
                    let up = z - middle;
                    aside * aside + up * up < radius * radius
                }
            }
        };
        !self.near(middle, 0.5 * length + 1.0).any(hides)
    }
}

/// Shape of a thing that is to be put somewhere.
#[derive(Debug, Clone, Copy)]
enum Shape {
    /// Rock of a radius in m.
    Rock(f32),
    Tree,
    Bush,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ditch_is_below_the_ground_around_it() {
        let mut terrain = Terrain::flat(20.0);
        terrain.add_ditch(Ditch { ends: [Point2::new(3.0, -5.0), Point2::new(3.0, 5.0)], half_width: 0.6, depth: 0.5 });
        let at = |x: f32, y: f32| terrain.height(Point2::new(x, y));
        assert_eq!([at(0.0, 0.0), at(3.0, 0.0), at(3.7, 0.0), at(3.0, 7.0)], [0.0, -0.5, 0.0, 0.0]);
        assert!(at(3.45, 0.0) < -0.2 && at(3.45, 0.0) > -0.3);
    }

    #[test]
    fn things_hide_what_is_behind_them() {
        let mut terrain = Terrain::flat(20.0);
        terrain.add(Point2::new(4.0, 0.0), ThingShape::Pole { radius: 0.2, height: 3.0 }, Surface::Trunk);
        let eye = (Point2::default(), 1.0);
        assert!(!terrain.is_seen(eye, (Point2::new(8.0, 0.1), 1.2)));
        assert!(terrain.is_seen(eye, (Point2::new(8.0, 1.0), 1.2)));
        assert!(terrain.is_seen(eye, (Point2::new(8.0, 0.0), 9.0)), "over it");
        assert!(!terrain.is_seen(eye, (Point2::new(8.0, 3.0), -0.5)), "the ground is higher");
    }

    #[test]
    fn the_way_of_the_runner_is_free_and_the_country_is_that_of_its_seed() {
        let make = |seed| {
            let mut random = Random::new(seed);
            let track = Track::new(&mut random, 400.0);
            (Terrain::around(&track, &mut random), track)
        };
        let (terrain, track) = make(3);
        assert!(terrain.things().len() > 60 && !terrain.ditches().is_empty());
        for i in 0..400 {
            let place = track.way(i as f32);
            assert_eq!(terrain.depth(place), 0.0);
            for thing in terrain.near(place, 3.0) {
                let gap = (thing.at - place).norm() - thing.radius_at_ground();
                assert!(gap > 0.6, "{gap} m at {i} m from {thing:?}");
            }
        }
        assert_eq!(terrain.things(), make(3).0.things());
        assert_ne!(terrain.things(), make(4).0.things());
    }
}
