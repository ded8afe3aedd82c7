//! Learning from examples (feature `learn`): multilayer perceptrons and classifiers (thesis 4.3.2, 4.3.3).
//!
//! With the feature `image` in addition, features can be taken from images.

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

/// Model that classifies the digits 0 to 9 from [`glyph_features`]; the class number is the digit. Trained by the
/// example `train_digits` on digits that it draws itself.
pub const DIGITS: &[u8] = include_bytes!("digits.mlp");
