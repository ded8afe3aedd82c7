//! Runs of the robot and what became of them, and the accuracy of its perception and of its pose.

mod localisation;
mod perception;
mod picture;
mod run;
mod table;

pub use localisation::{Localisation, localisation};
pub use perception::{Accuracy, accuracy};
pub use picture::picture;
pub use run::{Run, run};
pub use table::{HEAD, Row, summary};
