//! Grid maps of the plane and what is found in them, and maps of signs (feature `std`).

mod grid;
mod octagon;
mod signs;

pub use grid::{Cell, Grid, MAX_CELLS, Occupancy, Raster, TooManyCells};
pub use octagon::{Octagon, OctagonSearch, Station, Stations};
pub use signs::{MAX_SIGNS, MapLookup, Sign, SignMap, Signs};
