//! Fusion of wheels, a gyroscope and satellite positions by an extended Kalman filter, outdoors.

mod align;
mod filter;
mod fix;
mod gyro;
mod inertial;
#[cfg(feature = "record")]
mod message;
mod node;
mod past;
#[cfg(test)]
mod tests;

pub use filter::{FixUse, FusionSettings, PoseFilter};
pub use fix::{GeoFix, PlaceFix, PositionFix, TangentPlane};
pub use inertial::Inertial;
pub use node::FusePose;
