//! PATSY, a robot that fetches hospital containers: the detection of containers by their wheels (thesis 6.6.1), and a
//! simulation to evaluate it as in the thesis (6.10.2, experiment 1).
//!
//! The modules here are the robot; [`world`] has what surrounds it in simulation, with its drivers there, and
//! [`experiments`] what is measured.
//!
//! The scanner is at the origin and faces along x; a cart moves in front of it.

mod beneath;
mod container;
mod detector;
mod drive;
mod ends;
pub mod experiments;
mod finder;
mod mission_control;
mod order;
mod placed;
pub mod world;

/// File with the plan of the building, below the folder in which the program runs: the simulated clinic writes it
/// there.
pub const PLAN: &str = "out/patsy/building.csv";

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

/// Scan in which nothing is near, for tests.
#[apex_rt::node]
pub fn clear_view() -> apex_nodes::scan::Scan {
    use apex_nodes::scan::Scan;
    Scan { angle_min: -1.5, angle_increment: 0.1, ranges: [20.0; 31].into_iter().collect(), ..Scan::default() }
}

/// Floor without obstacles, 10 m in all directions, for tests.
#[apex_rt::node]
pub fn free_floor() -> apex_nodes::map::Grid<apex_nodes::map::Occupancy> {
    use apex_nodes::{
        map::{Grid, Occupancy, Raster},
        scan::Point2,
    };
    let raster = Raster { corner: Point2::new(-10.0, -10.0), resolution: 0.05, width: 400, height: 400 };
    Grid::new(raster, Occupancy::Free).unwrap_or_default()
}

/// Token that never comes, for tests.
#[apex_rt::node]
pub fn absent<T>() -> Option<T> {
    None
}

pub use beneath::Beneath;
pub use container::{BODY, LENGTH, TOP, TRAIL, WHEEL_BOXES, WHEEL_LENGTH, WHEEL_WIDTH, WIDTH};
pub use detector::{Detector, Weights};
pub use drive::Drive;
pub use ends::Ends;
pub use finder::{Finder, Search};
pub use mission_control::{MissionControl, ahead};
pub use order::Order;
pub use placed::Placed;

/// Compiled robots of `patsy.afg`.
pub mod programs {
    apex_macros::graph!("patsy.afg");
}

/// The vehicle in the clinic: `clinic.afg`.
pub mod vehicle {
    apex_macros::graph!("clinic.afg");
}

/// Detection of obstacles in clouds: `obstacles.afg`.
pub mod obstacles {
    apex_macros::graph!("obstacles.afg");
}

/// The vehicle before things on the floor: `lookout.afg`.
mod lookout {
    apex_macros::graph!("lookout.afg");
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

/// Travel on its own, with the tests of `travel.afg`.
#[cfg(test)]
mod travel {
    apex_macros::graph!("travel.afg");
}

/// The mission on its own, with the tests of `mission.afg`.
#[cfg(test)]
mod mission {
    apex_macros::graph!("mission.afg");
}
