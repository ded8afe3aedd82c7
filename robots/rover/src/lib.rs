//! Nodes of this robot, in addition to those of the libraries.

use apex_nodes::{
    nav::Twist,
    scan::{Point2, Pose2, Scan},
};
use apex_rt::prelude::*;

/// Drawing of the simulated world.
pub const WORLD: &str = include_str!("../world.txt");

/// Distance that a robot of the width `2 * half_width` can drive straight ahead, in m; ⊥ if the scanner has failed.
#[node]
pub fn free_ahead(
    ctx: &Ctx,
    scan: &Scan,
    #[param(unit = "m", default = 0.25, range = 0.0..=2.0)] half_width: f32,
    #[param(unit = "s", default = 0.5, range = 0.01..=10.0)] max_age: f32,
) -> Option<f32> {
    if !scan.measures_anything() || !is_young(ctx, scan.stamp, max_age) {
        return None;
    }
    let ahead = scan.points().map(|(_, point)| point).filter(|point| point.x > 0.0 && point.y.abs() < half_width);
    Some(ahead.map(|point| point.x).fold(scan.range_max, f32::min))
}

/// Returns `true` if what was measured at `stamp` is younger than `max_age` s.
fn is_young(ctx: &Ctx, stamp: Time, max_age: f32) -> bool {
    stamp <= ctx.now() && ctx.now().since(stamp).as_secs_f32() < max_age
}

/// Drives straight ahead while it is active, until an obstacle is near. Stands while the free distance is not known.
#[node]
#[derive(Default)]
pub struct Drive {
    /// Speed of the robot.
    #[param(unit = "m/s", default = 0.6, range = 0.0..=2.0)]
    speed: f32,
    /// Distance below which an obstacle is near.
    #[param(unit = "m", range = 0.0..=10.0)]
    near: f32,
    /// Maximum age of the free distance. If nothing comes for this time, the node is called without it.
    #[param(unit = "s", default = 0.5, range = 0.01..=10.0, silence)]
    max_age: f32,
}

#[node]
impl Drive {
    fn process(&mut self, ctx: &Ctx, free: Option<&f32>, blocked: Event<()>) -> Option<Twist> {
        if !ctx.active() {
            return None;
        }
        let is_known = |free: &&f32| free.is_finite() && is_young(ctx, ctx.stamp(), self.max_age);
        let Some(free) = free.filter(is_known) else { return Some(Twist::ZERO) };
        if *free < self.near {
            blocked.emit(());
            return Some(Twist::ZERO);
        }
        Some(Twist::new(self.speed.min(*free), 0.0, 0.0))
    }
}

/// Turns while it is active, to the side with more space, until the robot can drive ahead. The required free distance
/// shrinks in time from `free` to slightly more than half of it. Stands without scans.
#[node]
#[derive(Default)]
pub struct Turn {
    /// Angular velocity of the robot.
    #[param(unit = "rad/s", default = 1.0, range = 0.01..=5.0)]
    speed: f32,
    /// Free distance ahead at which the turn ends.
    #[param(unit = "m", range = 0.0..=10.0)]
    free: f32,
    /// Maximum age of a scan and of the free distance.
    #[param(unit = "s", default = 0.5, range = 0.01..=10.0, silence)]
    max_age: f32,
    wish: f32,
    to_left: Option<bool>,
}

#[node]
impl Turn {
    fn process(&mut self, ctx: &Ctx, free: Option<&f32>, scan: Option<&Scan>, done: Event<()>) -> Option<Twist> {
        if !ctx.active() {
            return None;
        }
        let is_known = |(free, _): &(&f32, &Scan)| free.is_finite() && is_young(ctx, ctx.stamp(), self.max_age);
        let Some((free, scan)) = free.zip(scan).filter(is_known) else { return Some(Twist::ZERO) };
        self.wish = (0.99 * self.wish).max(0.55 * self.free);
        if *free >= self.wish {
            done.emit(());
            return Some(Twist::ZERO);
        }
        let to_left = *self.to_left.get_or_insert_with(|| scan.points().map(|(_, point)| point.y).sum::<f32>() > 0.0);
        Some(Twist::new(0.0, 0.0, if to_left { self.speed } else { -self.speed }))
    }

    /// Resets the side, which is chosen in the next firing.
    #[on_activate]
    fn begin(&mut self) {
        self.wish = self.free;
        self.to_left = None;
    }
}

/// Reports on request whether the battery is full enough.
#[node]
#[derive(Default)]
pub struct AskBattery {
    /// Charge below which the battery is low; 1 is full.
    #[param(default = 0.3, range = 0.0..=1.0)]
    low: f32,
    charge: f32,
}

#[node]
impl AskBattery {
    fn process(&mut self, battery: &f32) {
        self.charge = *battery;
    }

    /// Triggers `full` or `low`, according to the last charge. One that is not a number is low.
    #[slot]
    fn put(&mut self, full: Event<()>, low: Event<()>) {
        if self.charge >= self.low { full.emit(()) } else { low.emit(()) }
    }
}

/// Remembers the path of the robot, and drives it back to its start while it is active. Stands without a pose.
#[node]
#[derive(Default)]
pub struct Retrace {
    /// Maximum speed of the robot.
    #[param(unit = "m/s", default = 0.6, range = 0.0..=2.0)]
    speed: f32,
    /// Distance between remembered places.
    #[param(unit = "m", default = 0.3, range = 0.05..=5.0)]
    step: f32,
    /// Tolerance of the position at a place.
    #[param(unit = "m", default = 0.1, range = 0.01..=1.0)]
    tolerance: f32,
    /// Maximum age of a pose.
    #[param(unit = "s", default = 0.5, range = 0.01..=10.0, silence)]
    max_age: f32,
    way: Vec<Point2>,
}

#[node]
impl Retrace {
    fn process(&mut self, ctx: &Ctx, pose: Option<&Pose2>, there: Event<()>) -> Option<Twist> {
        let is_known = |pose: &&Pose2| pose.is_usable() && is_young(ctx, ctx.stamp(), self.max_age);
        let Some(pose) = pose.filter(is_known) else { return ctx.active().then_some(Twist::ZERO) };
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
        // Slower, the less the next place is ahead: the robot turns first.
        let speed = self.speed.min(5.0 * next.norm()) * next.angle().cos().max(0.0).powi(3);
        Some(Twist::new(speed, 0.0, 3.0 * next.angle()))
    }

    /// Adds a place, or removes the loop since the robot was last here. So the size of the world bounds the length of
    /// the path.
    fn keep(&mut self, here: Point2) {
        match self.way.iter().position(|place| (*place - here).norm() < self.step) {
            Some(known) => self.way.truncate(known + 1),
            None => self.way.push(here),
        }
    }
}
