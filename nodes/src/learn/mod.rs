//! What learns from examples (feature `learn`): multilayer perceptrons and the classifiers made of them (thesis 4.3.2,
//! 4.3.3).
//!
//! With the feature `image` as well, images give the features.

mod classifier;
#[cfg(feature = "image")]
mod glyph;
mod mlp;
mod model;
#[cfg(feature = "image")]
mod patch;
mod train;

pub use classifier::{Class, Classifier};
#[cfg(feature = "image")]
pub use glyph::{GLYPH_SIDE, glyph_features};
pub use mlp::{Activity, Features, Layer, MAX_FEATURES, Mlp};
pub use model::{BadModel, Model};
#[cfg(feature = "image")]
pub use patch::{PATCH_SIDE, deviation, patch_features};
pub use train::{Example, Trainer};

/// Reads the digits 0 to 9 from a [`glyph_features`]; class and digit are the same. Made by the example `train_digits`, from
/// digits that it draws itself.
pub const DIGITS: &[u8] = include_bytes!("digits.mlp");
