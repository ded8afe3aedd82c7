//! Sensors that fail in the competition, while the motors keep the last twist: no motion is longer than promised.
//! `bench --outages` has many of these runs.

use apex_sim::OutageTable;
use sick_robot_day::experiments::{bench::Outages, run::Setup};
use std::time::Duration;

/// The odometry stops in the runs with the seeds 12 and 64, once while the robot creeps.
#[test]
fn no_motion_is_longer_than_promised() {
    let setup = Setup { duration: Duration::from_secs(20), ..Setup::default() };
    let watches = [12, 64].map(|seed| Outages::run(&setup, seed).expect("nothing is recorded"));
    assert!(watches.iter().all(|watch| watch.broken().is_empty()), "{}", OutageTable(&watches));
}
