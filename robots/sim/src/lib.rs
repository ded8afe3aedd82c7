//! A small simulator for robots made with Apex: worlds, the bases of robots that move in them with wheels that measure it,
//! laser scanners, and, with the feature `camera`, cameras.
//!
//! Deterministic: the same seed gives the same scans on every platform. Much faster than real time.
//!
//! Units are SI, axes follow the ROS convention.

#[cfg(feature = "camera")]
mod camera;
mod drive;
mod laser;
mod odometry;
#[cfg(feature = "camera")]
mod scene;
mod world;

pub use apex_nodes::math::Random;
#[cfg(feature = "camera")]
pub use camera::{Light, NotLevel, Photographer, expose};
pub use drive::{Differential, Limits, Omnidirectional, Tractor};
pub use laser::Laser;
pub use odometry::{Odometry, OdometryNoise};
#[cfg(feature = "camera")]
pub use scene::{Look, Panel, Picture, Pillar, Scene};
pub use world::{Disc, Wall, World};
