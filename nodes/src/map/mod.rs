//! Grid maps of the plane (feature `std`).

mod grid;

pub use grid::{Cell, Grid, MAX_CELLS, Occupancy, Raster, TooManyCells};
