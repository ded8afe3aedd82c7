//! Grid maps of the plane, and maps of signs (feature `std`).

mod grid;
mod signs;

pub use grid::{Cell, Grid, MAX_CELLS, Occupancy, Raster, TooManyCells};
pub use signs::{MAX_SIGNS, MapLookup, Sign, SignMap, Signs};
