//! Learning from examples: forests of decision trees, which need neither the standard library nor a heap; with the
//! feature `learn` their training, multilayer perceptrons and classifiers (thesis 4.3.2, 4.3.3).
//!
//! With the feature `image` in addition, features can be taken from images.

#[cfg(all(feature = "learn", feature = "image"))]
mod acf;
#[cfg(feature = "learn")]
mod classifier;
mod forest;
#[cfg(all(feature = "learn", feature = "image"))]
mod glyph;
#[cfg(all(feature = "learn", feature = "image"))]
mod gradient;
#[cfg(feature = "learn")]
mod grow;
#[cfg(all(feature = "learn", feature = "image"))]
mod hog;
#[cfg(feature = "learn")]
mod mlp;
#[cfg(feature = "learn")]
mod model;
#[cfg(all(feature = "learn", feature = "image"))]
mod patch;
#[cfg(feature = "learn")]
mod svm;
#[cfg(feature = "learn")]
mod train;

#[cfg(all(feature = "learn", feature = "image"))]
pub use acf::{ACF_FEATURES, acf_features};
#[cfg(feature = "learn")]
pub use classifier::{Class, Classifier, ForestClassifier};
#[cfg(feature = "std")]
pub use forest::forest_bytes;
pub use forest::{BadForest, Forest, TreeNode};
#[cfg(all(feature = "learn", feature = "image"))]
pub use glyph::{GLYPH_SIDE, glyph_features};
#[cfg(feature = "learn")]
pub use grow::ForestTrainer;
#[cfg(all(feature = "learn", feature = "image"))]
pub use hog::{HOG_FEATURES, hog_features};
#[cfg(feature = "learn")]
pub use mlp::{Activity, Features, Layer, MAX_FEATURES, Mlp};
#[cfg(feature = "learn")]
pub use model::{BadModel, Model};
#[cfg(all(feature = "learn", feature = "image"))]
pub use patch::{PATCH_SIDE, deviation, patch_features};
#[cfg(feature = "learn")]
pub use svm::train_svm;
#[cfg(feature = "learn")]
pub use train::{Example, Trainer};

/// Model that classifies the digits 0 to 9 from [`glyph_features`]; the class number is the digit. Trained by the
/// example `train_digits` on digits that it draws itself.
#[cfg(feature = "learn")]
pub const DIGITS: &[u8] = include_bytes!("digits.mlp");
