//! The cart and its nodes. Each machine has a package of its own with the driver: `bare` and `rtic` in
//! `robots/firmware` of the repository of Apex.
#![no_std]

mod line;

pub use line::Line;

use apex_macros::graph;
use apex_rt::prelude::*;

graph!("../firmware.afg");

/// Simulated motor with a delayed response to its voltage. Takes the place of an encoder and a motor driver.
#[node]
pub struct Motor {
    /// Final speed of the cart at a voltage of 1 V.
    #[param(unit = "m/s", default = 0.1, range = 0.0..=1.0)]
    gain: f64,
    /// Share of the speed difference that is made up in one period.
    #[param(default = 0.2, range = 0.0..=1.0)]
    share: f64,
    power: f64,
    speed: f64,
}

#[node]
impl Motor {
    /// Sends the speed of the cart.
    fn process(&mut self) -> f64 {
        self.speed += self.share * (self.gain * self.power - self.speed);
        self.speed
    }

    /// Sets the voltage of the motor, in V.
    #[slot]
    fn drive(&mut self, power: &f64) {
        self.power = *power;
    }
}

/// PI controller of the speed. The desired speed is 0 until the slot `go` receives a token.
#[node]
pub struct SpeedControl {
    /// Desired speed.
    #[param(unit = "m/s", range = 0.0..=2.0)]
    speed: f64,
    /// Proportional gain, in V per m/s.
    #[param(default = 4.0, range = 0.0..)]
    proportional: f64,
    /// Integral gain, in V/s per m/s.
    #[param(default = 40.0, range = 0.0..)]
    integral: f64,
    goes: bool,
    sum: f64,
    last: Option<Time>,
}

#[node]
impl SpeedControl {
    fn process(&mut self, measured: &f64, ctx: &Ctx) -> f64 {
        let wanted = if self.goes { self.speed } else { 0.0 };
        let error = wanted - measured;
        // A multiplication: without a floating-point unit, a division takes 900 bytes.
        let elapsed = self.last.map_or(0.0, |last| (ctx.now().as_nanos() - last.as_nanos()) as f64 * 1e-9);
        self.last = Some(ctx.now());
        self.sum += self.integral * error * elapsed;
        self.proportional * error + self.sum
    }

    /// Drives at the desired speed.
    #[slot]
    fn go(&mut self) {
        self.goes = true;
    }

    /// Brakes.
    #[slot]
    fn halt(&mut self) {
        self.goes = false;
        self.sum = 0.0;
    }
}

/// Writes the events, and twice per second the speed of the cart.
pub fn tell(cart: &mut Cart, now: Time, write: fn(&[u8])) {
    let milliseconds = (now.as_nanos() / 1_000_000) as u32;
    let line = || Line::new().number(milliseconds).text(" ms: ");
    if cart.events().starts.take().is_some() {
        line().text("starts").write(write);
    }
    if cart.events().stops.take().is_some() {
        line().text("stops").write(write);
    }
    if milliseconds.is_multiple_of(500)
        && let Some(speed) = cart.outputs().measured
    {
        line().number((speed * 1000.0 + 0.5) as u32).text(" mm/s").write(write);
    }
}
