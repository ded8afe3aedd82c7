//! Short runs of the robot: it follows, and the same seed gives the same run.

use follow::{
    field::{Ending, Options},
    runs::{picture, run},
};

#[test]
fn the_robot_follows_the_runner_round_a_short_track() {
    let options = Options { seed: 2, length: 300.0, people: false };
    let first = run(&options).expect("it runs");
    assert_eq!(first.report.ending, Some(Ending::Arrived), "{:?}", first.report.losses);
    assert!(first.report.contacts.is_empty() && first.failures.is_empty(), "{:?}", first.failures);
    assert!(first.report.driven > 250.0 && first.report.distance(0.5) < 8.0);
    assert!(first.report.longest_loss() <= 5.0);
    let svg = picture(&first);
    assert!(svg.starts_with("<svg") && svg.matches("<circle").count() > 50);
}

#[test]
fn the_same_seed_gives_the_same_run() {
    let options = Options { seed: 5, length: 300.0, people: true };
    let trajectories = [run(&options), run(&options)].map(|run| run.expect("it runs").report.trajectory);
    assert_eq!(trajectories[0], trajectories[1]);
    assert!(!trajectories[0].is_empty());
}
