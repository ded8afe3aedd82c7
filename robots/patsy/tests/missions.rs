//! The whole vehicle in the simulated clinic.

use apex_rt::Time;
use patsy::{
    experiments::missions::{Run, run},
    world::clinic::{Conditions, Fault, FaultKind, Options},
};
use std::time::Duration;

fn of(options: &Options, seconds: u64) -> Run {
    run(options, Duration::from_secs(seconds), None).expect("the plan can be written")
}

#[test]
fn the_vehicle_leaves_for_its_first_container_the_same_way_each_time() {
    let options = Options { people: 2, ..Options::default() };
    let runs = [of(&options, 15), of(&options, 15)];
    let report = &runs[0].report;
    assert_eq!(runs[0].losses.blind, 0.0, "it knows where its dock is");
    assert!(report.distance > 2.0, "{} m", report.distance);
    assert!(runs[0].failures.is_empty(), "{:?}", runs[0].failures);
    assert_eq!(report.contacts, []);
    assert_eq!(report, &runs[1].report);
}

#[test]
fn a_harder_world_is_the_same_each_time() {
    let options = Options { conditions: Conditions::HARDER, people: 2, ..Options::default() };
    let runs = [of(&options, 15), of(&options, 15)];
    assert_eq!(runs[0].report, runs[1].report);
    assert!(runs[0].report.distance > 2.0 && runs[0].failures.is_empty(), "{:?}", runs[0].failures);
}

/// The whole way of an order: approach, lift, bring, set down, and leave.
#[test]
fn the_vehicle_delivers_a_container() {
    let Run { report, failures, .. } = of(&Options { seed: 93004, people: 0, ..Options::default() }, 130);
    assert!(report.delivered() > 0, "{:?}", report.deliveries);
    assert_eq!((report.empty_lifts, report.wedges, failures), (vec![], vec![], vec![]));
}

const BLIND: [FaultKind; 4] =
    [FaultKind::CameraBlack, FaultKind::CameraFrozen, FaultKind::CameraNan, FaultKind::ScannerFrozen];

/// A run of 10 s with a fault from a time in s on. The motors keep the last twist: what stops them is the nodes.
fn broken(kind: FaultKind, from: i64, seconds: u64) -> Run {
    let fault = Fault { kind, from: Time::from_secs(from), until: Time::from_secs(60) };
    of(&Options { people: 0, faults: vec![fault], command_timeout: None, ..Options::default() }, seconds)
}

#[test]
fn a_vehicle_that_is_blind_stands_still() {
    for kind in BLIND {
        let blind = broken(kind, 0, 10);
        assert!(blind.report.distance < 0.3, "{kind:?}: {} m", blind.report.distance);
        assert!(blind.failures.is_empty(), "{kind:?}: {:?}", blind.failures);
    }
}

#[test]
fn a_vehicle_that_becomes_blind_stops() {
    for kind in BLIND {
        let [before, after] = [12, 22].map(|seconds| broken(kind, 10, seconds).report.distance);
        // Forward, but for a camera, the vehicle may back up over floor that it knows.
        assert!(before > 1.0 && after - before < 0.5, "{kind:?}: {before} m, then {after} m");
    }
}
