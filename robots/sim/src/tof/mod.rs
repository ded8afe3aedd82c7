//! Time-of-flight camera in a world of solids (thesis 6.4; feature `tof`).

mod camera;
mod optics;
mod ray;
mod sight;
mod solid;
mod space;
mod vector;

pub use camera::{Distortion, TofCamera, TofFrame};
pub use solid::{Material, Shape, Solid, SolidKind};
pub use space::{Floor, Pit, Space, Truth};
