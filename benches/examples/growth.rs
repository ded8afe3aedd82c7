//! A graph whose number of nodes `apex-bench compile` chooses.

use apex_macros::graph;
use apex_rt::prelude::*;

graph!("growth.afg");

fn main() {
    let mut growth = Growth::new();
    println!("{:?}", growth.react(Time::ZERO));
}
