//! Choice of the limits of the detection of pallets by cross-validation over blocks of time.

mod folds;
mod knobs;

pub use folds::{Data, validate};
