//! A run of the robot in the competition: its setup and its outcome.

mod activity_log;
mod part;
mod robot;

pub use activity_log::Failure;
pub use part::Parts;
pub use robot::Robot;

use crate::{
    contest::{Fault, Hall, START},
    programs::{Competition, SdfCompetition},
    run_report::RunReport,
};
use activity_log::ActivityLog;
use apex_rt::{
    Clock as _, Info, Next, Observer, Program, SimClock, Time, UntilStopped,
    record::{Channel, Finished, Recorder, Role, Tap, WhenFull},
    studio::{Stream, Studio},
};
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
    activity_log: &'a ActivityLog,
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
        let mut tap = Tapped(self.record.as_ref().map(Recording::begin::<R>).transpose()?);
        let mut activity_log = ActivityLog::new(const { &R::INFO });
        let mut clock = UntilStopped::ctrl_c(SimClock::until(self.end()).with_step(STEP))?;
        loop {
            let now = clock.now();
            activity_log.now = now;
            stream.before_reaction(now, &mut *robot);
            let watched = Watched(&mut *watch);
            let next = robot.react_with(now, &mut (&mut activity_log, (watched, (&mut stream, &mut tap))));
            watch.reacted(&StepView { now, hall: &hall, activity_log: &activity_log });
            let time = if let Next::At(time) = next { time } else { now };
            if !clock.wait_until(time) {
                break;
            }
        }
        robot.stop();
        let recorded = tap.finish()?;
        if clock.is_stopped() {
            return Err(format!("stopped by a signal after {} of the run", clock.now()));
        }
        hall.advance(self.end());
        let (phases, failures) = activity_log.finish(self.end());
        let run_report = RunReport::of(self.seed, &hall, start, robot.knowledge_log(), phases);
        Ok(Outcome { run_report, failures, recorded })
    }
}

impl Recording {
    fn begin<R: Robot>(&self) -> Result<Tap, String> {
        let left_out = |channel: &Channel| {
            let node = R::INFO.nodes[channel.node].name;
            // Only drivers bring in new data: constants and latches in the graphs send the same again in a replay.
            let is_new = !node.contains('.') && (self.images || !R::CAMERAS.contains(&node));
            channel.role == Role::Source && !is_new
        };
        let recorder = Recorder::to_file_without::<R>(&self.path, WhenFull::Wait, left_out);
        recorder.map(Tap::Record).map_err(|e| format!("cannot record to {}: {e}", self.path.display()))
    }
}

/// Observer with an optional recording.
struct Tapped(Option<Tap>);

impl Observer for Tapped {
    fn tap(&mut self) -> Option<&mut Tap> {
        self.0.as_mut()
    }
}

impl Tapped {
    fn finish(self) -> Result<Option<Finished>, String> {
        let Some(Tap::Record(recorder)) = self.0 else { return Ok(None) };
        let path = recorder.path().to_owned();
        recorder.finish().map(Some).map_err(|e| format!("cannot record to {}: {e}", path.display()))
    }
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
        self.activity_log.active()
    }
}
