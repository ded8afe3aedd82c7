//! State that the thread groups of a program share with the thread that talks to viewers.

use super::message::{Command, Report};
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
    /// Number of reactions that a halted program may still do.
    steps: u32,
    speed: f64,
    /// Simulated time in ns and the machine's time at which the current speed began to hold.
    since: Option<(i64, Instant)>,
}

/// Time after which a waiting program looks for requests.
const LOOK: Duration = Duration::from_millis(10);

impl Pace {
    /// A pace of as fast as possible; `paused` if the program waits for a viewer.
    pub fn new(paused: bool) -> Self {
        let state = State { paused, steps: 0, speed: f64::INFINITY, since: None };
        Self { state: Mutex::new(state), changed: Condvar::new() }
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// State of the program, for viewers.
    pub fn report(&self) -> Report {
        let state = self.state();
        Report::Pace { paused: state.paused, speed: state.speed }
    }

    /// Obeys a command. Returns `false` if it is for something else.
    pub fn obey(&self, command: &Command) -> bool {
        let mut state = self.state();
        match *command {
            Command::Pause => state.paused = true,
            Command::Step if state.paused => state.steps += 1,
            Command::Step => {}
            // Not a number, or nothing at all: the program would never continue.
            Command::Run { speed } if speed.is_nan() || speed <= 0.0 => state.paused = true,
            Command::Run { speed } => (state.paused, state.steps, state.speed) = (false, 0, speed),
            _ => return false,
        }
        state.since = None;
        self.changed.notify_all();
        true
    }

    /// Lets a program continue that waits for a viewer which has left.
    pub fn release(&self) {
        self.obey(&Command::Run { speed: f64::INFINITY });
    }

    /// Waits until the program may react at `now` (in ns), and calls `serve` from time to time.
    pub fn wait(&self, now: i64, mut serve: impl FnMut()) {
        loop {
            let mut state = self.state();
            let left = match &mut *state {
                State { paused: true, steps: 0, .. } => LOOK,
                State { paused: true, steps, .. } => {
                    *steps -= 1;
                    return;
                }
                State { speed, .. } if speed.is_infinite() => return,
                State { speed, since, .. } => {
                    let (zero, start) = *since.get_or_insert_with(|| (now, Instant::now()));
                    let due = Duration::from_nanos(now.saturating_sub(zero).max(0) as u64).as_secs_f64() / *speed;
                    let due = Duration::try_from_secs_f64(due).unwrap_or(Duration::MAX);
                    let left = due.saturating_sub(start.elapsed());
                    if left.is_zero() {
                        return;
                    }
                    left.min(LOOK)
                }
            };
            drop(self.changed.wait_timeout(state, left).unwrap_or_else(PoisonError::into_inner));
            serve();
        }
    }
}
