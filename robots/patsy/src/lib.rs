//! PATSY, a robot that fetches hospital containers: the detection of containers by their wheels (thesis 6.6.1), and a
//! simulation to evaluate it as in the thesis (6.10.2, experiment 1).
//!
//! The scanner is at the origin and faces along x; a cart moves in front of it.

pub mod accuracy;
pub mod approach;
mod beneath;
mod cart;
pub mod chart;
pub mod clinic;
mod drive;
mod evaluate;
mod file;
mod finder;
mod mission_control;
pub mod missions;
mod motion;
pub mod obstacles;
mod placed;
mod progress;
mod referee;
mod report;
mod room;
mod sim_laser;
pub mod times;
mod tractor;
pub mod validate;

/// A container two metres ahead, for tests.
pub const CONTAINER_AHEAD: apex_nodes::scan::Container = apex_nodes::scan::Container {
    pose: apex_nodes::scan::Pose2 { x: 2.0, y: 0.0, theta: 0.0 },
    error: 0.0,
    inliers: 8,
    outliers: 0,
    wheels: 4,
    model: 0,
};

/// A container just before the vehicle, for tests.
pub const CONTAINER_BEFORE: apex_nodes::scan::Container =
    apex_nodes::scan::Container { pose: apex_nodes::scan::Pose2 { x: 0.9, y: 0.0, theta: 0.0 }, ..CONTAINER_AHEAD };

pub use beneath::Beneath;
pub use cart::{Cart, LENGTH, TRAIL, WHEEL_BOXES, WHEEL_LENGTH, WHEEL_WIDTH, WIDTH};
pub use drive::Drive;
pub use evaluate::{Evaluate, Score, Statistics};
pub use file::write_file;
pub use finder::{Finder, Search};
pub use mission_control::{MissionControl, ahead};
pub use motion::Scenario;
pub use placed::Placed;
pub use progress::Progress;
pub use referee::{Ends, Referee};
pub use report::{RECORDED_SCANNER, Report};
pub use sim_laser::{SimLaser, Truth};
use tractor::tractor;

/// Compiled robots of `patsy.afg`.
pub mod programs {
    apex_macros::graph!("patsy.afg");
}

/// The vehicle in the clinic: `clinic.afg`.
pub mod vehicle {
    apex_macros::graph!("clinic.afg");
}

/// The collection of a container, with the tests of `collect.afg`.
#[cfg(test)]
mod collect {
    apex_macros::graph!("collect.afg");
}

/// The delivery of a container, with the tests of `bring.afg`.
#[cfg(test)]
mod bring {
    apex_macros::graph!("bring.afg");
}

/// The mission on its own, with the tests of `mission.afg`.
#[cfg(test)]
mod mission {
    apex_macros::graph!("mission.afg");
}
