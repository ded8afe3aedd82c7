//! Camera images (feature `image`): the detection of targets by their cross (thesis 4.3.1), bar codes (4.3.3, feature
//! `barcode`), and adaptive thresholds, morphology and blobs (figure 9.1); things of a colour and
//! a shape that stand on the ground (8.3).
//!
//! Pixel coordinates start in the upper left corner: u to the right, v down; the centre of the first pixel is (0, 0).
//! An image without pixels, or with another size than that of its camera, gives ⊥ or an empty result, as documented
//! for each node.

mod adaptive;
#[cfg(feature = "barcode")]
mod barcode;
mod blobs;
mod camera;
mod canny;
mod color_mask;
mod components;
mod edges;
mod gray;
mod hat;
mod hough;
mod light;
mod mask;
#[cfg(feature = "record")]
mod message;
mod morphology;
mod picture;
mod region;
mod standing;
mod target;
mod window;

pub use adaptive::AdaptiveThreshold;
#[cfg(feature = "barcode")]
pub use barcode::{BarCode, Symbology, bar_code};
pub use blobs::{Blob, Blobs, FindBlobs, MAX_BLOBS, MarkBlobs};
pub use camera::Camera;
pub use color_mask::ColorMask;
pub use components::Components;
pub use edges::Edges;
pub use gray::to_gray;
pub use hat::BlackHat;
pub use hough::{Line, Lines, MAX_LINES, ProbabilisticHough};
pub use mask::LaserMask;
pub use morphology::{Close, Dilate, Erode, Open};
pub use picture::{ColorImage, GrayImage, Image};
pub use region::{MAX_REGIONS, Normalize, Region, Regions, largest};
pub use standing::StandingBlob;
pub use target::{Target, TargetLines, TargetPose, fits_height, region_target};
