//! Sensors of the vehicle that fail while its motors keep the last twist: no motion is longer than promised. `patsy
//! missions --outages` has many of these runs.

use apex_sim::OutageTable;
use patsy::{experiments::missions::run_with_outages, world::clinic::Options};
use std::time::Duration;

#[test]
fn no_motion_is_longer_than_promised() {
    let watches = [2].map(|seed| {
        let options = Options { seed, people: 2, ..Options::default() };
        run_with_outages(&options, Duration::from_secs(20)).expect("the plan can be read")
    });
    assert!(watches.iter().all(|watch| watch.broken().is_empty()), "{}", OutageTable(&watches));
}
