//! Short runs of the robot: it follows, and the same seed gives the same run.

use apex_rt::Time;
use apex_sim::in_order;
use follow::{
    experiments::{picture, run},
    world::{Ending, Fault, FaultKind, Options},
};
use std::{env, fs};

#[test]
fn the_robot_follows_the_runner_round_a_short_track() {
    let options = Options { seed: 5, length: 150.0, people: false, fault: None };
    let first = run(&options, None).expect("it runs");
    assert_eq!(first.report.ending, Some(Ending::Arrived), "{:?}", first.report.losses);
    assert!(first.report.contacts.is_empty() && first.failures.is_empty(), "{:?}", first.failures);
    assert!(first.report.driven > 120.0 && first.report.distance(0.5) < 8.0);
    assert!(first.report.longest_loss() <= 5.0);
    let svg = picture(&first);
    let circles = svg.matches("<circle").count();
    assert!(svg.starts_with("<svg") && circles > 20, "{circles}");
}

/// Nothing that the robot does depends on where it is in the world.
#[test]
fn faults_of_the_pose_in_the_world_do_not_stop_the_robot() {
    let options = Options { seed: 5, length: 35.0, people: false, fault: None };
    let (from, until) = (Time::from_millis(0), Time::from_millis(3_600_000));
    let faults = FaultKind::ALL.map(|kind| Some(Fault { kind, from, until }));
    let options: Vec<Options> = [None].into_iter().chain(faults).map(|fault| Options { fault, ..options }).collect();
    let runs = in_order(&options, None, |options| run(options, None).expect("it runs"), |_| ()).expect("threads");
    for run in &runs {
        let fault = run.options.fault;
        assert_eq!(run.report.ending, Some(Ending::Arrived), "{fault:?}");
        assert!(run.failures.is_empty() && run.report.trajectory == runs[0].report.trajectory, "{fault:?}");
        let is_located = run.report.located().is_some_and(|[position, heading]| position < 30.0 && heading < 0.5);
        let is_blind = fault.is_some_and(|fault| matches!(fault.kind, FaultKind::GnssSilent | FaultKind::WheelsSilent));
        assert_eq!(is_located, !is_blind, "{fault:?}: {:?}", run.report.located());
    }
}

#[test]
fn the_same_seed_gives_the_same_run() {
    let options = Options { seed: 6, length: 120.0, people: true, fault: None };
    let reports =
        in_order(&[options; 2], None, |options| run(options, None).expect("it runs").report, |_| ()).expect("threads");
    assert_eq!(reports[0], reports[1]);
    assert!(reports[0].trajectory.len() > 80 && reports[0].driven > 90.0, "{} m", reports[0].driven);
}

/// The turns of the scanner are clouds that viewers of recordings draw.
#[test]
fn a_run_is_recorded() {
    let file = env::temp_dir().join(format!("apex-follow-{}.mcap", std::process::id()));
    let options = Options { seed: 5, length: 5.0, people: false, fault: None };
    let recorded = run(&options, Some(&file)).expect("it runs");
    assert_eq!(run(&options, None).expect("it runs").report, recorded.report);
    let bytes = fs::read(&file).expect("it is there");
    let cloud = b"sensor_msgs/msg/PointCloud2";
    assert!(bytes.ends_with(b"MCAP0\r\n") && bytes.windows(cloud.len()).any(|name| name == cloud));
    fs::remove_file(file).expect("it is still there");
}
