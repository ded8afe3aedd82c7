//! Short runs of the robot: it explores, finds objects, charges, and the same seed gives the same run.

use apex_sim::{OutageTable, in_order};
use explorer::{
    experiments::{Run, picture, run, run_with_outages},
    world::Options,
};
use std::time::Duration;

fn runs(options: &Options, minutes: u64, count: usize) -> Vec<Run> {
    let longest = Duration::from_secs(60 * minutes);
    let run = |options: &Options| run(options, longest, None).expect("it runs");
    in_order(&vec![options.clone(); count], None, run, |_| ()).expect("threads")
}

#[test]
fn the_robot_explores_a_field_and_comes_home() {
    let run = runs(&Options { seed: 4, ..Options::default() }, 20, 1).remove(0);
    assert!(run.report.finished.is_some_and(|(_, distance)| distance < 0.4), "{:?}", run.report.finished);
    assert!(run.explored > 0.95 && run.report.contacts.is_empty() && run.failures.is_empty(), "{:?}", run.failures);
    assert!(!run.report.charges.is_empty() && run.report.least_charge > 0.0);
    assert_eq!((run.finds.found, run.finds.objects, run.finds.wrong()), (4, 4, 0), "{:?}", run.finds);
    assert!(run.finds.greatest_error().is_some_and(|error| error < 0.2), "{:?}", run.finds);
    let svg = picture(&run);
    assert!(svg.starts_with("<svg") && svg.matches("<circle").count() > 20);
}

#[test]
fn the_same_seed_gives_the_same_run() {
    let runs = runs(&Options { seed: 5, ..Options::default() }, 2, 2);
    assert_eq!((&runs[0].report, &runs[0].finds), (&runs[1].report, &runs[1].finds));
    assert!(runs[0].report.driven > 20.0 && runs[0].map == runs[1].map);
}

#[test]
fn the_robot_stands_when_it_cannot_know() {
    let seeds = [11, 12].map(|seed| Options { seed, ..Options::default() });
    let run = |options: &Options| run_with_outages(options, Duration::from_secs(150)).expect("it runs");
    for (run, watch) in in_order(&seeds, None, run, |_| ()).expect("threads") {
        assert!(run.report.contacts.is_empty() && run.failures.is_empty(), "{:?} {:?}", run.report, run.failures);
        assert!(watch.broken().is_empty(), "{}", OutageTable(&[watch]));
        assert!(run.report.driven > 5.0);
    }
}
