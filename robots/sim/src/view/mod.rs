//! Live picture of a drawn world with a moving robot.

mod live;
mod picture;
mod svg;
mod terminal;

pub use live::{LiveView, ViewError};
