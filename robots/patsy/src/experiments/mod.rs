//! Measurements of the vehicle and of its parts in simulation, and of its perception on recordings.

pub mod accuracy;
pub mod approach;
pub mod chart;
mod evaluate;
pub mod missions;
pub mod obstacles;
mod progress;
mod referee;
mod report;
pub mod times;
pub mod validate;

pub use evaluate::{Evaluate, Score, Statistics};
pub use progress::Progress;
pub use referee::{Ends, Referee};
pub use report::{RECORDED_SCANNER, Report};
