//! A small simulator for robots made with Apex: a plane world, and a laser scanner that looks at it.
//!
//! Deterministic: the same seed gives the same scans on every platform. Much faster than real time.
//!
//! Units are SI, axes follow the ROS convention.

mod laser;
mod world;

pub use apex_nodes::math::Random;
pub use laser::Laser;
pub use world::{Disc, Wall, World};
