//! A program in a crate of its own.
use apex_macros::graph;
use apex_rt::prelude::*;

#[node]
fn ramp() -> u64 {
    1
}

#[node]
fn show(x: &u64) {
    assert_eq!(*x, 1);
}

graph! {
    graph Fine {
        ramp() -> show();
    }
}

fn main() {
    Fine::new().react(Time::ZERO);
}
