//! Runs of the robot, and what became of them.

mod activity;
mod bench;
mod picture;
mod run;
mod table;

pub use bench::{Accuracy, accuracy};
pub use picture::picture;
pub use run::{Run, run};
pub use table::{HEAD, Row, summary};
