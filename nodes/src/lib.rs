//! The node library of Apex: one module per field.
//!
//! `flow`, `math` and `scan` need neither the standard library nor a heap. The feature `std` (on by default)
//! adds `io` (readers, writers and pictures) and `map` (grid maps), the feature `slam` localization and mapping.
//!
//! Units are SI (metres, radians, seconds), axes follow the ROS convention: x forward, y left, angles
//! counter-clockwise.
#![cfg_attr(not(any(feature = "std", test)), no_std)]

pub mod flow;
#[cfg(feature = "std")]
pub mod io;
#[cfg(feature = "std")]
pub mod map;
pub mod math;
pub mod scan;
#[cfg(feature = "slam")]
pub mod slam;
