//! A small simulator for robots made with Apex: worlds, robot bases with wheel odometry, laser scanners, cameras
//! (feature `camera`), time-of-flight cameras (feature `tof`), buildings from plans (feature `building`), people
//! (feature `people`), and open country (feature `outdoor`). Programs that run robots in such worlds and measure them
//! use `experiment` (feature `experiment`).
//!
//! Available as nodes: a [`DifferentialBase`], a [`TractorBase`] with trailer and lift, a [`Battery`], and a
//! [`LaserScanner`] in a world drawn with characters ([`FloorPlan`]), and a [`LiveView`] of it. `apex new` creates a
//! robot with such nodes.
//!
//! Deterministic: the same seed gives the same scans on every platform. Much faster than real time.
//!
//! Units are SI, axes follow the ROS convention.

mod base;
mod battery;
#[cfg(feature = "building")]
mod building;
#[cfg(feature = "camera")]
mod camera;
#[cfg(feature = "camera")]
mod color;
mod drive;
#[cfg(feature = "experiment")]
pub mod experiment;
mod fault;
mod held_twist;
mod jobs;
mod laser;
mod latency;
mod odometry;
#[cfg(feature = "building")]
mod office;
mod outage;
#[cfg(feature = "outdoor")]
pub mod outdoor;
mod payload;
#[cfg(feature = "people")]
mod people;
mod plan;
mod pose_track;
mod push;
mod say;
mod scanner;
#[cfg(feature = "camera")]
mod scene;
mod shared;
mod stream;
#[cfg(feature = "tof")]
pub mod tof;
#[cfg(feature = "building")]
mod tour;
mod tractor;
mod view;
mod world;

pub use apex_nodes::math::Random;
pub use base::DifferentialBase;
pub use battery::Battery;
#[cfg(feature = "building")]
pub use building::Building;
#[cfg(feature = "camera")]
pub use camera::{CameraSim, Light, NotLevel, expose};
#[cfg(feature = "camera")]
pub use color::{ColorCamera, ColorScene, Paint, Post};
pub use drive::{Differential, Limits, Omnidirectional, Tractor};
pub use fault::{Fault, fault_named};
pub use held_twist::HeldTwist;
pub use jobs::in_order;
pub use laser::Laser;
pub use latency::Latency;
pub use odometry::{Odometry, OdometryNoise};
#[cfg(feature = "building")]
pub use office::OfficePlan;
pub use outage::{MotionWatch, Outage, OutageTable, Promise, Stops, outages};
pub use payload::{Footprint, Lift};
#[cfg(feature = "people")]
pub use people::{Crowd, Pedestrian};
pub use plan::{FloorPlan, PlanError};
pub use pose_track::PoseTrack;
pub use push::pushed;
pub use say::say;
pub use scanner::LaserScanner;
#[cfg(feature = "camera")]
pub use scene::{Look, Panel, Picture, Pillar, Scene};
pub use shared::{Shared, Simulation};
pub use stream::stream;
#[cfg(feature = "building")]
pub use tour::{BuildingTour, Tour, TourError};
pub use tractor::TractorBase;
pub use view::{LiveView, ViewError};
pub use world::{Disc, Wall, World};
