use super::{Finds, finds};
use crate::{
    robot::{Explorer, ExplorerParts},
    world::{
        Charge, ColorEye, Fault, FaultKind, Field, Judge, Motors, Options, Planet, Report, Scanner, State, Wheels,
    },
};
use apex_nodes::{
    map::{Grid, Occupancy},
    nav::Twist,
};
use apex_rt::Time;
use apex_sim::{
    MotionWatch,
    experiment::{self, Failure, Recording},
    outages,
};
use std::{
    path::Path,
    time::{Duration, Instant},
};

/// Period of the reactions of a robot that could always react.
const STEP: Duration = Duration::from_millis(10);
/// Time before the first outage.
const BEGINS: Duration = Duration::from_secs(5);

/// Finished run.
#[derive(Debug, Clone)]
pub struct Run {
    /// Options of the world.
    pub options: Options,
    /// Events, by the true state.
    pub report: Report,
    /// Share of the ground that the map shows at the end.
    pub explored: f32,
    /// Objects that the robot knows, beside the true ones.
    pub finds: Finds,
    /// Failures of nodes and claims that did not hold, each once.
    pub failures: Vec<Failure>,
    /// Nodes that were active, and for how long.
    pub activity: Vec<(&'static str, Duration)>,
    /// Simulated time.
    pub lasted: Duration,
    /// Computing time.
    pub took: Duration,
    /// Field.
    pub field: Field,
    /// Map of the robot, in the frame of the station.
    pub map: Grid<Occupancy>,
}

/// Runs the robot until it has finished, at most for a time. Records the run to a file, if there is one.
///
/// # Errors
/// If it is stopped by a signal, or cannot be recorded.
pub fn run(options: &Options, longest: Duration, record: Option<&Path>) -> Result<Run, String> {
    run_watched(options, longest, record, |_, _| ())
}

/// Runs the robot with sensors that fail one after the other, as the seed draws it, and with motors that keep the last
/// twist. Tells how long it moves without each of them.
///
/// # Errors
/// If it is stopped by a signal.
pub fn run_with_outages(options: &Options, longest: Duration) -> Result<(Run, MotionWatch), String> {
    let outages = outages(options.seed, FaultKind::ALL.len(), [Time::ZERO + BEGINS, Time::ZERO + longest]);
    let faults = outages.iter().map(|outage| Fault::of(outage, &FaultKind::ALL)).collect();
    let mut watch = MotionWatch::new(&FaultKind::promises(), outages);
    let options = Options { faults, keeps_twist: true, ..options.clone() };
    let run = run_watched(&options, longest, None, |now, twist| watch.see(now, twist))?;
    Ok((run, watch))
}

fn run_watched(
    options: &Options,
    longest: Duration,
    record: Option<&Path>,
    mut watch: impl FnMut(Time, &Twist),
) -> Result<Run, String> {
    let began = Instant::now();
    let planet = Planet::new(State::new(options));
    let mut robot = Box::new(Explorer::new(ExplorerParts {
        scanner: Scanner::new(&planet),
        wheels: Wheels::new(&planet),
        charge: Charge::new(&planet),
        eye: ColorEye::new(&planet),
        motors: Motors::new(&planet),
        judge: Judge::new(&planet),
    }));
    let end = Time::ZERO + longest;
    let mut recording = Recording::begin::<Explorer>(record, |_| false)?;
    let log = experiment::run(&mut *robot, end, STEP, &mut recording, |now, _| {
        let state = planet.present();
        watch(now, &state.twist());
        state.report().finished.is_none()
    });
    recording.finish()?;
    let log = log?;
    let state = planet.present();
    Ok(Run {
        options: options.clone(),
        report: state.report().clone(),
        explored: state.explored(),
        finds: finds(&state.field, state.known()),
        activity: log.activity(log.now),
        failures: log.failures,
        lasted: log.now.since(Time::ZERO),
        took: began.elapsed(),
        field: state.field.clone(),
        map: state.map().clone(),
    })
}
