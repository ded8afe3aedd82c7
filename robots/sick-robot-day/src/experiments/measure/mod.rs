//! Evaluates the compiled perception on rendered images, with one arena or hopper per seed.

mod cubes;
mod figures;
mod image_writer;
mod places;
mod signs;
mod targets;

pub use cubes::{Cubes, cubes};
pub use figures::{Confusion, Times, percentile};
pub use image_writer::ImageWriter;
pub use signs::{Signs, signs};
pub use targets::{Targets, targets};
