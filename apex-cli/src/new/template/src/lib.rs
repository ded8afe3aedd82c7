//! The nodes of this robot. Those of `apex-nodes` are there as well; both are used alike in `robot.afg`.

use apex_rt::prelude::*;

/// Stands for a distance sensor: the robot comes nearer to a wall, and the wall is gone again.
#[node]
#[derive(Default)]
pub struct Sensor {
    /// How far it comes with each measurement.
    #[param(unit = "m", default = 0.1, range = 0.01..=1.0)]
    step: f32,
    count: u16,
}

#[node]
impl Sensor {
    /// The distance in m, between 0 and 1.
    fn process(&mut self) -> f32 {
        self.count += 1;
        1.0 - (f32::from(self.count) * self.step) % 1.0
    }
}

/// Stands for a motor: says what it does.
#[node]
#[derive(Default)]
pub struct Motor;

#[node]
impl Motor {
    #[slot]
    fn drive(&mut self) {
        println!("drive");
    }

    #[slot]
    fn turn(&mut self) {
        println!("a wall: turn");
    }
}
