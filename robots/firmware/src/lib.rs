//! The cart and its nodes. What drives it is a package of its own for each machine: `bare` and `rtic` in
//! `robots/firmware` of the repository of Apex.
#![no_std]

mod line;

pub use line::Line;

use apex_rt::prelude::*;

graph!("../firmware.afg");

/// A motor that gets as fast as its power says, with some delay. Stands in for an encoder and a motor driver.
#[node]
pub struct Motor {
    /// How fast the cart is in the end with a power of 1 V.
    #[param(unit = "m/s", default = 0.1, range = 0.0..=1.0)]
    gain: f64,
    /// Part of the way to this speed that is made in one period.
    #[param(default = 0.2, range = 0.0..=1.0)]
    share: f64,
    power: f64,
    speed: f64,
}

#[node]
impl Motor {
    /// Sends how fast the cart is.
    fn process(&mut self) -> f64 {
        self.speed += self.share * (self.gain * self.power - self.speed);
        self.speed
    }

    /// Sets the power, in volts.
    #[slot]
    fn drive(&mut self, power: &f64) {
        self.power = *power;
    }
}

/// A PI controller of the speed. It takes the wanted speed to be 0 until it is told to go.
#[node]
pub struct SpeedControl {
    /// The wanted speed.
    #[param(unit = "m/s", range = 0.0..=2.0)]
    speed: f64,
    /// Volts for an error of 1 m/s.
    #[param(default = 4.0, range = 0.0..)]
    proportional: f64,
    /// Volts more for each second of it.
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
        // A multiplication: where numbers have no unit of their own, a division takes 900 bytes.
        let elapsed = self.last.map_or(0.0, |last| (ctx.now().as_nanos() - last.as_nanos()) as f64 * 1e-9);
        self.last = Some(ctx.now());
        self.sum += self.integral * error * elapsed;
        self.proportional * error + self.sum
    }

    /// Drives at the wanted speed.
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

/// Writes what happened, and twice a second how fast the cart is.
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
