use crate::{
    robot::{Summit, SummitParts},
    world::{Camera, Field, Gnss, Imu, Judge, Motors, Odometry, Options, Report, Scanner, State, Wheels},
};
use apex_rt::Time;
use apex_sim::{
    experiment::{self, Failure, Recording, Spell},
    outdoor::{Terrain, Track},
};
use std::{
    path::Path,
    time::{Duration, Instant},
};

/// Period of the reactions of a robot that could always react.
const STEP: Duration = Duration::from_millis(10);
/// Slowest mean speed of a runner, which bounds the time of a run, in m/s.
const SLOWEST: f32 = 1.0;

/// Finished run.
#[derive(Debug, Clone)]
pub struct Run {
    /// Options of the world.
    pub options: Options,
    /// Events, by the true state.
    pub report: Report,
    /// Failures of nodes and claims that did not hold, each once.
    pub failures: Vec<Failure>,
    /// Nodes that were active, and for how long.
    pub activity: Vec<(&'static str, Duration)>,
    /// Times in which nodes were active without a break.
    pub spells: Vec<Spell>,
    /// Simulated time.
    pub lasted: Duration,
    /// Computing time.
    pub took: Duration,
    /// Country and track.
    pub terrain: Terrain,
    /// Track.
    pub track: Track,
}

/// Runs the robot until the runner has arrived, or the robot can follow no longer. Records the run to a file, if there
/// is one.
///
/// # Errors
/// If it is stopped by a signal, or cannot be recorded.
pub fn run(options: &Options, record: Option<&Path>) -> Result<Run, String> {
    let began = Instant::now();
    let field = Field::new(State::new(options));
    let mut robot = Box::new(Summit::new(SummitParts {
        scanner: Scanner::new(&field),
        odometry: Odometry::new(&field),
        wheels: Wheels::new(&field),
        imu: Imu::new(&field),
        gnss: Gnss::new(&field),
        camera: Camera::new(&field),
        motors: Motors::new(&field),
        judge: Judge::new(&field),
    }));
    let end = Time::ZERO + Duration::from_secs_f32(30.0 + options.length / SLOWEST);
    let mut recording = Recording::begin::<Summit>(record, |_| false)?;
    let goes_on = |_, _: &mut _| field.present().report().ending.is_none();
    let log = experiment::run(&mut *robot, end, STEP, &mut recording, goes_on);
    recording.finish()?;
    let log = log?;
    let mut state = field.present();
    state.end();
    let State { terrain, track, .. } = &*state;
    Ok(Run {
        options: *options,
        report: state.report().clone(),
        activity: log.activity(log.now),
        failures: log.failures,
        spells: log.spells,
        lasted: log.now.since(Time::ZERO),
        took: began.elapsed(),
        terrain: terrain.clone(),
        track: track.clone(),
    })
}

impl Run {
    /// Time for which a node, or any node of a nested graph, was active, by the beginning of its name.
    pub fn time_of(&self, name: &str) -> Duration {
        self.activity.iter().filter(|(node, _)| node.starts_with(name)).map(|(_, time)| *time).sum()
    }

    /// Events and activity, with the times in s.
    pub fn timeline(&self) -> String {
        let report = &self.report;
        let mut events = vec![];
        for loss in &report.losses {
            events.push((loss.from, format!("the runner is lost for {:.2} s", loss.lasted)));
        }
        events.extend(report.beliefs.iter().map(|(at, belief)| (*at, belief.what().to_owned())));
        for contact in &report.contacts {
            let what = contact.what();
            events.push((contact.at, format!("{what} is touched with {:.2} m/s", contact.speed)));
        }
        experiment::timeline(&self.spells, &report.trajectory, &events)
    }

    /// Share of the time of following in which the robot followed slowly.
    pub fn share_slow(&self) -> f32 {
        let [fast, slow] = ["pursue.fast.", "pursue.slow."].map(|name| self.time_of(name).as_secs_f32());
        slow / (fast + slow).max(1e-3)
    }
}
