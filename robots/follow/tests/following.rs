//! Short runs of the robot: it follows, and the same seed gives the same run.

use apex_sim::in_order;
use follow::{
    experiments::{picture, run},
    world::{Ending, Options},
};

#[test]
fn the_robot_follows_the_runner_round_a_short_track() {
    let options = Options { seed: 5, length: 150.0, people: false };
    let first = run(&options).expect("it runs");
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
    let options = Options { seed: 6, length: 120.0, people: true };
    let reports =
        in_order(&[options; 2], None, |options| run(options).expect("it runs").report, |_| ()).expect("threads");
    assert_eq!(reports[0], reports[1]);
    assert!(reports[0].trajectory.len() > 80 && reports[0].driven > 90.0, "{} m", reports[0].driven);
}
