//! Drives the robot of `robot.afg` by the system clock. Ctrl-C ends it with a twist of zero.

use apex_macros::graph;
use apex_rt::prelude::*;

graph!("robot.afg");

fn main() {
    run(Robot::new(), WallClock::new());
}
