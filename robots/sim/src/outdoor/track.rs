use crate::Random;
use apex_nodes::{math::normalize_angle, scan::Point2};
use core::f32::consts::{PI, TAU};
use libm::{expf, fabsf, sinf, tanf};

/// Distance between the points of a track, in m.
const STEP: f32 = 1.0;
/// Distance between corners, in m.
const CORNERS: f32 = 75.0;
/// Distance by which the runner passes the middle of a rock, in m, and length over which the bow swells, in m.
const BOW: [f32; 2] = [1.35, 4.0];

/// Closed track with corners, on which rocks lie.
#[derive(Debug, Clone)]
pub struct Track {
    /// Points, [`STEP`] apart; the last one is before the first one.
    points: Vec<Point2>,
    /// Distances along the track of rocks on it in m, their radii in m, and the side on which they are passed.
    rocks: Vec<(f32, f32, f32)>,
    /// Phases of the slow swaying of the runner.
    sway: [f32; 2],
    /// The way of the runner, by points of the track.
    way: Vec<Point2>,
}

impl Track {
    /// Makes a track of this length, in m.
    pub fn new(random: &mut Random, length: f32) -> Self {
        let count = ((length / CORNERS) as usize).max(5);
        let corners: Vec<Point2> = (0..count)
            .map(|i| {
                let angle = (i as f32 + random.uniform(-0.25, 0.25)) / count as f32 * TAU;
                Point2::polar(random.uniform(0.72, 1.28), angle)
            })
            .collect();
        let radii: Vec<f32> = corners.iter().map(|_| random.uniform(3.0, 7.0)).collect();
        // Roundings shorten the track, so that its scale follows from a few tries.
        let mut scale = length / TAU;
        for _ in 0..6 {
            let line = rounded(&corners, scale, &radii);
            scale *= length / (line.len() as f32 * STEP);
        }
        let points = rounded(&corners, scale, &radii);
        let whole = points.len() as f32 * STEP;
        let mut rocks = vec![];
        let mut s = random.uniform(40.0, 80.0);
        while s < whole - 30.0 {
            let side = if random.chance(0.5) { 1.0 } else { -1.0 };
            rocks.push((s, random.uniform(0.2, 0.42), side));
            s += random.uniform(60.0, 160.0);
        }
        let sway = [random.uniform(0.0, TAU), random.uniform(0.0, TAU)];
        let mut track = Self { points, rocks, sway, way: vec![] };
        track.way = (0..track.points.len()).map(|i| track.swayed(i as f32 * STEP)).collect();
        track
    }

    /// Length of a round, in m.
    pub fn length(&self) -> f32 {
        self.points.len() as f32 * STEP
    }

    /// Point on the middle line at a distance along it, in m.
    pub fn at(&self, s: f32) -> Point2 {
        between(&self.points, s)
    }

    /// Direction of the middle line, in rad.
    pub fn heading(&self, s: f32) -> f32 {
        (self.at(s + 0.5) - self.at(s - 0.5)).angle()
    }

    /// Curvature of the middle line over some metres, in 1/m, positive to the left.
    pub fn bend(&self, s: f32) -> f32 {
        normalize_angle(&(self.heading(s + 2.0) - self.heading(s - 2.0))) / 4.0
    }

    /// Point on the way of the runner, who sways and passes the rocks, at a distance along the middle line, in m.
    pub fn way(&self, s: f32) -> Point2 {
        between(&self.way, s)
    }

