use super::{
    body::{Bodies, Body},
    steering::{any_place, guarded, steer},
};
use crate::world::{Arena, Station};
use apex_nodes::{
    math::normalize_angle,
    nav::{Twist, stand_before},
    scan::{Point2, Pose2},
};
use apex_rt::Time;
use apex_sim::Random;
use std::time::Duration;

/// Distance of a robot's middle from the wall before it docks, in m.
const BEFORE: f32 = 0.8;

/// Distance within which a robot occupies a station, and distance of waiting robots, in m.
const USED: f32 = 1.0;
const QUEUE: f32 = 1.9;

/// Minimum progress, in m, and time limit: a robot with less progress in this time is stuck.
const PROGRESS: f32 = 0.15;
const PATIENCE: Duration = Duration::from_secs(4);

/// Driver of another robot: it knows the arena, fetches and delivers cubes, and gives way.
#[derive(Debug, Clone)]
pub(super) struct Rival {
    speed: f32,
    random: Random,
    task: Task,
    since: Time,
    /// Index of the station that the robot goes to.
    station: usize,
    /// Last place of progress, and its time.
    progress: (Point2, Time),
    /// Temporary goal of a stuck robot, and the time until which it counts.
    detour: Option<(Point2, Time)>,
    /// Desired velocity in the world, in m/s, and angular velocity, in rad/s.
    wanted: (Point2, f32),
    pub lamp: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Task {
    Travel,
    /// The robot docks or is docked at the station; `full` if it came with a cube.
    Dock {
        full: bool,
    },
    Leave,
}

impl Rival {
    /// Creates a driver that starts shortly after `start`.
    pub fn new(mut random: Random, start: Time) -> Self {
        let speed = random.uniform(0.4, 1.0);
        let since = start + Duration::from_secs_f32(random.uniform(0.0, 2.0));
        Self {
            speed,
            random,
            task: Task::Travel,
            since,
            station: 0,
            progress: (Point2::default(), since),
            detour: None,
            wanted: (Point2::default(), 0.0),
            lamp: false,
        }
    }

    /// Chooses the desired velocity.
    pub fn decide(&mut self, who: usize, bodies: &Bodies, arena: &Arena, now: Time) {
        if now < self.since && self.task == Task::Travel {
            return;
        }
        let body = &bodies[who];
        let station = self.choose(who, bodies, arena);
        let dock = stand_before(&station.pose, body.radius + 0.05);
        self.lamp = false;
        match self.task {
            Task::Travel => self.travel(who, &station, bodies, now),
            Task::Dock { full } => {
                let off = dock.position() - body.position();
                let turn = normalize_angle(&(dock.theta - body.pose().theta));
                self.wanted = (limited(off.scaled(1.5), 0.25), (2.0 * turn).clamp(-1.0, 1.0));
                self.lamp = off.norm() < 0.02 && turn.abs() < 0.1;
                if body.cube.is_some() != full || now.since(self.since) > Duration::from_secs(25) {
                    self.begin(Task::Leave, body, now);
                }
            }
            Task::Leave => {
                let goal = stand_before(&station.pose, BEFORE).position();
                let is_away = station.pose.to_inner(body.position()).x > BEFORE - 0.15;
                self.drive(who, goal, None, bodies, now);
                if is_away || now.since(self.since) > Duration::from_secs(15) {
                    self.begin(Task::Travel, body, now);
                }
            }
        }
    }

    /// Twist for the motors. It is always slow enough to stop before another robot.
    pub fn command(&self, who: usize, bodies: &Bodies) -> Twist {
        let (velocity, omega) = self.wanted;
        let own = Pose2::new(0.0, 0.0, bodies[who].pose().theta).to_inner(guarded(who, velocity, bodies));
        Twist::of(own, omega)
    }

    fn begin(&mut self, task: Task, body: &Body, now: Time) {
        (self.task, self.since, self.progress, self.detour) = (task, now, (body.position(), now), None);
    }

    /// Station to go to: with a cube that of its number, without one a free one nearby. The filling station changes if
    /// another robot arrives there first.
    fn choose(&mut self, who: usize, bodies: &Bodies, arena: &Arena) -> Station {
        let body = &bodies[who];
        let is_free = |station: &usize| !is_used(who, &arena.filling[*station], bodies);
        match body.cube {
            _ if self.task != Task::Travel => {}
            Some(cube) => self.station = arena.filling.len() + cube.number as usize - 1,
            None if self.station < arena.filling.len() && is_free(&self.station) => {}
            None => {
                let way = |i: &usize| (arena.filling[*i].pose.position() - body.position()).norm();
                let nearest = (0..arena.filling.len()).filter(is_free).min_by(|a, b| way(a).total_cmp(&way(b)));
                self.station = nearest.unwrap_or(self.station % arena.filling.len());
            }
        }
        *arena.stations().nth(self.station).unwrap_or(&arena.filling[0])
    }

    /// Goes to a place in front of the station, or waits until the station is free.
    fn travel(&mut self, who: usize, station: &Station, bodies: &Bodies, now: Time) {
        let body = &bodies[who];
        let entry = stand_before(&station.pose, BEFORE);
        if is_used(who, station, bodies) {
            let off = body.position() - station.pose.position();
            let queue = station.pose.position() + off.scaled(QUEUE / off.norm());
            self.progress = (body.position(), now);
            self.drive(who, queue, Some(entry.theta), bodies, now);
            return;
        }
        let heading = ((entry.position() - body.position()).norm() < 0.7).then_some(entry.theta);
        self.drive(who, entry.position(), heading, bodies, now);
        let off = entry.relative_to(&body.pose());
        if off.position().norm() < 0.2 && off.theta.abs() < 0.3 {
            self.begin(Task::Dock { full: body.cube.is_some() }, body, now);
        }
    }

    /// Drives towards a place, or temporarily elsewhere if the robot is stuck.
    fn drive(&mut self, who: usize, goal: Point2, heading: Option<f32>, bodies: &Bodies, now: Time) {
        let body = &bodies[who];
        if (body.position() - self.progress.0).norm() > PROGRESS {
            self.progress = (body.position(), now);
        }
        if now.since(self.progress.1) > PATIENCE {
            let pause = Duration::from_secs_f32(self.random.uniform(1.5, 4.0));
            (self.detour, self.progress) = (Some((any_place(&mut self.random), now + pause)), (body.position(), now));
        }
        self.detour = self.detour.filter(|(_, until)| now < *until);
        let goal = self.detour.map_or(goal, |(goal, _)| goal);
        let velocity = steer(who, goal, self.speed, bodies);
        let ahead = if velocity.norm() > 0.1 { velocity.angle() } else { body.pose().theta };
        let turn = normalize_angle(&(heading.unwrap_or(ahead) - body.pose().theta));
        self.wanted = (velocity, (2.5 * turn).clamp(-2.0, 2.0));
    }
}

/// Returns `true` if another robot is at a station, and nearer to it.
fn is_used(who: usize, station: &Station, bodies: &Bodies) -> bool {
    let distance = |body: &Body| (body.position() - station.pose.position()).norm();
    let own = distance(&bodies[who]).min(USED);
    bodies.iter().enumerate().any(|(other, body)| other != who && distance(body) < own)
}

fn limited(velocity: Point2, speed: f32) -> Point2 {
    velocity.scaled((speed / velocity.norm().max(1e-6)).min(1.0))
}
