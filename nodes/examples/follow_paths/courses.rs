use crate::drive::Robot;
use apex_nodes::{math::Random, nav::Path, scan::Point2};
use core::f32::consts::{PI, TAU};

/// Class of paths.
pub struct Class {
    pub name: &'static str,
    /// Makes a path of the class.
    pub path: fn(&mut Random) -> Path,
    /// Robot that follows it.
    pub robot: Robot,
}

const fn class(name: &'static str, path: fn(&mut Random) -> Path) -> Class {
    Class { name, path, robot: Robot::Usual }
}

/// All classes.
pub const CLASSES: [Class; 12] = [
    class("any waypoints", |random| waypoints(random, 2, 10, 0.01, 20.0)),
    class("long legs", |random| waypoints(random, 2, 6, 3.0, 20.0)),
    class("short legs", |random| waypoints(random, 10, 60, 0.01, 0.3)),
    class("dense points", |random| dense(&waypoints(random, 2, 6, 0.3, 5.0))),
    class("equal points", |random| repeated(waypoints(random, 2, 8, 0.01, 5.0), random)),
    class("there and back", there_and_back),
    class("crossings", crossings),
    class("cusps", cusps),
    class("hairpins", hairpins),
    class("smooth curves", |random| curves(random, 0.3)),
    Class { name: "waypoints, fast", path: |random| waypoints(random, 2, 10, 0.01, 20.0), robot: Robot::Fast },
    Class { name: "curves, steered", path: |random| curves(random, 0.7), robot: Robot::Steered },
];

/// Path through points, which ends with a random heading.
fn through(points: Vec<Point2>, random: &mut Random) -> Path {
    Path { points, heading: random.uniform(-PI, PI) }
}

/// Whole number from `least` to `most`.
fn count(random: &mut Random, least: usize, most: usize) -> usize {
    least + (random.unit() * (most - least + 1) as f64) as usize
}

/// Number between two others, whose logarithm is uniform.
fn scale(random: &mut Random, least: f32, most: f32) -> f32 {
    least * (most / least).powf(random.unit() as f32)
}

/// Straight legs of these lengths, in m, between `least` and `most` of them, with corners up to 180°.
fn waypoints(random: &mut Random, least: usize, most: usize, shortest: f32, longest: f32) -> Path {
    let mut points = vec![Point2::new(random.uniform(-5.0, 5.0), random.uniform(-5.0, 5.0))];
    let mut heading = random.uniform(-PI, PI);
    for _ in 0..count(random, least, most) {
        points.push(points[points.len() - 1] + Point2::polar(scale(random, shortest, longest), heading));
        // A quarter of the corners are half turns.
        heading += if random.chance(0.25) { PI } else { random.uniform(-PI, PI) };
    }
    through(points, random)
}

/// Same path with a point every 10 cm.
fn dense(path: &Path) -> Path {
    let mut points = vec![path.points[0]];
    for ends in path.points.windows(2) {
        let along = ends[1] - ends[0];
        let parts = (along.norm() / 0.1).ceil().max(1.0) as usize;
        points.extend((1..=parts).map(|i| ends[0] + along.scaled(i as f32 / parts as f32)));
    }
    Path { points, heading: path.heading }
}

/// Same path with up to three times each point; half of the times they differ by rounding errors.
fn repeated(path: Path, random: &mut Random) -> Path {
    let mut points = vec![];
    for point in &path.points {
        points.push(*point);
        for _ in 0..count(random, 0, 2) {
            let error = if random.chance(0.5) { 1e-6 } else { 0.0 };
            points.push(*point + Point2::new(random.normal(error), random.normal(error)));
        }
    }
    Path { points, heading: path.heading }
}

/// Path of up to three legs and back over the same points, once or twice.
fn there_and_back(random: &mut Random) -> Path {
    let mut way = waypoints(random, 1, 3, 0.2, 6.0);
    if random.chance(0.5) {
        way = dense(&way);
    }
    let there = way.points.clone();
    for i in 0..count(random, 1, 2) {
        let back = there.iter().rev().skip(1);
        if i == 0 { way.points.extend(back) } else { way.points.extend(there.iter().skip(1)) }
    }
    way
}

/// Path that crosses itself: a star, or a curve of the form of an eight.
fn crossings(random: &mut Random) -> Path {
    let radius = scale(random, 0.2, 5.0);
    let points = if random.chance(0.5) {
        let corners = 2 * count(random, 2, 5) + 1;
        let skip = (corners / 2) as f32;
        (0..=corners).map(|i| Point2::polar(radius, TAU * skip * i as f32 / corners as f32)).collect()
    } else {
        let count = count(random, 16, 100);
        let at = |i: usize| TAU * i as f32 / count as f32;
        (0..=2 * count).map(|i| Point2::new(radius * at(i).sin(), radius * (2.0 * at(i)).sin() * 0.5)).collect()
    };
    through(points, random)
}

/// Arcs that turn back into each other's direction: a vehicle that parks would drive such a path.
fn cusps(random: &mut Random) -> Path {
    let mut points = vec![Point2::default()];
    let mut heading = random.uniform(-PI, PI);
    for _ in 0..count(random, 2, 6) {
        arc(&mut points, &mut heading, scale(random, 0.2, 3.0), random.uniform(-1.5, 1.5));
        heading += PI;
    }
    through(points, random)
}

/// Parallel legs that are joined by half circles of 1 cm to 30 cm.
fn hairpins(random: &mut Random) -> Path {
    let mut points = vec![Point2::default()];
    let mut heading = random.uniform(-PI, PI);
    for _ in 0..count(random, 2, 5) {
        arc(&mut points, &mut heading, scale(random, 0.3, 5.0), 0.0);
        let (radius, parts) = (scale(random, 0.01, 0.3), count(random, 2, 20));
        let side = if random.chance(0.5) { PI } else { -PI };
        for _ in 0..parts {
            heading += 0.5 * side / parts as f32;
            points.push(points[points.len() - 1] + Point2::polar(PI * radius / parts as f32, heading));
            heading += 0.5 * side / parts as f32;
        }
    }
    through(points, random)
}

/// Curves with radii from `least` m on.
fn curves(random: &mut Random, least: f32) -> Path {
    let mut points = vec![Point2::default()];
    let mut heading = random.uniform(-PI, PI);
    for _ in 0..count(random, 2, 8) {
        let radius = scale(random, least, 5.0);
        let length = scale(random, 0.3, 4.0).min(5.0 * radius);
        let side = if random.chance(0.5) { 1.0 } else { -1.0 };
        arc(&mut points, &mut heading, length, side * length / radius);
    }
    through(points, random)
}

/// Adds an arc, with a point every 10 cm, that turns by an angle.
fn arc(points: &mut Vec<Point2>, heading: &mut f32, length: f32, turn: f32) {
    let parts = (length / 0.1).ceil().max(1.0);
    for _ in 0..parts as usize {
        *heading += 0.5 * turn / parts;
        points.push(points[points.len() - 1] + Point2::polar(length / parts, *heading));
        *heading += 0.5 * turn / parts;
    }
}
