use super::body::{Bodies, Body};
use crate::world::ISLAND_SIDE;
use apex_nodes::{
    math::normalize_angle,
    scan::{Point2, Pose2},
};
use apex_sim::Random;
use std::f32::consts::PI;

/// Limits of the ring in which robots drive outside of stations: distances of their middle from that of the arena, in
/// m.
const NEAR: f32 = 2.05;
const FAR: f32 = 5.3;

/// Horizon of the collision avoidance, in s, and the distances to keep, in m: the second one if no velocity keeps the
/// first.
const HORIZON: f32 = 2.0;
const ROOMS: [f32; 2] = [0.25, 0.12];

/// Distance at which a robot stops before another one, in m, and the deceleration before, in m/s².
const STOP: f32 = 0.1;
const BRAKES: f32 = 1.0;

/// Candidates for the next velocity: angles from the desired direction, those to the right first, so that two robots
/// that meet pass on the same side.
const TURNS: [f32; 12] = [0.0, -0.3, 0.3, -0.6, 0.6, -1.0, 1.0, -1.4, 1.4, -2.0, 2.0, PI];

/// Velocity that moves a robot towards a place, around the island and past the others.
pub(super) fn steer(who: usize, goal: Point2, speed: f32, bodies: &Bodies) -> Point2 {
    let body = &bodies[who];
    let place = body.position();
    let rest = (goal - place).norm();
    if rest < 0.01 {
        return Point2::default();
    }
    let way = way_point(place, goal) - place;
    let wanted = way.scaled(speed.min(1.2 * rest) / way.norm().max(0.01));
    let others: Vec<&Body> = others(who, bodies).filter(|other| body.gap(other) < 3.0).collect();
    let velocity = body.velocity();
    let score = |candidate: &Point2| candidate.dot(wanted) + 0.15 * candidate.dot(velocity);
    let best = |room| {
        let candidates = TURNS.iter().flat_map(|turn| [1.0, 0.5].map(|part| turned(wanted, *turn).scaled(part)));
        let free = candidates.filter(|candidate| is_free(body, *candidate, &others, room));
        free.reduce(|best, next| if score(&next) > score(&best) + 1e-4 { next } else { best })
    };
    ROOMS.into_iter().find_map(best).unwrap_or_default()
}

/// Part of a velocity with which a robot can still stop before all others.
pub(super) fn guarded(who: usize, mut velocity: Point2, bodies: &Bodies) -> Point2 {
    let body = &bodies[who];
    for _ in 0..2 {
        for other in others(who, bodies) {
            let excess = excess(body, other, velocity);
            let to = other.position() - body.position();
            velocity = velocity - to.scaled(excess.max(0.0) / to.norm());
        }
    }
    // Between two robots, a velocity away from one may lead to the other.
    if others(who, bodies).any(|other| excess(body, other, velocity) > 0.01) { Point2::default() } else { velocity }
}

/// Random place between the island and the border.
pub(super) fn any_place(random: &mut Random) -> Point2 {
    Point2::polar(random.uniform(NEAR + 0.3, FAR - 0.2), random.uniform(-PI, PI))
}

fn others(who: usize, bodies: &Bodies) -> impl Iterator<Item = &Body> {
    bodies.iter().enumerate().filter(move |(i, _)| *i != who).map(|(_, body)| body)
}

/// Excess of a velocity over the allowed speed towards another robot, in m/s.
fn excess(body: &Body, other: &Body, velocity: Point2) -> f32 {
    let to = other.position() - body.position();
    let allowed = (BRAKES * (body.gap(other) - STOP)).max(0.0).sqrt();
    velocity.dot(to.scaled(1.0 / to.norm())) - allowed
}

/// The goal, or a place beside the island if that is in the way.
fn way_point(place: Point2, goal: Point2) -> Point2 {
    let way = goal - place;
    let part = -place.dot(way) / way.norm_squared();
    let nearest = (place + way.scaled(part)).norm();
    if !(0.0..1.0).contains(&part) || nearest >= NEAR {
        return goal;
    }
    let turn = normalize_angle(&(goal.angle() - place.angle()));
    Point2::polar(NEAR + 0.3, place.angle() + turn.clamp(-0.35, 0.35))
}

fn turned(vector: Point2, angle: f32) -> Point2 {
    Pose2::new(0.0, 0.0, angle).to_outer(vector)
}

/// Returns `true` if a velocity keeps the robot in the permitted ring and far enough from the others.
fn is_free(body: &Body, velocity: Point2, others: &[&Body], room: f32) -> bool {
    let (now, then) = (body.position().norm(), (body.position() + velocity.scaled(0.5)).norm());
    let inner = 0.5 * ISLAND_SIDE / (PI / 8.0).sin() + body.radius + 0.1;
    let stays = (then >= inner || then >= now) && (then <= FAR + 0.05 || then <= now);
    stays && others.iter().all(|other| passes(body, velocity, other, room))
}

/// Returns `true` if two robots with constant velocities keep enough distance. If they are too close already, returns
/// `true` if they do not approach.
fn passes(body: &Body, velocity: Point2, other: &Body, room: f32) -> bool {
    let apart = other.position() - body.position();
    let closing = velocity - other.velocity();
    if body.gap(other) < room {
        return velocity.dot(apart) <= 0.0;
    }
    let meet = (apart.dot(closing) / closing.norm_squared().max(1e-6)).clamp(0.0, HORIZON);
    (apart - closing.scaled(meet)).norm() >= body.radius + other.radius + room
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_way_leads_round_the_island() {
        let (mut place, goal) = (Point2::new(-2.3, 0.1), Point2::new(2.3, 0.1));
        let mut steps = 0;
        while (goal - place).norm() > 0.1 {
            let way = way_point(place, goal) - place;
            place = place + way.scaled(0.05 / way.norm());
            assert!(place.norm() > 2.0, "{place:?}");
            steps += 1;
            assert!(steps < 200);
        }
        assert_eq!(way_point(Point2::new(3.0, 0.0), Point2::new(3.0, 3.0)), Point2::new(3.0, 3.0));
    }
}
