//! A robot of 50 nodes that `apex-bench compile` edits and builds again.

use apex_macros::graph;
use apex_rt::prelude::*;

graph!("robot50.afg");

fn main() {
    run(Robot50::new(), SimClock::until(Time::from_secs(1)));
}
