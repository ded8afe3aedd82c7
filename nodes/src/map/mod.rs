//! Grid maps of the plane, the detection of objects in them and their preparation for path planning; maps of signs and
//! of line segments (feature `std`).

mod clear;
mod containers;
mod distance;
mod grid;
mod grow;
mod mark;
#[cfg(feature = "record")]
mod message;
mod occupancy;
mod octagon;
mod seen;
mod signs;
mod surroundings;
mod unknown;
mod vector;

pub use clear::ClearBox;
pub use containers::MarkContainers;
pub use distance::DistanceTransform;
pub(crate) use grid::check_level;
#[cfg(test)]
pub(crate) use grid::drawn;
pub use grid::{Cell, Grid, MAX_CELLS, Occupancy, Raster, TooManyCells};
pub use grow::{GrowObstacles, grow};
pub use mark::MarkScan;
pub use occupancy::{OccupancyBuilder, RayCount};
pub use octagon::{Octagon, OctagonSearch, Station, Stations};
pub use seen::SeenMap;
pub use signs::{MAX_SIGNS, MapLookup, Sign, SignMap, Signs};
pub use surroundings::MarkSurroundings;
pub use unknown::{CloseUnknown, UnknownRegions};
pub use vector::{LineSegment, MAX_SEGMENTS, MapError, VectorMap};
#[cfg(feature = "localize")]
pub(crate) use vector::{cross, nearest_hit};