    /// Positions and radii of the rocks on the track.
    pub fn rocks(&self) -> impl Iterator<Item = (Point2, f32)> + '_ {
        self.rocks.iter().map(|(s, radius, _)| (self.at(*s), *radius))
    }

    /// Distance of a place from the way of the runner, in m.
    pub fn distance(&self, place: Point2) -> f32 {
        let nearest = (0..self.way.len()).map(|i| {
            let (a, b) = (self.way[i], self.way[(i + 1) % self.way.len()]);
            let way = b - a;
            let t = ((place - a).dot(way) / way.norm_squared().max(1e-6)).clamp(0.0, 1.0);
            (place - (a + way.scaled(t))).norm_squared()
        });
        libm::sqrtf(nearest.fold(f32::INFINITY, f32::min))
    }

    /// Corners of the rectangle around the track.
    pub fn bounds(&self) -> [Point2; 2] {
        let fold = |pick: fn(f32, f32) -> f32, start: f32| {
            let all = |of: fn(&Point2) -> f32| self.points.iter().map(of).fold(start, pick);
            Point2::new(all(|p| p.x), all(|p| p.y))
        };
        [fold(f32::min, f32::INFINITY), fold(f32::max, f32::NEG_INFINITY)]
    }

    fn swayed(&self, s: f32) -> Point2 {
        let sway = 0.3 * sinf(s / 9.0 + self.sway[0]) + 0.25 * sinf(s / 23.0 + self.sway[1]);
        let bow = |(at, _, side): &(f32, f32, f32)| {
            let off = (s - at) / BOW[1];
            (*side, expf(-off * off))
        };
        let nearest = self.rocks.iter().map(bow).max_by(|a, b| a.1.total_cmp(&b.1));
        let (side, weight) = nearest.unwrap_or_default();
        let offset = sway * (1.0 - weight) + side * BOW[0] * weight;
        self.at(s) + Point2::polar(offset, self.heading(s) + 0.5 * PI)
    }
}

fn between(points: &[Point2], s: f32) -> Point2 {
    let count = points.len();
    let place = (s / STEP).rem_euclid(count as f32);
    let i = (place as usize).min(count - 1);
    let (a, b) = (points[i], points[(i + 1) % count]);
    a + (b - a).scaled(place - i as f32)
}

/// Points of a polygon with rounded corners, in equal steps.
fn rounded(corners: &[Point2], scale: f32, radii: &[f32]) -> Vec<Point2> {
    let count = corners.len();
    let corner = |i: usize| corners[i % count].scaled(scale);
    let mut line = vec![];
    for (i, radius) in radii.iter().enumerate() {
        let (before, at, after) = (corner(i + count - 1), corner(i), corner(i + 1));
        let [into, out] = [at - before, after - at];
        let turn = normalize_angle(&(out.angle() - into.angle()));
        let most = 0.45 * into.norm().min(out.norm());
        let cut = (radius * tanf(0.5 * fabsf(turn))).min(most);
        let radius = cut / tanf(0.5 * fabsf(turn)).max(1e-3);
        let (mut place, heading) = (at - into.scaled(cut / into.norm()), into.angle());
        let pieces = 24;
        line.push(place);
        for k in 0..pieces {
            let direction = heading + turn * (k as f32 + 0.5) / pieces as f32;
            let chord = 2.0 * radius * sinf(0.5 * fabsf(turn) / pieces as f32);
            place = place + Point2::polar(chord, direction);
            line.push(place);
        }
    }
    in_steps(&line)
}

fn in_steps(line: &[Point2]) -> Vec<Point2> {
    let mut points = vec![line[0]];
    let mut rest = STEP;
    for i in 0..line.len() {
        let (mut from, to) = (line[i], line[(i + 1) % line.len()]);
        loop {
            let way = to - from;
            let length = way.norm();
            if length < rest {
                rest -= length;
                break;
            }
            from = from + way.scaled(rest / length);
            points.push(from);
            rest = STEP;
        }
    }
    // The last point may be nearer to the first one than a step.
    if (points[points.len() - 1] - points[0]).norm() < 0.5 * STEP {
        points.pop();
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_track_is_closed_has_its_length_and_corners() {
        for seed in 1..12 {
            let track = Track::new(&mut Random::new(seed), 1700.0);
            assert!((track.length() - 1700.0).abs() < 20.0, "{} m", track.length());
            let bends = (0..1700).map(|s| track.bend(s as f32).abs());
            assert!(bends.fold(0.0, f32::max) > 0.12, "seed {seed} has no corner");
            let mut last = track.way(0.0);
            for i in 1..=(track.length() as usize) {
                let next = track.way(i as f32);
                assert!((next - last).norm() < 2.2 * STEP, "seed {seed}: {} m", (next - last).norm());
                last = next;
            }
            assert!((last - track.way(0.0)).norm() < 2.0 * STEP);
            for (at, radius) in track.rocks() {
                assert!(track.distance(at) > radius + 0.5);
            }
        }
    }
}
