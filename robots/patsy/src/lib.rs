//! PATSY fetches hospital containers. Here is the perception of containers by their wheels (thesis 6.6.1), and a
//! simulation to measure it as the thesis does (6.10.2, experiment 1).
//!
//! The scanner stands at the origin and looks along x; a cart moves before it.

mod cart;
mod evaluate;
mod motion;
mod progress;
mod report;
mod room;
mod sim_laser;

pub use cart::{Cart, LENGTH, WHEEL_BOXES, WHEEL_LENGTH, WHEEL_WIDTH, WIDTH};
pub use evaluate::{Evaluate, Score, Statistics};
pub use motion::Scenario;
pub use progress::Progress;
pub use report::{RECORDED_SCANNER, Report};
pub use sim_laser::{SimLaser, Truth};

/// The compiled robots of `patsy.afg`.
pub mod programs {
    apex_rt::graph!("patsy.afg");
}
