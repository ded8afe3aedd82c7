//! Drives the robot of `robot.afg` by the machine's clock.

use apex_rt::prelude::*;

graph!("robot.afg");

fn main() {
    run(Robot::new(), WallClock::new());
}
