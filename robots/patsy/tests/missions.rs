//! The whole vehicle in the simulated clinic.

use patsy::{
    clinic::{Fault, FaultKind, Options},
    missions::{Run, run},
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
    assert!(report.distance > 2.0, "{} m", report.distance);
    assert!(runs[0].failures.is_empty(), "{:?}", runs[0].failures);
    assert_eq!(report.contacts, []);
    assert_eq!(report, &runs[1].report);
}

#[test]
fn a_vehicle_that_is_blind_stands_still() {
    use apex_rt::Time;
    for kind in [FaultKind::CameraBlack, FaultKind::CameraFrozen, FaultKind::CameraNan, FaultKind::ScannerFrozen] {
        let fault = Fault { kind, from: Time::ZERO, until: Time::from_millis(60_000) };
        let blind = of(&Options { people: 0, faults: vec![fault], ..Options::default() }, 10);
        assert!(blind.report.distance < 0.3, "{kind:?}: {} m", blind.report.distance);
        assert!(blind.failures.is_empty(), "{kind:?}: {:?}", blind.failures);
    }
}
