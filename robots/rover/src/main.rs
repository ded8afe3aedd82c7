//! Drives the robot of `robot.afg` by the system clock, or with `--fast` as fast as the machine can.

use apex_macros::graph;
use apex_rt::prelude::*;

graph!("robot.afg");

fn main() {
    if std::env::args().any(|argument| argument == "--fast") {
        run(Robot::new(), SimClock::until(Time::from_secs(3600)));
    } else {
        run(Robot::new(), WallClock::new());
    }
}
