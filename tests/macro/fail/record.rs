//! Tokens that cannot be recorded, although the text wants that: only rustc knows the traits of their types.
use apex_macros::graph;
use apex_rt::prelude::*;

#[derive(Clone)]
pub struct Cup(u8);

#[node]
fn camera() -> Cup {
    Cup(1)
}

#[node]
fn count(cup: &Cup) -> u8 {
    cup.0
}

#[node]
fn turn(cup: &Cup) -> Cup {
    cup.clone()
}

graph! {
    graph Robot {
        out seen: u8;
        node cam = camera();
        node upright = turn();
        cam -> upright -> count() -> seen;
        record "cups.mcap" { upright; }
    }
}

fn main() {}
