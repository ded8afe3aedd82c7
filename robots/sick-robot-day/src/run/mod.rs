//! A run of the robot in the competition: which robot, in which hall, how long, and what comes of it.

mod diary;
mod part;
mod robot;

pub use diary::Failure;
pub use part::Parts;
pub use robot::Robot;

use crate::{
    contest::{Fault, Hall, START},
    programs::{Competition, SdfCompetition},
    story::Story,
};
use apex_rt::{
    Clock as _, Info, Next, Observer, Program, SimClock, Time,
    record::{Channel, Finished, Recorder, Role, Tap, WhenFull},
};
use diary::Diary;
use std::{path::PathBuf, time::Duration};

/// How often the robot reacts where it could always do so, because of constants in its graphs: as often as the hall moves.
const STEP: Duration = Duration::from_millis(10);

/// How a robot knows what it does next.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Mission {
    /// By an activity flow graph: `mission.afg`.
    #[default]
    Graph,
    /// By a state machine: `sdf_mission.afg`.
    Machine,
}

/// What is run.
#[derive(Debug, Clone, Default)]
pub struct Setup {
    /// Which hall.
    pub seed: u64,
    /// Which robot.
    pub mission: Mission,
    /// What breaks.
    pub faults: Vec<Fault>,
    /// How long, from the start on.
    pub duration: Duration,
    /// Where it is recorded.
    pub record: Option<Recording>,
}

/// A recording that is wanted.
#[derive(Debug, Clone)]
pub struct Recording {
    /// The file; if it is there already, one with a number.
    pub path: PathBuf,
    /// With what the cameras see: 4 MB a second. A replay in the hall of the same seed needs no images.
    pub images: bool,
}

/// What came of a run.
#[derive(Debug)]
pub struct Outcome {
    /// What the robot did and knew.
    pub story: Story,
    /// What went wrong in the robot.
    pub failures: Vec<Failure>,
    /// What was recorded.
    pub recorded: Option<Finished>,
}

/// What can be seen between two reactions.
#[derive(Debug)]
pub struct Moment<'a> {
    /// The time of the run.
    pub now: Time,
    /// Where it takes place.
    pub hall: &'a Hall,
    diary: &'a Diary,
}

/// Watches a run.
pub trait Watch: Observer {
    /// The robot has reacted.
    fn reacted(&mut self, moment: &Moment<'_>) {
        let _ = moment;
    }
}

impl Watch for () {}

impl Mission {
    /// What the robot is made of.
    pub const fn info(self) -> &'static Info {
        match self {
            Self::Graph => const { &<Competition as Program>::INFO },
            Self::Machine => const { &<SdfCompetition as Program>::INFO },
        }
    }
}

impl Setup {
    /// When the run ends.
    pub fn end(&self) -> Time {
        START + self.duration
    }

    /// Runs the robot.
    ///
    /// # Errors
    /// It cannot be recorded.
    pub fn run(&self, watch: &mut impl Watch) -> Result<Outcome, String> {
        match self.mission {
            Mission::Graph => self.drive::<Competition>(watch),
            Mission::Machine => self.drive::<SdfCompetition>(watch),
        }
    }

    fn drive<R: Robot>(&self, watch: &mut impl Watch) -> Result<Outcome, String> {
        let hall = Hall::new(self.seed, self.faults.clone()).map_err(|e| e.to_string())?;
        let start = hall.robots()[0].pose;
        let mut robot = Box::new(R::in_hall(&hall));
        let mut tap = Tapped(self.record.as_ref().map(Recording::begin::<R>).transpose()?);
        let mut diary = Diary::new(const { &R::INFO });
        let mut clock = SimClock::until(self.end()).with_step(STEP);
        loop {
            let now = clock.now();
            diary.now = now;
            let next = robot.react_with(now, &mut (&mut diary, (&mut *watch, &mut tap)));
            watch.reacted(&Moment { now, hall: &hall, diary: &diary });
            let time = if let Next::At(time) = next { time } else { now };
            if !clock.wait_until(time) {
                break;
            }
        }
        hall.advance(self.end());
        let recorded = tap.finish()?;
        let (phases, failures) = diary.finish(self.end());
        let story = Story::of(self.seed, &hall, start, robot.journal(), phases);
        Ok(Outcome { story, failures, recorded })
    }
}

impl Recording {
    fn begin<R: Robot>(&self) -> Result<Tap, String> {
        let left_out = |channel: &Channel| {
            let node = R::INFO.nodes[channel.node].name;
            // Only drivers bring in something new: constants and latches in the graphs send the same again.
            let is_new = !node.contains('.') && (self.images || !R::CAMERAS.contains(&node));
            channel.role == Role::Source && !is_new
        };
        let recorder = Recorder::to_file_without::<R>(&self.path, WhenFull::Wait, left_out);
        recorder.map(Tap::Record).map_err(|e| format!("cannot record to {}: {e}", self.path.display()))
    }
}

/// Records, or does not.
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
    /// Whether nothing went wrong: in the robot, with a collision that it caused, or with a cube that it took to another
    /// station.
    pub fn is_fine(&self) -> bool {
        let report = &self.story.report;
        self.failures.is_empty() && report.caused() == 0 && report.penalties() == 0
    }
}

impl Moment<'_> {
    /// What the robot is busy with.
    pub fn active(&self) -> Vec<String> {
        self.diary.active()
    }
}
