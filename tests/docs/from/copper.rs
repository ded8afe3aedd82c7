use apex_macros::graph;
use apex_rt::prelude::*;

/// The speed, but no more than `most`.
#[node]
pub fn limit(speed: &f64, #[param(unit = "m/s", range = 0.0..=10.0)] most: f64) -> f64 {
    speed.min(most)
}

/// A sensor, as far as this example needs one.
#[node]
#[derive(Default)]
pub struct Sensor {
    speed: f64,
}

#[node]
impl Sensor {
    fn process(&mut self) -> f64 {
        self.speed += 0.4;
        self.speed
    }
}

/// A motor, likewise.
#[node]
#[derive(Default)]
pub struct Motor {
    pub speed: f64,
}

#[node]
impl Motor {
    fn process(&mut self, speed: &f64) {
        self.speed = *speed;
    }
}

graph! {
    robot Driven {
        node motor = Motor();
        Sensor() every 20ms -> limit(most = 1.5m/s) -> motor;
    }
}

pub fn main() {
    let mut robot = Driven::new();
    for step in 0..10 {
        robot.react(Time::from_millis(20 * step));
    }
    assert_eq!(robot.nodes().motor.speed, 1.5);
}
