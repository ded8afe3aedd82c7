//! The simulated competition: the arena, the hopper with its cubes, and the contest with its rivals and its referee.

mod arena;
pub mod contest;
mod hopper;
mod sensors;
mod signs;

pub use arena::{Arena, ISLAND_SIDE, NUMBER_HEIGHT, Station, TARGET_HEIGHT, WALL_HEIGHT};
pub use hopper::{CUBE_SIDE, Cube, HOPPER_SIZE, Hopper};
pub use sensors::{Sensors, View, hall_light};
pub(crate) use signs::distance;
pub use signs::{NUMBER_WIDTH, TARGET_WIDTH};
