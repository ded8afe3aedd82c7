use super::{
    budget::Budget,
    losses::{Limits, Losses},
};
use crate::{
    vehicle::{Patsy, PatsyParts},
    world::clinic::{Clinic, Drivers, Options, Report, Snapshot, State},
};
use apex_nodes::map::VectorMap;
use apex_rt::{Program as _, Time};
use apex_sim::experiment::{self, Failure, Recording, Spell};
use std::{
    path::Path,
    time::{Duration, Instant},
};

/// Period of the reactions of a robot that could always react. It is the step of the simulation.
const STEP: Duration = Duration::from_millis(20);

/// Finished run.
#[derive(Debug, Clone)]
pub struct Run {
    /// Options of the simulation.
    pub options: Options,
    /// Events of the vehicle.
    pub report: Report,
    /// Failures of nodes and claims that did not hold, each once.
    pub failures: Vec<Failure>,
    /// Nodes that were active, and for how long, in the order of the program.
    pub activity: Vec<(&'static str, Duration)>,
    /// Activity of the nodes in the order in which it ended.
    pub timeline: Vec<Spell>,
    /// Time lost to each cause.
    pub losses: Losses,
    /// Time by what the vehicle does.
    pub budget: Budget,
    /// State at the beginning and at the end.
    pub ends: [Snapshot; 2],
    /// Walls of the building.
    pub plan: VectorMap,
    /// Computing time.
    pub took: Duration,
}

/// Runs the vehicle for some time, and records it to a file if there is one.
///
/// # Errors
/// If the plan of the building cannot be read, or the file cannot be written.
pub fn run(options: &Options, duration: Duration, record: Option<&Path>) -> Result<Run, String> {
    run_seen(options, duration, record, |_, _| ())
}

/// As [`run`]; `see` sees the clinic after each reaction.
pub(super) fn run_seen(
    options: &Options,
    duration: Duration,
    record: Option<&Path>,
    mut see: impl FnMut(Time, &State),
) -> Result<Run, String> {
    let began = Instant::now();
    let clinic = Clinic::new(State::new(options).map_err(|e| e.to_string())?);
    let first = clinic.present().snapshot();
    let mut robot = Box::new(vehicle(&clinic));
    let end = Time::ZERO + duration;
    let mut limits = Limits::new(&Patsy::channels());
    let mut recording = Recording::begin::<Patsy>(record, |_| false)?;
    let log = experiment::run(&mut *robot, end, STEP, &mut (&mut limits, &mut recording), |now, _| {
        see(now, &clinic.present());
        true
    });
    recording.finish()?;
    let log = log?;
    let clinic = clinic.at(end);
    let activity = log.activity(end);
    Ok(Run {
        options: options.clone(),
        report: clinic.report().clone(),
        losses: limits.losses(&activity),
        budget: limits.budget(&activity, &log.spells),
        activity,
        timeline: log.spells,
        failures: log.failures,
        ends: [first, clinic.snapshot()],
        plan: clinic.building().plan.clone(),
        took: began.elapsed(),
    })
}

/// The vehicle in a clinic.
fn vehicle(clinic: &Clinic) -> Patsy {
    let Drivers { scanner, rear, wheels, camera, motors, lift, dispatch } = Drivers::new(clinic);
    Patsy::new(PatsyParts { scanner, rear, wheels, camera, motors, lift, dispatch })
}
