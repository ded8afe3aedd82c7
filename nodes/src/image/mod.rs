//! Camera images (feature `image`): the detection of targets by their cross (thesis 4.3.1).
//!
//! Pixels are counted from the upper left: u to the right, v down; the centre of the first pixel is (0, 0). An image
//! without pixels, or of another size than its camera has, gives ⊥ or an error, as each node says.

mod camera;
#[cfg(feature = "record")]
mod message;
mod picture;

pub use camera::Camera;
pub use picture::{ColorImage, GrayImage, Image, to_gray};
