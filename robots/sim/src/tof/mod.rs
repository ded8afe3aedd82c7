//! Time-of-flight camera in a world of solids (thesis 6.4; feature `tof`).

mod camera;
mod frame;
mod optics;
mod ray;
mod sight;
mod solid;
mod space;
mod vector;

pub use camera::{Distortion, TofCamera};
pub use frame::TofFrame;
pub use solid::{Material, Shape, Solid, SolidKind};
pub use space::{Floor, Pit, Space, Truth};
