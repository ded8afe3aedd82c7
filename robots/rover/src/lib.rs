//! The nodes of a rover that drives up and down a corridor.

use apex_rt::prelude::*;

graph!("../rover.afg");

/// The distance where it is less than `limit`, and no message else.
#[node]
pub fn near(distance: &f64, #[param(unit = "m", range = 0.0..=10.0)] limit: f64) -> Option<f64> {
    (*distance < limit).then_some(*distance)
}

/// A corridor with a wall at both ends, and the rover in it. Stands in for motors and a sensor.
#[node]
pub struct Corridor {
    /// From wall to wall.
    #[param(unit = "m", default = 4.0, range = 1.0..=100.0)]
    length: f64,
    /// How fast the rover drives.
    #[param(unit = "m/s", default = 0.5, range = 0.0..=2.0)]
    speed: f64,
    travelled: f64,
    drives: bool,
    last: Time,
}

#[node]
impl Corridor {
    /// Sends the distance to the wall ahead.
    fn process(&mut self, ctx: &Ctx) -> f64 {
        if self.drives {
            self.travelled += self.speed * ctx.now().since(self.last).as_secs_f64();
        }
        self.last = ctx.now();
        self.length - self.travelled
    }

    /// Drives.
    #[slot]
    fn go(&mut self) {
        self.drives = true;
    }

    /// Stops and looks the other way.
    #[slot]
    fn turn(&mut self) {
        self.drives = false;
        self.travelled = self.length - self.travelled;
    }
}

/// Says on the screen that the rover turns.
#[node]
#[derive(Default)]
pub struct Say;

#[node]
impl Say {
    #[slot]
    fn turn(&mut self, distance: &f64, ctx: &Ctx) {
        println!("{}: the wall is {distance:.2} m away", ctx.now());
    }
}
