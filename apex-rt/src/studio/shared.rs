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
    /// Pace of the program, if its time is simulated.
    pub pace: Option<Pace>,
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

impl Shared {
    pub fn new(nodes: usize, channels: usize, pace: Option<Pace>) -> Self {
        Self {
            watched: AtomicBool::new(false),
            over: AtomicBool::new(false),
            active: (0..nodes).map(|_| AtomicBool::new(false)).collect(),
            channels: (0..channels).map(|_| Wanted::default()).collect(),
            measured: AtomicBool::new(false),
            followed: AtomicBool::new(false),
            lost: AtomicU64::new(0),
            pace,
        }
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
    /// Number of reactions after which the program halts; until then it does not wait.
    goal: Option<u64>,
    speed: f64,
    /// Simulated time in ns and the machine's time at which the current speed began to hold.
    since: Option<(i64, Instant)>,
    /// Condition at which the program halts, and its last value.
    stop: (Vec<Test>, bool),
    /// `true` if viewers do not know the state yet.
    is_new: bool,
}

/// Time after which a waiting program looks for requests.
const LOOK: Duration = Duration::from_millis(10);

impl Pace {
    /// A pace of as fast as possible; `paused` if the program waits for a viewer.
    pub fn new(paused: bool) -> Self {
        let (speed, stop) = (f64::INFINITY, (Vec::new(), false));
        let state = State { paused, reactions: 0, goal: None, speed, since: None, stop, is_new: false };
        Self { state: Mutex::new(state), changed: Condvar::new() }
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// State of the program, for viewers.
    pub fn report(&self) -> Report {
        let State { paused, speed, reactions, goal, .. } = *self.state();
        Report::Pace { paused: paused && goal.is_none(), speed, reactions }
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
            Command::Pause => (state.paused, state.goal) = (true, None),
            Command::Step => state.goal = Some(state.goal.unwrap_or(state.reactions) + 1),
            Command::RunTo { reactions } => state.goal = Some(*reactions),
            // Not a number, or nothing at all: the program would never continue.
            Command::Run { speed } if speed.is_nan() || *speed <= 0.0 => state.paused = true,
            Command::Run { speed } => (state.paused, state.goal, state.speed) = (false, None, *speed),
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

    /// Waits until the program may react at `now` (in ns), and calls `serve` from time to time. `active` has the active
    /// nodes.
    pub fn wait(&self, now: i64, active: &[AtomicBool], mut serve: impl FnMut()) {
        self.state().stop(active);
        loop {
            let mut state = self.state();
            let left = state.left(now);
            if left.is_zero() {
                state.reactions += 1;
                return;
            }
            drop(self.changed.wait_timeout(state, left).unwrap_or_else(PoisonError::into_inner));
            serve();
        }
    }
}

impl State {
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
        match self.goal {
            Some(goal) if self.reactions < goal => return Duration::ZERO,
            Some(_) => (self.goal, self.paused, self.is_new) = (None, true, true),
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
