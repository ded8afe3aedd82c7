use crate::{
    LENGTH, WIDTH,
    world::{Cart, tractor},
};
use apex_nodes::{
    nav::{Articulated, Clearance, PlannedApproach, ReactiveApproach, Twist},
    scan::Pose2,
};
use apex_rt::{Construct as _, Ctx, Event, Time};
use apex_sim::{Random, Tractor, World};
use core::{f32::consts::PI, fmt};

/// Period of the controller, in ms.
const PERIOD: i64 = 50;
/// Steps of the simulation per period.
const STEPS: u8 = 5;
/// Time after which an approach is given up, in s.
const LONGEST: f32 = 120.0;
/// Tolerance at the end: offset along and across in m, heading in rad.
const TOLERANCE: [f32; 2] = [0.06, 0.1];
/// Pose of the container (thesis 6.10.2).
pub const CONTAINER: Pose2 = Pose2::new(4.0, 0.0, 0.0);

/// Controller of an approach.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Controller {
    /// The law of the thesis: `ReactiveApproach`.
    Reactive,
    /// `PlannedApproach`.
    Planned,
}

/// End of an approach.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum End {
    /// Tractor and trailer are beneath the container.
    Beneath,
    /// The controller gave up, or stopped elsewhere.
    Missed,
    /// The vehicle touched a wheel of the container.
    Contact,
    /// The vehicle was still on its way.
    TooLate,
}

/// One approach.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Approach {
    /// Controller.
    pub controller: Controller,
    /// Pose of the tractor at the start, with the trailer in line.
    pub start: Pose2,
    /// End.
    pub end: End,
    /// Duration, in s.
    pub time: f32,
    /// Larger one of the offsets of tractor and trailer from the middle of the container, across, in m.
    pub offset: f32,
}

impl Controller {
    /// Both controllers.
    pub const ALL: [Self; 2] = [Self::Reactive, Self::Planned];
}

impl fmt::Display for Controller {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Reactive => "reactive",
            Self::Planned => "planned",
        })
    }
}

/// Start poses of the thesis: a grid of 0.5 m with three headings each, 459 in all.
pub fn starts() -> impl Iterator<Item = Pose2> {
    let grid = (0..9_u8).flat_map(|i| (0..17_u8).map(move |j| (0.5 * f32::from(i) - 2.0, 0.5 * f32::from(j) - 4.0)));
    grid.flat_map(|(x, y)| [-0.5, 0.0, 0.5].map(|theta| Pose2::new(x, y, theta)))
}

/// Node behind the common ports.
enum Node {
    Reactive(ReactiveApproach),
    Planned(Box<PlannedApproach>),
}

impl Node {
    fn new(controller: Controller) -> Self {
        let vehicle = Articulated::PATSY;
        match controller {
            Controller::Reactive => Self::Reactive(ReactiveApproach::construct((
                0.7, 1.8, 0.6, 0.5, 0.05, 0.5, 0.5, 0.4, 1.0, vehicle, 0.05, 0.5,
            ))),
            Controller::Planned => Self::Planned(Box::new(PlannedApproach::construct((
                0.8,
                1.0,
                0.5,
                0.03,
                0.2,
                vehicle,
                LENGTH,
                WIDTH + 0.08,
                0.43,
                0.05,
                0.05,
                0.05,
                0.05,
                Clearance::PATSY,
                0.5,
            )))),
        }
    }

    /// Twist, or `None` at the end.
    fn fire(&mut self, now: Time, vehicle: &Tractor) -> Option<Twist> {
        let (ctx, base, trailer) = (Ctx::new(now).of_node(true), vehicle.base.pose, vehicle.trailer_pose());
        let (mut reached, mut missed) = (None, None);
        let events: [Event<'_, ()>; 2] = [apex_rt::event(&mut reached), apex_rt::event(&mut missed)];
        let [r, m] = events;
        let twist = match self {
            Self::Reactive(node) => node.process(&ctx, Some(&base), Some(&trailer), Some(&CONTAINER), r, m),
            Self::Planned(node) => node.process(&ctx, Some(&base), Some(&trailer), Some(&CONTAINER), None, r, m),
        };
        let twist = twist.expect("the hall is near the origin").unwrap_or_default();
        (reached.is_none() && missed.is_none()).then_some(twist)
    }
}

/// Drives from `start` until the end. The seed draws the directions of the castors.
pub fn drive(controller: Controller, seed: u64, start: Pose2) -> Approach {
    let world = container(seed);
    let mut vehicle = tractor(start);
    let mut node = Node::new(controller);
    let at_end = |end, vehicle: &Tractor, time| Approach { controller, start, end, time, offset: offset(vehicle) };
    for period in 0..(LONGEST * 1000.0 / PERIOD as f32) as i64 {
        let time = (period * PERIOD) as f32 * 1e-3;
        let Some(twist) = node.fire(Time::from_millis(period * PERIOD), &vehicle) else {
            let end = if is_beneath(&vehicle) { End::Beneath } else { End::Missed };
            return at_end(end, &vehicle, time);
        };
        for _ in 0..STEPS {
            vehicle.step(&twist, PERIOD as f32 * 1e-3 / f32::from(STEPS));
        }
        if vehicle.footprints().iter().any(|f| f.clearance(&world) <= 0.0) {
            return at_end(End::Contact, &vehicle, time);
        }
    }
    at_end(End::TooLate, &vehicle, LONGEST)
}

/// Wheels of the container, nearly parallel, as those of the mock-up of the thesis.
fn container(seed: u64) -> World {
    let mut random = Random::new(seed);
    let castors = [0; 4].map(|_| CONTAINER.theta + random.uniform(-0.3, 0.3));
    let mut world = World::default();
    Cart::new(CONTAINER, castors).add_to(&mut world);
    world
}

fn offset(vehicle: &Tractor) -> f32 {
    let rear = Articulated::PATSY.rear_most(&vehicle.trailer_pose());
    let base = vehicle.base.pose.relative_to(&CONTAINER);
    base.y.abs().max(CONTAINER.to_inner(rear).y.abs())
}

fn is_beneath(vehicle: &Tractor) -> bool {
    let [distance, angle] = TOLERANCE;
    let base = vehicle.base.pose.relative_to(&CONTAINER);
    let turn = |theta: f32| libm::remainderf(theta - CONTAINER.theta, 2.0 * PI).abs();
    (base.x - Articulated::PATSY.axis()).abs() <= distance
        && offset(vehicle) <= distance
        && turn(vehicle.base.pose.theta) <= angle
        && turn(vehicle.trailer) <= angle
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_starts_are_those_of_the_thesis() {
        let all: Vec<Pose2> = starts().collect();
        assert_eq!(all.len(), 459);
        assert_eq!((all[0], all[458]), (Pose2::new(-2.0, -4.0, -0.5), Pose2::new(2.0, 4.0, 0.5)));
    }

    #[test]
    fn from_ahead_both_arrive_and_from_the_side_only_the_plan() {
        let end = |controller, start| drive(controller, 1, start).end;
        for controller in Controller::ALL {
            assert_eq!(end(controller, Pose2::new(0.0, 0.0, 0.0)), End::Beneath, "{controller}");
        }
        let side = Pose2::new(2.0, 3.0, 0.5);
        assert_ne!(end(Controller::Reactive, side), End::Beneath);
        assert_eq!(end(Controller::Planned, side), End::Beneath);
    }
}
