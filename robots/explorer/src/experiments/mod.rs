//! Runs of the robot and what became of them.

mod finds;
mod picture;
mod run;
mod table;

pub use finds::{Find, Finds, finds};
pub use picture::picture;
pub use run::{Run, run, run_with_outages};
pub use table::{HEAD, Row, summary};
