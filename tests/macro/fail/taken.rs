//! Types of the module that calls `graph!` have the names of generated ones.

use apex_macros::graph;
use apex_rt::prelude::*;

pub struct RobotParts;
pub struct Arm;

/// A node that is made in Rust.
#[node]
pub struct Lines {}

#[node]
impl Lines {
    fn process(&mut self) {}
}

graph! {
    robot Robot {
        node lines: Lines;
    }

    graph Arm {
        slot again;
        again -> exit;
    }
}

fn main() {}
