//! The second line of the message is the place in the source file.
use apex_rt::prelude::*;

#[node]
fn ramp() -> u64 {
    1
}

graph!("wrong.afg");
graph!("missing.afg");

fn main() {}
