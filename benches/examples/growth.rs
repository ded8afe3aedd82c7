//! A graph of as many nodes as `apex-bench compile` writes into its text.

use apex_macros::graph;
use apex_rt::prelude::*;

graph!("growth.afg");

fn main() {
    let mut growth = Growth::new();
    println!("{:?}", growth.react(Time::ZERO));
}
