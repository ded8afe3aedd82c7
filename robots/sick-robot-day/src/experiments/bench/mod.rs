//! Measures the robot in many halls: its score, the cost of faults, and its computing time.

mod faults;
mod outages;
mod score;
mod times;

pub use faults::{Toll, fault_at};
pub use outages::Outages;
pub use score::{Score, Summary};
pub use times::Times;
