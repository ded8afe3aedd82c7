//! Grid maps of the plane, and what is done to them before a path is planned (feature `std`).

mod distance;
mod grid;
mod mark;
mod morphology;

pub use distance::DistanceTransform;
pub use grid::{Cell, Grid, MAX_CELLS, Occupancy, Raster, TooManyCells};
pub use mark::MarkScan;
pub use morphology::{CloseUnknown, GrowObstacles, UnknownRegions, grow};
