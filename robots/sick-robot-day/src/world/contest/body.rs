use super::{Obstacle, rules::ROBOTS};
use crate::world::{Arena, Cube, arena::nearest};
use apex_nodes::{
    nav::Twist,
    scan::{Point2, Pose2},
};
use apex_sim::Omnidirectional;

/// All robots; ours is the first.
pub(super) type Bodies = [Body; ROBOTS];

/// Robot as a physical body: a disc that drives, with a lamp and a hopper.
#[derive(Debug, Clone)]
pub(super) struct Body {
    pub base: Omnidirectional,
    pub radius: f32,
    pub lamp: bool,
    pub cube: Option<Cube>,
}

/// Contact of a robot with an obstacle.
#[derive(Debug, Clone, Copy)]
pub(super) struct Touch {
    pub who: usize,
    pub against: Obstacle,
    pub place: Point2,
    /// Speed of the robot towards the obstacle, and of the obstacle towards the robot, in m/s.
    pub approach: [f32; 2],
}

/// Overlap of a body with an obstacle: the point to keep away from, and the required distance.
struct Overlap {
    against: Obstacle,
    point: Point2,
    distance: f32,
}

impl Body {
    pub fn pose(&self) -> Pose2 {
        self.base.pose
    }

    pub fn position(&self) -> Point2 {
        self.base.pose.position()
    }

    /// Velocity in the world, in m/s.
    pub fn velocity(&self) -> Point2 {
        Pose2::new(0.0, 0.0, self.base.pose.theta).to_outer(self.base.twist.velocity())
    }

    pub fn stands(&self) -> bool {
        self.base.twist.velocity().norm() < 0.02 && self.base.twist.omega.abs() < 0.05
    }

    /// Distance between the outlines of two bodies, in m.
    pub fn gap(&self, other: &Self) -> f32 {
        (other.position() - self.position()).norm() - self.radius - other.radius
    }

    /// Removes the component of the velocity against `away`, a direction of length 1.
    fn block(&mut self, away: Point2) {
        let velocity = self.velocity();
        let into = velocity.dot(away).min(0.0);
        let own = Pose2::new(0.0, 0.0, self.base.pose.theta).to_inner(velocity - away.scaled(into));
        self.base.twist = Twist::of(own, self.base.twist.omega);
    }
}

/// Moves a robot for `dt` s. An obstacle stops it in its direction, so that robots and walls never overlap.
pub(super) fn advance(
    who: usize,
    command: &Twist,
    dt: f32,
    arena: &Arena,
    bodies: &mut Bodies,
    touches: &mut Vec<Touch>,
) {
    let before = bodies[who].position();
    bodies[who].base.step(command, dt);
    // In a corner, one obstacle pushes the robot into the other.
    for _ in 0..4 {
        let Some(overlap) = overlap(who, arena, bodies) else { return };
        touches.push(push_out(who, &overlap, bodies));
    }
    if overlap(who, arena, bodies).is_some() {
        let base = &mut bodies[who].base;
        (base.pose.x, base.pose.y) = (before.x, before.y);
        base.twist = Twist { omega: base.twist.omega, ..Twist::ZERO };
    }
}

fn push_out(who: usize, overlap: &Overlap, bodies: &mut Bodies) -> Touch {
    let off = bodies[who].position() - overlap.point;
    let away = off.scaled(1.0 / off.norm().max(f32::MIN_POSITIVE));
    let (theirs, radius) = match overlap.against {
        Obstacle::Robot(other) => (bodies[other].velocity().dot(away), bodies[other].radius),
        Obstacle::Border | Obstacle::Island => (0.0, 0.0),
    };
    let body = &mut bodies[who];
    let approach = [-body.velocity().dot(away), theirs];
    // Slightly more, so that rounding does not create a new overlap.
    let place = overlap.point + away.scaled(overlap.distance + 1e-5);
    (body.base.pose.x, body.base.pose.y) = (place.x, place.y);
    body.block(away);
    Touch { who, against: overlap.against, place: overlap.point + away.scaled(radius), approach }
}

/// Greatest overlap of a robot.
fn overlap(who: usize, arena: &Arena, bodies: &Bodies) -> Option<Overlap> {
    let body = &bodies[who];
    let place = body.position();
    let walls = walls(arena).map(|(against, wall)| {
        let point = nearest(place, wall.a, wall.b);
        Overlap { against, point, distance: body.radius }
    });
    let robots = bodies.iter().enumerate().filter(|(other, _)| *other != who).map(|(other, robot)| Overlap {
        against: Obstacle::Robot(other),
        point: robot.position(),
        distance: body.radius + robot.radius,
    });
    let depth = |overlap: &Overlap| overlap.distance - (place - overlap.point).norm();
    let deepest = walls.chain(robots).max_by(|a, b| depth(a).total_cmp(&depth(b)));
    deepest.filter(|overlap| depth(overlap) > 0.0)
}

/// Distance between a robot and an obstacle, in m.
pub(super) fn room(who: usize, against: Obstacle, arena: &Arena, bodies: &Bodies) -> f32 {
    let body = &bodies[who];
    if let Obstacle::Robot(other) = against {
        return body.gap(&bodies[other]);
    }
    let place = body.position();
    let of_it = walls(arena).filter(|(part, _)| *part == against);
    of_it.map(|(_, wall)| (place - nearest(place, wall.a, wall.b)).norm()).fold(f32::MAX, f32::min) - body.radius
}

/// Walls of the arena, those of the border first.
fn walls(arena: &Arena) -> impl Iterator<Item = (Obstacle, &apex_sim::Wall)> {
    let border = arena.border.len();
    let part = move |i| if i < border { Obstacle::Border } else { Obstacle::Island };
    arena.world.walls().iter().enumerate().map(move |(i, wall)| (part(i), wall))
}
