//! A run of the robot in the competition: its setup and its outcome.

mod part;
mod phase_log;
mod robot;

pub use part::Parts;
pub use robot::Robot;

use super::run_report::RunReport;
use crate::{
    programs::{Competition, SdfCompetition},
    world::contest::{Fault, Hall, START},
};
use apex_rt::{
    Info, Observer, Program, Time,
    record::{Channel, Finished, Role},
    studio::{Stream, Studio},
};
use apex_sim::experiment::{self, Failure};
use phase_log::PhaseLog;
use std::{io, path::PathBuf, time::Duration};

/// Period of the reactions of a robot that could always react, because of constants in its graphs. It is the step of
/// the simulation.
const STEP: Duration = Duration::from_millis(10);

/// Kind of the robot's mission.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Mission {
    /// Activity flow graph: `mission.afg`.
    #[default]
    Graph,
    /// State machine: `sdf_mission.afg`.
    Machine,
}

/// Setup of a run.
#[derive(Debug, Clone, Default)]
pub struct Setup {
    /// Seed of the hall.
    pub seed: u64,
    /// Mission of the robot.
    pub mission: Mission,
    /// Faults of the robot.
    pub faults: Vec<Fault>,
    /// `true` if the motors have no command time-out, so that they keep the last twist.
    pub keeps_twist: bool,
    /// Duration from the start on.
    pub duration: Duration,
    /// Optional recording of the run.
    pub record: Option<Recording>,
}

/// Options of a recording.
#[derive(Debug, Clone)]
pub struct Recording {
    /// Path of the file. If the file exists, a number is added.
    pub path: PathBuf,
    /// `true` if camera images are recorded, with 4 MB per second. A replay in the hall of the same seed does not need
    /// them.
    pub images: bool,
}

/// Outcome of a run.
#[derive(Debug)]
pub struct Outcome {
    /// Report of the actions and the knowledge of the robot.
    pub run_report: RunReport,
    /// Failures in the robot.
    pub failures: Vec<Failure>,
    /// Finished recording.
    pub recorded: Option<Finished>,
}

/// State of a run between two reactions.
#[derive(Debug)]
pub struct StepView<'a> {
    /// Time of the run.
    pub now: Time,
    /// Hall of the run.
    pub hall: &'a Hall,
    phase_log: &'a PhaseLog,
}

/// Observer of a run. Unlike an [`Observer`], it is not compiled together with the robot: there is one program for all
/// kinds of observers.
pub trait Watch {
    /// Called before node `node` fires.
    fn fired(&mut self, node: usize) {
        let _ = node;
    }

    /// Called before the slot at the end of connection `connection` takes its token.
    fn handled(&mut self, connection: usize) {
        let _ = connection;
    }

    /// Called after a firing of node `node`, or after a call of its slot.
    fn finished(&mut self, node: usize) {
        let _ = node;
    }

    /// Called after each reaction of the robot.
    fn reacted(&mut self, moment: &StepView<'_>) {
        let _ = moment;
    }
}

impl Watch for () {}

/// A watch as an observer of the robot.
struct Watched<'a>(&'a mut dyn Watch);

impl Observer for Watched<'_> {
    fn fired(&mut self, node: usize) {
        self.0.fired(node);
    }

    fn handled(&mut self, connection: usize) {
        self.0.handled(connection);
    }

    fn finished(&mut self, node: usize) {
        self.0.finished(node);
    }
}

impl Mission {
    /// Structure of the compiled robot.
    pub const fn info(self) -> &'static Info {
        match self {
            Self::Graph => const { &<Competition as Program>::INFO },
            Self::Machine => const { &<SdfCompetition as Program>::INFO },
        }
    }

    /// Opens a socket for viewers if the environment asks for it (`apex studio`).
    ///
    /// # Errors
    /// The socket cannot be opened.
    pub fn studio(self) -> io::Result<Option<Studio>> {
        match self {
            Self::Graph => Studio::of_environment::<Competition>(true),
            Self::Machine => Studio::of_environment::<SdfCompetition>(true),
        }
    }
}

impl Setup {
    /// Time at which the run ends.
    pub fn end(&self) -> Time {
        START + self.duration
    }

    /// Runs the robot. Viewers of `studio` see it, and may set its parameters.
    ///
    /// # Errors
    /// If the run cannot be recorded.
    pub fn run(&self, watch: &mut dyn Watch, studio: Option<&Studio>) -> Result<Outcome, String> {
        let stream = studio.and_then(|studio| studio.stream(0));
        match self.mission {
            Mission::Graph => self.drive::<Competition>(watch, stream),
            Mission::Machine => self.drive::<SdfCompetition>(watch, stream),
        }
    }

    fn drive<R: Robot>(&self, watch: &mut dyn Watch, mut stream: Option<Stream>) -> Result<Outcome, String> {
        let hall = Hall::new(self.seed, self.faults.clone()).map_err(|e| e.to_string())?;
        if self.keeps_twist {
            hall.set_command_timeout(None);
        }
        let start = hall.robots()[0].pose;
        let mut robot = Box::new(R::in_hall(&hall));
        let (path, images) = self.record.as_ref().map(|record| (record.path.as_path(), record.images)).unzip();
        let images = images.unwrap_or_default();
        let mut recording = experiment::Recording::begin::<R>(path, |channel| is_left_out::<R>(channel, images))?;
        let phase_log = PhaseLog::new(const { &R::INFO });
        let mut observers = (phase_log, (Watched(watch), (&mut stream, &mut recording)));
        let log = experiment::run(&mut *robot, self.end(), STEP, &mut observers, |now, (phase_log, (watched, _))| {
            watched.0.reacted(&StepView { now, hall: &hall, phase_log });
            true
        });
        let (phase_log, _) = observers;
        let recorded = recording.finish()?;
        let failures = log?.failures;
        hall.advance(self.end());
        let phases = phase_log.finish(self.end());
        let run_report = RunReport::of(self.seed, &hall, start, robot.knowledge_log(), phases);
        Ok(Outcome { run_report, failures, recorded })
    }
}

/// Returns `true` for a channel that is not recorded: only drivers bring in new data, as constants and latches in the
/// graphs send the same again in a replay.
fn is_left_out<R: Robot>(channel: &Channel, images: bool) -> bool {
    let node = R::INFO.nodes[channel.node].name;
    let is_new = !node.contains('.') && (images || !R::CAMERAS.contains(&node));
    channel.role == Role::Source && !is_new
}

impl Outcome {
    /// Returns `true` if the run has no failures in the robot, no collisions that it caused, and no cubes delivered to
    /// a wrong station.
    pub fn is_fine(&self) -> bool {
        let report = &self.run_report.report;
        self.failures.is_empty() && report.caused() == 0 && report.penalties() == 0
    }
}

impl StepView<'_> {
    /// Active parts of the mission.
    pub fn active(&self) -> Vec<String> {
        self.phase_log.active()
    }
}
