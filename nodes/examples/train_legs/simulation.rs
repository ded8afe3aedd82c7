use crate::recording::{Labelled, Truth};
use apex_nodes::{
    math::Random,
    scan::{Point2, Pose2, Scan},
};
use apex_sim::{Laser, World};
use std::f32::consts::{PI, TAU};

/// Scan of a random room with furniture and persons, by a random scanner in its origin.
pub fn scan(random: &mut Random) -> Labelled {
    let mut world = World::default();
    furnish(random, &mut world);
    let furniture = world.discs().len();
    for _ in 0..random.bits() % 5 {
        person(random, &mut world);
    }
    let laser = Laser {
        field_of_view: if random.chance(0.5) { TAU } else { 0.75 * TAU },
        resolution: random.uniform(0.0045, 0.0095),
        range_min: 0.02,
        range_max: random.uniform(4.0, 12.0),
        noise: random.uniform(0.003, 0.02),
        dropout: if random.chance(0.5) { random.uniform(0.0, 0.3) } else { 0.0 },
        turn: 0.0,
    };
    let mut scan = Scan::default();
    laser.measure(&world, &Pose2::default(), random, &mut scan);
    mix(random, &mut scan);
    let reach = 3.0 * laser.noise + 0.01;
    let is_leg = |(beam, range): (usize, &f32)| {
        let hit = Point2::polar(*range, scan.angle(beam));
        world.discs()[furniture..].iter().any(|leg| ((hit - leg.centre).norm() - leg.radius).abs() < reach)
    };
    let labels = scan.ranges.iter().enumerate().map(is_leg).collect();
    Labelled { scan, legs: Truth::Beams(labels) }
}

/// Moves some ranges at edges between both sides, as a beam has a width.
fn mix(random: &mut Random, scan: &mut Scan) {
    let share = random.uniform(0.0, 0.5);
    for beam in 1..scan.ranges.len() {
        let (before, here) = (scan.ranges[beam - 1], scan.ranges[beam]);
        if (before - here).abs() > 0.1 && before.is_finite() && here.is_finite() && random.chance(share) {
            scan.ranges[beam] = before + random.unit() as f32 * (here - before);
        }
    }
}

fn place(random: &mut Random, near: f32, far: f32) -> Pose2 {
    let position = Point2::polar(random.uniform(near, far), random.uniform(-PI, PI));
    Pose2::new(position.x, position.y, random.uniform(-PI, PI))
}

/// Walls, boxes, posts, tables and chairs.
fn furnish(random: &mut Random, world: &mut World) {
    let middle = place(random, 0.0, 1.0);
    world.block(&middle, random.uniform(4.0, 14.0), random.uniform(3.0, 10.0));
    for _ in 0..random.bits() % 12 {
        let (length, width) = (random.uniform(0.03, 1.2), random.uniform(0.03, 1.2));
        world.block(&place(random, 1.0, 6.0), length, width);
    }
    for _ in 0..random.bits() % 6 {
        world.disc(place(random, 0.6, 6.0).position(), random.uniform(0.01, 0.3));
    }
    for _ in 0..random.bits() % 5 {
        table(random, world);
    }
}

/// Four thin legs of a table or a chair.
fn table(random: &mut Random, world: &mut World) {
    let middle = place(random, 1.2, 5.0);
    let (length, width) = (random.uniform(0.35, 1.6), random.uniform(0.35, 0.9));
    let (radius, is_round) = (random.uniform(0.008, 0.03), random.chance(0.5));
    for (x, y) in [(0.5, 0.5), (-0.5, 0.5), (-0.5, -0.5), (0.5, -0.5)] {
        let leg = middle.to_outer(Point2::new(x * length, y * width));
        if is_round {
            world.disc(leg, radius);
        } else {
            world.block(&Pose2::new(leg.x, leg.y, middle.theta), 2.0 * radius, 2.0 * radius);
        }
    }
}

/// Two legs, a step apart or side by side.
fn person(random: &mut Random, world: &mut World) {
    let middle = place(random, 0.5, 4.5);
    let (step, width, radius) = (random.uniform(-0.5, 0.5), random.uniform(0.12, 0.3), random.uniform(0.04, 0.095));
    for side in [-0.5, 0.5] {
        let leg = middle.to_outer(Point2::new(side * step, side * width));
        world.disc(leg, radius * random.uniform(0.9, 1.1));
    }
}
