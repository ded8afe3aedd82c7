//! A skid-steered robot that follows a runner outdoors at running speed (thesis 8.4), in simulation: the robot as
//! `follow.afg`, its world, and what becomes of its runs.

pub mod field;
pub mod runs;

use apex_nodes::{persons::Person, scan::Point2};
use apex_rt::node;

/// The robot of `follow.afg`.
pub mod robot {
    apex_macros::graph!("follow.afg");
}

/// Perception on its own: `perceive.afg`.
pub mod perception {
    apex_macros::graph!("perceive.afg");
}

/// Position of a person.
#[node]
pub fn place_of(person: &Person) -> Point2 {
    person.position
}
