//! Localization on a map of line segments (feature `localize`; thesis 6.9): a look-up table of visible segments, and a
//! particle filter on it.

mod beam;
mod bins;
mod cache;
mod estimate;
mod filter;
mod motion;
mod node;
mod particle;
mod search;
mod shadow;
mod table;

pub use beam::BeamModel;
pub use cache::Cached;
pub use estimate::PoseEstimate;
pub use filter::{Change, Filter, Settings};
pub use motion::MotionNoise;
pub use node::{LocalizerError, VectorMapLocalizer};
pub use search::SearchSettings;
pub use table::{TableError, TableSettings, View, VisibilityTable};
