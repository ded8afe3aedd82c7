//! Short runs of the robot: it follows, and the same seed gives the same run.

use apex_sim::in_order;
use follow::{
    experiments::{picture, run},
    world::{Ending, Options},
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
