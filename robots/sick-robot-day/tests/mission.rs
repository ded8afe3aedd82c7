//! The whole robot in the competition: it works, it is reproducible, and it survives faults.

use apex_rt::{Program, Time, record::replay};
use sick_robot_day::{
    experiments::run::{Mission, Outcome, Recording, Robot as _, Setup},
    programs::Competition,
    world::contest::{Fault, FaultKind, Hall, START},
};
use std::{fs, time::Duration};

/// Seed with which the first cube is delivered soon, and the time for this, with some reserve.
const SEED: u64 = 1;
const SOON: Duration = Duration::from_secs(60);

/// A run whose motors have a command time-out unless something is broken: then the nodes have to stop the robot.
fn run(mission: Mission, faults: Vec<Fault>, duration: Duration) -> Outcome {
    let keeps_twist = !faults.is_empty();
    let setup = Setup { seed: SEED, mission, faults, keeps_twist, duration, record: None };
    setup.run(&mut (), None).expect("nothing is recorded")
}

fn delivers(mission: Mission) {
    let Outcome { run_report, failures, .. } = run(mission, vec![], SOON);
    let report = &run_report.report;
    assert!(failures.is_empty(), "{failures:?}");
    assert!(!report.fetches.is_empty() && report.points() > 0, "{report:?}");
    assert_eq!((report.penalties(), report.caused()), (0, 0));
    assert!(run_report.map.is_some() && run_report.octagon.is_some() && !run_report.frames.is_empty());
    assert!(run_report.phases.windows(2).all(|pair| pair[0].until <= pair[1].until));
    assert!(run_report.phases.first().is_some_and(|phase| phase.name == "wait" && phase.until >= START));
}

#[test]
fn the_graph_delivers() {
    delivers(Mission::Graph);
}

#[test]
fn the_state_machine_delivers() {
    delivers(Mission::Machine);
}

#[test]
fn the_same_seed_is_the_same_run_and_its_recording_replays() {
    let folder = std::env::temp_dir().join(format!("apex-sick-robot-day-{}", std::process::id()));
    fs::create_dir_all(&folder).expect("a folder for temporary files");
    let duration = Duration::from_secs(12);
    let record = Some(Recording { path: folder.join("run.mcap"), images: false });
    let setup = Setup { seed: SEED, duration, record, ..Setup::default() };
    let recorded = setup.run(&mut (), None).expect("room for the file");
    let again = run(Mission::Graph, vec![], duration);
    let finished = recorded.recorded.expect("a recording");
    let size = fs::metadata(&finished.path).expect("the file").len();
    let hall = Hall::new(SEED, vec![]).expect("a level camera");
    let report = replay(Competition::in_hall(&hall), &finished.path, ());
    fs::remove_dir_all(&folder).expect("it is ours");

    assert_eq!(recorded.run_report.report, again.run_report.report);
    assert_eq!(recorded.run_report.phases, again.run_report.phases);
    assert!(recorded.run_report.report.distance > 3.0, "it did not drive far");
    let report = report.expect("a recording");
    assert!(report.is_same(), "{report}");
    assert!(report.compared.iter().all(|c| c.equal > 0), "{report}");
    assert!(finished.dropped.is_empty() && size < 3_000_000, "{size} bytes");
}

/// Tests that the robot moves again after a fault of a device that it needs.
fn survives(kind: FaultKind, mission: Mission) {
    // The camera is needed before a station, everything else to get there.
    let (from, length) = match kind {
        FaultKind::CameraBlack | FaultKind::CameraTorn => (7, 6),
        FaultKind::LaserFrozen => (3, 3),
        _ => (3, 6),
    };
    let (from, until) = (Time::from_secs(from), Time::from_secs(from + length));
    let duration = until.since(START) + Duration::from_secs(8);
    let outcome = run(mission, vec![Fault { kind, from, until }], duration);
    assert!(outcome.failures.is_empty(), "{kind:?}: {:?}", outcome.failures);
    let report = outcome.run_report.report;
    let after: Vec<_> = report.trajectory.iter().filter(|(time, _)| *time >= until).collect();
    let way: f32 = after.windows(2).map(|pair| (pair[1].1.position() - pair[0].1.position()).norm()).sum();
    assert!(way > 0.2, "{kind:?}: after it the robot drove {way} m");
    assert_eq!(report.caused(), 0, "{kind:?}: {:?}", report.collisions);
}

macro_rules! survives {
    ($($name:ident: $kind:ident, $mission:ident;)+) => {
        $(#[test]
        fn $name() {
            survives(FaultKind::$kind, Mission::$mission);
        })+
    };
}

survives! {
    a_frozen_laser_is_survived: LaserFrozen, Graph;
    a_frozen_laser_is_survived_by_the_machine: LaserFrozen, Machine;
    black_images_are_survived: CameraBlack, Graph;
    torn_images_are_survived: CameraTorn, Machine;
    beams_of_nan_are_survived: BeamsNan, Graph;
    infinite_beams_are_survived: BeamsInfinite, Machine;
    beams_of_zero_are_survived: BeamsZero, Graph;
    missing_beams_are_survived: BeamsMissing, Machine;
    stopped_odometry_is_survived: OdometryStopped, Graph;
}

#[test]
fn both_robots_have_what_can_be_recorded_and_left_out() {
    let names = |info: &apex_rt::Info| info.nodes.iter().map(|node| node.name).collect::<Vec<_>>();
    for mission in [Mission::Graph, Mission::Machine] {
        let names = names(mission.info());
        assert!(Competition::CAMERAS.iter().all(|camera| names.contains(camera)));
    }
    assert_eq!(<Competition as Program>::RECORD, Some("sick-robot-day.mcap"));
}
