//! Localization (feature `localize`): on a map of line segments (thesis 6.9), by a look-up table of visible segments
//! and a particle filter on it; and outdoors (feature `fuse`), by a Kalman filter of wheels, a gyroscope and
//! satellites.

mod beam;
mod bins;
mod cache;
mod estimate;
mod filter;
#[cfg(feature = "fuse")]
mod fuse;
mod motion;
mod node;
mod particle;
mod search;
mod shadow;
mod table;

pub use beam::BeamModel;
pub use cache::Cached;
pub use estimate::PoseFit;
pub use filter::{Filter, Settings};
#[cfg(feature = "fuse")]
pub use fuse::{FixUse, FusePose, FusionSettings, GeoFix, Inertial, PlaceFix, PoseFilter, PositionFix, TangentPlane};
pub use motion::MotionNoise;
pub use node::{LocalizerError, VectorMapLocalizer};
pub use search::SearchSettings;
pub use table::{TableError, TableSettings, View, VisibilityTable};
