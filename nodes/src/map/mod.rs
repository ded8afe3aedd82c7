//! Grid maps of the plane (feature `std`).

mod grid;
mod occupancy;

pub use grid::{Cell, Grid, MAX_CELLS, Occupancy, Raster, TooManyCells};
pub use occupancy::{OccupancyBuilder, RayCount};
