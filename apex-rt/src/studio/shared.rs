//! State that the thread groups of a program share with the thread that talks to viewers.

use super::message::{Command, Report, Test};
use core::time::Duration;
use std::{
    boxed::Box,
    sync::{
        Condvar, Mutex, MutexGuard, PoisonError,
        atomic::{AtomicBool, AtomicU64, Ordering::Relaxed},
    },
    time::Instant,
    vec::Vec,
};

/// Maximum number of viewers.
pub const MAX_VIEWERS: usize = 16;

/// State of a streamed run.
pub struct Shared {
    /// `true` while there is a viewer.
    pub watched: AtomicBool,
    /// `true` after the end of the program.
    pub over: AtomicBool,
    /// `true` for the nodes that are active.
    pub active: Box<[AtomicBool]>,
    pub channels: Box<[Wanted]>,
    /// `true` while calls are measured.
    pub measured: AtomicBool,
    /// `true` while every token is reported.
    pub followed: AtomicBool,
    /// Number of messages that did not fit into a ring.
    pub lost: AtomicU64,
    /// Reactions of each thread group.
    pub beats: Box<[Beat]>,
    /// `true` while a viewer wants checkpoints.
    pub keeps: AtomicBool,
    /// Pace of the program, if its time is simulated.
    pub pace: Option<Pace>,
    /// `true` while the thread that talks to viewers is to stop.
    pub stops: AtomicBool,
}

/// A channel that a viewer may ask for.
#[derive(Default)]
pub struct Wanted {
    pub is: AtomicBool,
    /// The newest token that has not been sent.
    pub latest: Mutex<Latest>,
}

/// A token as bytes.
#[derive(Default)]
pub struct Latest {
    pub is_new: bool,
    pub now: i64,
    pub bytes: Vec<u8>,
}

/// Reactions of a thread group.
#[derive(Default)]
pub struct Beat {
    /// Number of those that have begun.
    begun: AtomicU64,
    /// The same at the end of the last one; 0 if the group does not tell.
    ended: AtomicU64,
}

impl Beat {
    pub fn begin(&self) {
        self.begun.fetch_add(1, Relaxed);
    }

    pub fn end(&self) {
        self.ended.store(self.begun.load(Relaxed), Relaxed);
    }

    /// Number of reactions, and `true` within one.
    fn report(&self) -> (u64, bool) {
        // A reaction that begins or ends meanwhile has been in progress.
        let (ended, begun) = (self.ended.load(Relaxed), self.begun.load(Relaxed));
        (begun, ended > 0 && begun != ended)
    }
}

impl Shared {
    pub fn new(nodes: usize, channels: usize, groups: usize, pace: Option<Pace>) -> Self {
        Self {
            watched: AtomicBool::new(false),
            over: AtomicBool::new(false),
            active: (0..nodes).map(|_| AtomicBool::new(false)).collect(),
            channels: (0..channels).map(|_| Wanted::default()).collect(),
            measured: AtomicBool::new(false),
            followed: AtomicBool::new(false),
            lost: AtomicU64::new(0),
            beats: (0..groups).map(|_| Beat::default()).collect(),
            keeps: AtomicBool::new(false),
            pace,
            stops: AtomicBool::new(false),
        }
    }

    /// Says that the robot is there, and whether its groups react.
    pub fn alive(&self) -> Report {
        Report::Alive(self.beats.iter().map(Beat::report).collect())
    }

    /// Returns all active nodes.
    pub fn active_nodes(&self) -> Report {
        let active = self.active.iter().enumerate().filter(|(_, is)| is.load(Relaxed));
        Report::Active(active.map(|(node, _)| node as u32).collect())
    }
}

/// Pace of a program whose time is simulated: without it, an hour would pass before anyone could look.
pub struct Pace {
    state: Mutex<State>,
    changed: Condvar,
}

struct State {
    paused: bool,
    /// Number of reactions so far.
    reactions: u64,
    /// The point at which the program halts; until then it does not wait.
    goal: Option<Goal>,
    /// Number of goals that have been reached or given up.
    ways: u64,
    /// Number of reactions to which it is to go back.
    back: Option<u64>,
    speed: f64,
    /// Simulated time in ns and the machine's time at which the current speed began to hold.
    since: Option<(i64, Instant)>,
    /// Condition at which the program halts, and its last value.
    stop: (Vec<Test>, bool),
    /// `true` if viewers do not know the state yet.
    is_new: bool,
}

/// A point at which a program halts.
#[derive(Clone, Copy)]
enum Goal {
    /// After this number of reactions.
    Reactions(u64),
    /// Before the first reaction at this time in ns or a later one.
    Time(i64),
}

/// The next act of a program between two reactions.
pub enum Turn {
    /// It reacts.
    React,
    /// It looks for requests, and waits again.
    Wait,
    /// It goes back to this number of reactions.
    GoBack(u64),
}

/// Time after which a waiting program looks for requests.
const LOOK: Duration = Duration::from_millis(10);

