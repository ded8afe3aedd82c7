//! Runs of the robot and what became of them, and the accuracy of its perception.

mod perception;
mod picture;
mod run;
mod table;

pub use perception::{Accuracy, accuracy};
pub use picture::picture;
pub use run::{Run, run};
pub use table::{HEAD, Row, summary};
