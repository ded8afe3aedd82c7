//! A small simulator for robots made with Apex: worlds, robot bases with wheel odometry, laser scanners, cameras
//! (feature `camera`) and time-of-flight cameras (feature `tof`).
//!
//! Available as nodes: a [`DifferentialBase`] and a [`LaserScanner`] in a world drawn with characters ([`FloorPlan`]),
//! and a [`LiveView`] of it. `apex new` creates a robot with these nodes.
//!
//! Deterministic: the same seed gives the same scans on every platform. Much faster than real time.
//!
//! Units are SI, axes follow the ROS convention.

mod base;
#[cfg(feature = "camera")]
mod camera;
mod drive;
mod laser;
mod note;
mod odometry;
mod plan;
mod scanner;
#[cfg(feature = "camera")]
mod scene;
#[cfg(feature = "tof")]
pub mod tof;
mod view;
mod world;

pub use apex_nodes::math::Random;
pub use base::DifferentialBase;
#[cfg(feature = "camera")]
pub use camera::{CameraSim, Light, NotLevel, expose};
pub use drive::{Differential, Limits, Omnidirectional, Tractor};
pub use laser::Laser;
pub use note::Note;
pub use odometry::{Odometry, OdometryNoise};
pub use plan::{FloorPlan, PlanError};
pub use scanner::LaserScanner;
#[cfg(feature = "camera")]
pub use scene::{Look, Panel, Picture, Pillar, Scene};
pub use view::{LiveView, ViewError};
pub use world::{Disc, Wall, World};
