//! A cart on a rail that drives to a mark, and the study that tunes its controller (`cart.afg`).

use apex_macros::graph;
use apex_nodes::math::Random;
use apex_rt::prelude::*;

graph!("cart.afg");

/// Time between two firings of the cart, in s.
const STEP: f64 = 0.01;
/// Position of the mark, in m.
const MARK: f64 = 1.0;
/// Acceleration of which the motor is capable, in m/s².
const STRONGEST: f64 = 4.0;

/// Simulated cart. Its friction and the mass of its load differ from seed to seed.
#[node]
#[derive(Debug)]
pub struct Cart {
    /// Standard deviation of a measured position.
    #[param(unit = "m", default = 0.002, range = 0.0..=0.1)]
    noise: f32,
    /// Seed of load, friction and noise.
    #[param(default = 1)]
    seed: u64,
    random: Option<Random>,
    /// Acceleration for a command of 1 m/s², and friction in 1/s.
    body: (f64, f64),
    position: f64,
    speed: f64,
    command: f64,
}

#[node]
impl Cart {
    /// Takes an acceleration, in m/s².
    #[slot]
    fn push(&mut self, acceleration: &f64) {
        self.command = acceleration.clamp(-STRONGEST, STRONGEST);
    }

    /// Measures the position, in m.
    fn process(&mut self) -> f64 {
        let body = &mut self.body;
        let seed = self.seed;
        let random = self.random.get_or_insert_with(|| {
            let mut random = Random::new(seed);
            *body = (0.7 + 0.6 * random.unit(), 0.2 + 1.3 * random.unit());
            random
        });
        self.speed += STEP * (self.body.0 * self.command - self.body.1 * self.speed);
        self.position += STEP * self.speed;
        self.position + f64::from(random.normal(self.noise))
    }
}

/// Controller: a spring to the mark, and a damper.
#[node]
#[derive(Debug)]
pub struct Pilot {
    /// Acceleration per distance from the mark.
    #[param(unit = "1/s^2", default = 1.0, range = 0.1..=100.0)]
    stiffness: f64,
    /// Acceleration against the speed.
    #[param(unit = "1/s", default = 1.2, range = 0.0..=20.0)]
    damping: f64,
    /// Weight of a new speed: 1 takes the measured one as it is.
    #[param(default = 1.0, range = 0.01..=1.0)]
    smoothing: f64,
    last: Option<f64>,
    speed: f64,
}

#[node]
impl Pilot {
    /// Computes the acceleration, in m/s², for a measured position.
    fn process(&mut self, position: &f64) -> f64 {
        let measured = (position - self.last.unwrap_or(*position)) / STEP;
        self.last = Some(*position);
        self.speed += self.smoothing * (measured - self.speed);
        self.stiffness * (MARK - position) - self.damping * self.speed
    }
}

/// Root mean square of all distances from the mark so far.
#[node]
#[derive(Debug)]
pub struct Deviation {
    sum: f64,
    count: f64,
}

#[node]
impl Deviation {
    fn process(&mut self, position: &f64) -> f64 {
        self.sum += (position - MARK) * (position - MARK);
        self.count += 1.0;
        (self.sum / self.count).sqrt()
    }
}

/// Mean of the change of the command from one firing to the next: jerks wear the motor.
#[node]
#[derive(Debug)]
pub struct Wear {
    last: f64,
    sum: f64,
    count: f64,
}

#[node]
impl Wear {
    fn process(&mut self, command: &f64) -> f64 {
        let command = command.clamp(-STRONGEST, STRONGEST);
        self.sum += (command - self.last).abs();
        self.count += 1.0;
        self.last = command;
        self.sum / self.count
    }
}
