//! The clinic as the camera sees it, and as people walk through it.

use super::STAIRWELL;
use crate::{
    BODY, LENGTH, TOP, WHEEL_LENGTH, WHEEL_WIDTH, WIDTH,
    world::{Cart, Thing},
};
use apex_nodes::{
    map::{Grid, Occupancy},
    scan::{Point2, Pose2},
};
use apex_sim::{
    Building, Footprint, Pedestrian, Random, World,
    tof::{Material, Shape, Solid, SolidKind, Space},
};

/// Distance up to which something is drawn for the camera, in m.
const SIGHT: f32 = 5.0;
/// Height of a container on the lift above that on the floor, in m.
const LIFTED: f32 = 0.06;
/// Heights of the bottom and the top of a trolley, in m.
const TROLLEY: [f32; 2] = [0.15, 0.9];
/// Distance that people keep from walls, in m.
const ROOM: f32 = 0.3;

/// Places where people walk: not on the stairs.
pub(super) fn walkable(building: &Building) -> Grid<Occupancy> {
    let mut whole = building.clone();
    let [x, y] = [STAIRWELL.x, STAIRWELL.y];
    let middle = Pose2::new(0.5 * (x[0] + x[1]), 0.5 * (y[0] + y[1]), 0.0);
    whole.world.block(&middle, x[1] - x[0], y[1] - y[0]);
    whole.free_map(ROOM).unwrap_or_default()
}

/// Adds walls and furniture before the camera.
pub(super) fn walls(world: &World, pose: &Pose2, space: &mut Space) {
    let here = pose.position();
    for wall in world.walls() {
        // The part within sight: a short solid is skipped sooner by rays.
        let along = wall.b - wall.a;
        let length = along.norm();
        if length < 1e-3 || wall.distance(here) > SIGHT {
            continue;
        }
        let foot = ((here - wall.a).dot(along) / length).clamp(0.0, length);
        let (from, to) = ((foot - SIGHT).max(0.0), (foot + SIGHT).min(length));
        let at = |distance: f32| wall.a + along.scaled(distance / length);
        if [from, foot, to].iter().all(|distance| is_behind(pose, at(*distance))) {
            continue;
        }
        let centre = at(0.5 * (from + to));
        let shape =
            Shape::Block { centre: [centre.x, centre.y, 1.2], size: [to - from, 0.02, 2.4], yaw: along.angle() };
        add(space, shape, 0.5, SolidKind::Object);
    }
    for disc in world.discs().iter().filter(|disc| is_seen(pose, disc.centre)) {
        rod(space, disc.centre, [0.0, 0.7], disc.radius, 0.4);
    }
}

/// Adds a container.
pub(super) fn cart(cart: &Cart, pose: &Pose2, is_lifted: bool, space: &mut Space) {
    let at = cart.pose();
    if (at.position() - pose.position()).norm() > SIGHT + LENGTH {
        return;
    }
    let up = if is_lifted { LIFTED } else { 0.0 };
    let mut block = |pose: &Pose2, size: [f32; 3], bottom: f32, albedo: f32, kind| {
        let shape = Shape::Block { centre: [pose.x, pose.y, bottom + 0.5 * size[2]], size, yaw: pose.theta };
        add(space, shape, albedo, kind);
    };
    block(&at, [LENGTH, WIDTH, TOP - BODY], BODY + up, 0.5, SolidKind::Overhanging);
    for (wheel, castor) in cart.wheels() {
        let size = [WHEEL_LENGTH, WHEEL_WIDTH, WHEEL_LENGTH];
        block(&Pose2::new(wheel.x, wheel.y, castor), size, up, 0.2, SolidKind::Object);
    }
}

/// Adds a person: legs and trunk.
pub(super) fn person(person: &Pedestrian, pose: &Pose2, space: &mut Space) {
    let at = person.pose.position();
    if is_seen(pose, at) {
        person.legs().into_iter().for_each(|leg| rod(space, leg.centre, [0.0, 0.85], leg.radius, 0.3));
        rod(space, at, [0.85, 1.7], 0.2, 0.4);
    }
}

/// Adds the trolley that a person pushes.
pub(super) fn trolley(person: &Pedestrian, pose: &Pose2, space: &mut Space) {
    let Some(Footprint { pose: at, length, width }) = person.trolley() else { return };
    if is_seen(pose, at.position()) {
        let [bottom, top] = TROLLEY;
        let centre = [at.x, at.y, 0.5 * (bottom + top)];
        let shape = Shape::Block { centre, size: [length, width, top - bottom], yaw: at.theta };
        add(space, shape, 0.5, SolidKind::Overhanging);
        person.trolley_wheels().for_each(|wheel| rod(space, wheel.centre, [0.0, bottom], wheel.radius, 0.2));
    }
}

/// Adds a small thing, whose sizes depend on its number.
pub(super) fn thing(thing: Thing, at: &Pose2, number: usize, pose: &Pose2, space: &mut Space) {
    if is_seen(pose, at.position()) {
        thing.place(at, &mut Random::new(number as u64), space);
    }
}

fn rod(space: &mut Space, at: Point2, [bottom, top]: [f32; 2], radius: f32, albedo: f32) {
    let shape = Shape::Rod { from: [at.x, at.y, bottom], to: [at.x, at.y, top], radius };
    add(space, shape, albedo, SolidKind::Object);
}

fn add(space: &mut Space, shape: Shape, albedo: f32, kind: SolidKind) {
    space.add(Solid { shape, material: Material::plain(albedo), kind });
}

fn is_behind(pose: &Pose2, point: Point2) -> bool {
    let p = pose.to_inner(point);
    p.x < 0.9 * p.y.abs() - 1.0
}

fn is_seen(pose: &Pose2, point: Point2) -> bool {
    (point - pose.position()).norm() <= SIGHT && !is_behind(pose, point)
}
