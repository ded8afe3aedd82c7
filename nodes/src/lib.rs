//! Node library of Apex, with one module per field.
//!
//! `action`, `flow`, `frames`, `lifecycle`, `math`, `persons`, `scan`, the inference of `learn` and the packets of
//! `lidar` need neither the standard library nor a heap. The feature `std` (on by default) adds `io` (readers, writers
//! and pictures), `map` (grid maps), `cloud` (point clouds of depth cameras and of scanners with rings), the turns of
//! `lidar`, and path planning and following in `nav`. Further features add `image` (camera images), `learn` (training,
//! and networks), `optim` (optimization of parameters), `slam` (localization and mapping), `localize` (localization on
//! a plan), `fuse` (a pose outdoors), `dxf` (plans from DXF files) and `urdf` (models of robots).
//!
//! Units are SI (metres, radians, seconds). Axes follow the ROS convention: x forward, y left, angles
//! counter-clockwise.
#![cfg_attr(not(any(feature = "std", test)), no_std)]

pub mod action;
#[cfg(feature = "std")]
pub mod cloud;
pub mod flow;
pub mod frames;
#[cfg(feature = "image")]
pub mod image;
#[cfg(feature = "std")]
pub mod io;
pub mod learn;
pub mod lidar;
pub mod lifecycle;
#[cfg(feature = "localize")]
pub mod localize;
#[cfg(feature = "std")]
pub mod map;
pub mod math;
pub mod nav;
#[cfg(feature = "optim")]
pub mod optim;
pub mod persons;
pub mod scan;
#[cfg(feature = "slam")]
pub mod slam;