impl Pace {
    /// A pace of as fast as possible; `paused` if the program waits for a viewer.
    pub fn new(paused: bool) -> Self {
        let (speed, stop) = (f64::INFINITY, (Vec::new(), false));
        let (goal, back, since) = (None, None, None);
        let state = State { paused, reactions: 0, goal, ways: 0, back, speed, since, stop, is_new: false };
        Self { state: Mutex::new(state), changed: Condvar::new() }
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// State of the program, for viewers.
    pub fn report(&self) -> Report {
        let State { paused, speed, reactions, goal, ways, .. } = *self.state();
        Report::Pace { paused: paused && goal.is_none(), speed, reactions, ways }
    }

    /// Number of reactions so far.
    pub fn reactions(&self) -> u64 {
        self.state().reactions
    }

    /// State of the program, if it has changed since the last call.
    pub fn news(&self) -> Option<Report> {
        let is_new = core::mem::take(&mut self.state().is_new);
        is_new.then(|| self.report())
    }

    /// Obeys a command, unless it is for something else. `active` has the active nodes.
    pub fn obey(&self, command: &Command, active: &[AtomicBool]) {
        let mut state = self.state();
        match command {
            Command::Pause => state.halt(),
            Command::Step => {
                let from = if let Some(Goal::Reactions(goal)) = state.goal { goal } else { state.reactions };
                state.goal = Some(Goal::Reactions(from + 1));
            }
            Command::RunTo { reactions } => state.goal = Some(Goal::Reactions(*reactions)),
            Command::RunUntil { now } => state.goal = Some(Goal::Time(*now)),
            Command::GoBack { reactions } => state.back = Some(*reactions),
            // Not a number, or nothing at all: the program would never continue.
            Command::Run { speed } if speed.is_nan() || *speed <= 0.0 => state.paused = true,
            Command::Run { speed } => {
                state.end_way();
                (state.paused, state.speed) = (false, *speed);
            }
            Command::Break(tests) => state.stop = (tests.clone(), holds(tests, active)),
            _ => return,
        }
        state.since = None;
        state.is_new = true;
        self.changed.notify_all();
    }

    /// Lets a program continue that waits for a viewer which has left.
    pub fn release(&self) {
        self.obey(&Command::Break(Vec::new()), &[]);
        self.obey(&Command::Run { speed: f64::INFINITY }, &[]);
    }

    /// Halts the program if the condition for that has become true. `active` has the active nodes.
    pub fn halt_if_wanted(&self, active: &[AtomicBool]) {
        self.state().stop(active);
    }

    /// Waits for a short time, unless the program may react at `now` (in ns) or has something else to do.
    pub fn turn(&self, now: i64) -> Turn {
        let mut state = self.state();
        if let Some(reactions) = state.back.take() {
            return Turn::GoBack(reactions);
        }
        let left = state.left(now);
        if left.is_zero() {
            return Turn::React;
        }
        drop(self.changed.wait_timeout(state, left).unwrap_or_else(PoisonError::into_inner));
        Turn::Wait
    }

    /// Counts a reaction, which begins now.
    pub fn begin(&self) {
        self.state().reactions += 1;
    }

    /// Halts the program until a viewer lets it run.
    pub fn halt(&self) {
        let mut state = self.state();
        state.halt();
        (state.back, state.since, state.is_new) = (None, None, true);
    }
}

impl State {
    fn halt(&mut self) {
        self.end_way();
        self.paused = true;
    }

    fn end_way(&mut self) {
        self.ways += u64::from(self.goal.take().is_some());
    }

    /// Halts the program if the condition for that has become true. What it does before a goal is known.
    fn stop(&mut self, active: &[AtomicBool]) {
        let (tests, was) = &mut self.stop;
        if tests.is_empty() {
            return;
        }
        let is = holds(tests, active);
        let was = core::mem::replace(was, is);
        if is && !was && self.goal.is_none() {
            (self.paused, self.is_new) = (true, true);
        }
    }

    /// Time to wait before the reaction at `now`, at most [`LOOK`].
    fn left(&mut self, now: i64) -> Duration {
        let is_there = |goal: Goal| match goal {
            Goal::Reactions(goal) => self.reactions >= goal,
            Goal::Time(goal) => now >= goal,
        };
        match self.goal.map(is_there) {
            Some(false) => return Duration::ZERO,
            Some(true) => {
                self.halt();
                self.is_new = true;
            }
            None => {}
        }
        if self.paused {
            return LOOK;
        }
        if self.speed.is_infinite() {
            return Duration::ZERO;
        }
        let (zero, start) = *self.since.get_or_insert_with(|| (now, Instant::now()));
        let due = Duration::from_nanos(now.saturating_sub(zero).max(0) as u64).as_secs_f64() / self.speed;
        let due = Duration::try_from_secs_f64(due).unwrap_or(Duration::MAX);
        due.saturating_sub(start.elapsed()).min(LOOK)
    }
}

/// `true` if the condition holds with these active nodes.
fn holds(tests: &[Test], active: &[AtomicBool]) -> bool {
    Test::holds(tests, |node| active.get(node as usize).is_some_and(|is| is.load(Relaxed)))
}
