//! The nodes of this robot, beside those of the libraries.

use apex_nodes::{
    nav::Twist,
    scan::{Point2, Pose2, Scan},
};
use apex_rt::prelude::*;

/// The world that is simulated, as a drawing.
pub const WORLD: &str = include_str!("../world.txt");

/// How far a robot that is twice `half_width` wide can drive straight ahead, as its scanner sees it, in m.
#[node]
pub fn free_ahead(scan: &Scan, #[param(unit = "m", default = 0.25, range = 0.0..=2.0)] half_width: f32) -> f32 {
    let ahead = scan.points().map(|(_, point)| point).filter(|point| point.x > 0.0 && point.y.abs() < half_width);
    ahead.map(|point| point.x).fold(scan.range_max, f32::min)
}

/// Drives straight ahead while it is active, until something is near.
#[node]
#[derive(Default)]
pub struct Drive {
    /// How fast it drives.
    #[param(unit = "m/s", default = 0.6, range = 0.0..=2.0)]
    speed: f32,
    /// Nearer than this is near.
    #[param(unit = "m", range = 0.0..=10.0)]
    near: f32,
}

#[node]
impl Drive {
    fn process(&mut self, ctx: &Ctx, free: &f32, blocked: Event<()>) -> Option<Twist> {
        if !ctx.active() {
            return None;
        }
        if *free < self.near {
            blocked.emit(());
            return Some(Twist::ZERO);
        }
        Some(Twist::new(self.speed.min(*free), 0.0, 0.0))
    }
}

/// Turns while it is active, to the side that is wider, until the way ahead is free. The longer it turns, the less will
/// do: half of `free` and a little more.
#[node]
#[derive(Default)]
pub struct Turn {
    /// How fast it turns.
    #[param(unit = "rad/s", default = 1.0, range = 0.01..=5.0)]
    speed: f32,
    /// So much has to be free ahead.
    #[param(unit = "m", range = 0.0..=10.0)]
    free: f32,
    wish: f32,
    to_left: Option<bool>,
}

#[node]
impl Turn {
    fn process(&mut self, ctx: &Ctx, free: &f32, scan: &Scan, done: Event<()>) -> Option<Twist> {
        if !ctx.active() {
            return None;
        }
        self.wish = (0.99 * self.wish).max(0.55 * self.free);
        if *free >= self.wish {
            done.emit(());
            return Some(Twist::ZERO);
        }
        let to_left = *self.to_left.get_or_insert_with(|| scan.points().map(|(_, point)| point.y).sum::<f32>() > 0.0);
        Some(Twist::new(0.0, 0.0, if to_left { self.speed } else { -self.speed }))
    }

    /// It chooses the side when it begins.
    #[on_activate]
    fn begin(&mut self) {
        self.wish = self.free;
        self.to_left = None;
    }
}

/// Says whether the battery is full enough, each time that it is asked.
#[node]
#[derive(Default)]
pub struct AskBattery {
    /// Less than this is low: 1 is full.
    #[param(default = 0.3, range = 0.0..=1.0)]
    low: f32,
    charge: f32,
}

#[node]
impl AskBattery {
    fn process(&mut self, battery: &f32) {
        self.charge = *battery;
    }

    /// Asks.
    #[slot]
    fn put(&mut self, full: Event<()>, low: Event<()>) {
        if self.charge < self.low { low.emit(()) } else { full.emit(()) }
    }
}

/// Keeps its way in mind, and drives it back to where it began while it is active.
#[node]
#[derive(Default)]
pub struct Retrace {
    /// How fast it drives.
    #[param(unit = "m/s", default = 0.6, range = 0.0..=2.0)]
    speed: f32,
    /// How far the places that it keeps in mind are apart.
    #[param(unit = "m", default = 0.3, range = 0.05..=5.0)]
    step: f32,
    /// How near to a place is there.
    #[param(unit = "m", default = 0.1, range = 0.01..=1.0)]
    tolerance: f32,
    way: Vec<Point2>,
}

#[node]
impl Retrace {
    fn process(&mut self, ctx: &Ctx, pose: &Pose2, there: Event<()>) -> Option<Twist> {
        let here = pose.position();
        if !ctx.active() {
            self.keep(here);
            return None;
        }
        while self.way.last().is_some_and(|place| (*place - here).norm() < self.tolerance) {
            self.way.pop();
        }
        let Some(next) = self.way.last().map(|place| pose.to_inner(*place)) else {
            there.emit(());
            return Some(Twist::ZERO);
        };
        // Turns first where the place is not ahead.
        let speed = self.speed.min(5.0 * next.norm()) * next.angle().cos().max(0.0).powi(3);
        Some(Twist::new(speed, 0.0, 3.0 * next.angle()))
    }

    /// Adds a place, or takes back the way that it has made since it was here before: so it never gets longer than the
    /// world is large.
    fn keep(&mut self, here: Point2) {
        match self.way.iter().position(|place| (*place - here).norm() < self.step) {
            Some(known) => self.way.truncate(known + 1),
            None => self.way.push(here),
        }
    }
}
