//! Time: that of ROS, and that of the program.
//!
//! The times of a program count from its start, those of ROS from 1970, or are those of a simulation (`/clock`). Stamps
//! are converted on the way.

use apex_messages::{
    Message, Reason,
    cdr::{Outside, Reader, Writer},
};
use apex_rt::{Clock, Time, WallClock, threads::Pace};
use std::{
    sync::{
        Arc, Condvar, Mutex, MutexGuard, PoisonError,
        atomic::{AtomicI64, Ordering},
    },
    thread::{self, Thread},
    time::{Duration, SystemTime, UNIX_EPOCH},
};

/// Source of time of a program beside ROS.
#[derive(Clone)]
pub enum RosTime {
    /// The clock of the machine.
    Wall(Arc<Wall>),
    /// The times in `/clock`.
    Simulated(Arc<Simulated>),
}

/// The clock of the machine, and what it has to do with the calendar.
pub struct Wall {
    clock: WallClock,
    /// Calendar time of the clock's zero, in ns since 1970.
    zero: AtomicI64,
}

/// The time of a simulation.
#[derive(Default)]
pub struct Simulated {
    state: Mutex<State>,
    changed: Condvar,
}

#[derive(Default)]
struct State {
    /// The first time that came, which is the zero of the program.
    zero: Option<i64>,
    now: i64,
    /// Thread that waits for a time.
    waits: Option<Thread>,
    is_closed: bool,
}

/// Difference between calendar and clock from which on the calendar was set. Below it stamps stay exact.
const SET: i64 = 100_000_000;

impl RosTime {
    /// Returns the clock of the machine, which starts now.
    pub fn wall() -> Self {
        Self::Wall(Arc::new(Wall { clock: WallClock::new(), zero: AtomicI64::new(calendar()) }))
    }

    /// Returns a simulated time, which has no value yet.
    pub fn simulated() -> Self {
        Self::Simulated(Arc::default())
    }

    /// Returns the program's zero in ns of ROS. In simulated time this waits for the first `/clock`; `None` if there
    /// will be none.
    pub fn zero(&self) -> Option<i64> {
        match self {
            Self::Wall(wall) => Some(wall.zero()),
            Self::Simulated(time) => {
                let is_unknown = |state: &mut State| state.zero.is_none() && !state.is_closed;
                let state = time.changed.wait_while(time.state(), is_unknown);
                state.unwrap_or_else(PoisonError::into_inner).zero
            }
        }
    }

    /// Returns `true` if the program's zero is known.
    pub fn is_known(&self) -> bool {
        match self {
            Self::Wall(_) => true,
            Self::Simulated(time) => time.state().zero.is_some(),
        }
    }

    /// Returns the program's zero in ns of ROS, or 0 as long as it is not known.
    pub fn known_zero(&self) -> i64 {
        if self.is_known() { self.zero().unwrap_or_default() } else { 0 }
    }

    /// Returns the present time of ROS, in ns.
    pub fn now(&self) -> i64 {
        match self {
            Self::Wall(wall) => wall.zero().saturating_add(wall.now()),
            Self::Simulated(time) => time.state().now,
        }
    }

    /// Writes a message for other programs. Times in headers become those of ROS, and a header without one gets the
    /// present time, and `frame` if there is one.
    pub fn write(&self, message: &impl Message, frame: Option<&str>) -> Vec<u8> {
        let mut bytes = vec![];
        let outside = Outside { zero: self.known_zero(), now: self.now(), frame };
        message.write(&mut Writer::new(&mut bytes).for_others(outside));
        bytes
    }

    /// Reads a message of another program. Times in headers become those of this program.
    pub fn read<M: Message>(&self, bytes: &[u8]) -> Result<M, Reason> {
        M::read(&mut Reader::new(bytes)?.since(self.known_zero()))
    }

    /// Ends all waits for a time, because no more will come.
    pub fn close(&self) {
        if let Self::Simulated(time) = self {
            let mut state = time.state();
            state.is_closed = true;
            time.wake(state);
        }
    }
}

impl Wall {
    fn now(&self) -> i64 {
        let mut clock = self.clock;
        clock.now().as_nanos()
    }

    /// Zero of the clock. If the calendar was set, stamps follow.
    fn zero(&self) -> i64 {
        let (known, present) = (self.zero.load(Ordering::Relaxed), calendar() - self.now());
        if present.abs_diff(known) < SET.unsigned_abs() {
            return known;
        }
        self.zero.store(present, Ordering::Relaxed);
        present
    }
}

impl Simulated {
    /// Sets the time, in ns.
    pub fn set(&self, now: i64) {
        let mut state = self.state();
        state.zero.get_or_insert(now);
        state.now = now;
        self.wake(state);
    }

    fn wake(&self, mut state: MutexGuard<'_, State>) {
        let waits = state.waits.take();
        drop(state);
        self.changed.notify_all();
        waits.iter().for_each(Thread::unpark);
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Time since 1970, in ns.
pub fn calendar() -> i64 {
    let since = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    i64::try_from(since.as_nanos()).unwrap_or(i64::MAX)
}

/// The clock that drives a program beside ROS: that of the machine, or `/clock`.
///
/// In the time of a simulation the thread groups of a program react in turn on one thread.
#[derive(Clone)]
pub struct RosClock(pub(crate) RosTime);

/// Longest wait between two looks at whether a simulated program is to end.
pub const LOOK: Duration = Duration::from_millis(50);

impl Clock for RosClock {
    fn now(&mut self) -> Time {
        match &self.0 {
            RosTime::Wall(wall) => {
                let mut clock = wall.clock;
                clock.now()
            }
            RosTime::Simulated(time) => {
                let state = time.state();
                Time::from_nanos(state.now.saturating_sub(state.zero.unwrap_or(state.now)))
            }
        }
    }

    fn wait_until(&mut self, time: Time) -> bool {
        self.wait(Some(time), &|| false)
    }

    fn wait(&mut self, until: Option<Time>, woken: &dyn Fn() -> bool) -> bool {
        match &self.0 {
            RosTime::Wall(wall) => {
                let mut clock = wall.clock;
                clock.wait(until, woken)
            }
            RosTime::Simulated(time) => loop {
                let mut state = time.state();
                let now = Time::from_nanos(state.now.saturating_sub(state.zero.unwrap_or(state.now)));
                if state.is_closed {
                    return false;
                }
                state.waits = Some(thread::current());
                drop(state);
                if until.is_some_and(|until| until <= now) || woken() {
                    return true;
                }
                thread::park_timeout(LOOK);
            },
        }
    }

    fn pace(&self) -> Option<Pace> {
        match &self.0 {
            RosTime::Wall(wall) => wall.clock.pace(),
            RosTime::Simulated(_) => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_program_starts_at_zero() {
        let time = RosTime::wall();
        let zero = time.zero().expect("a zero");
        assert!(zero.abs_diff(calendar()) < 1_000_000_000 && time.now() >= zero);
        assert!(RosClock(time).now() < Time::from_secs(1));
    }

    #[test]
    fn stamps_follow_a_calendar_that_is_set() {
        let RosTime::Wall(wall) = RosTime::wall() else { panic!() };
        let zero = wall.zero();
        wall.zero.store(zero + SET / 2, Ordering::Relaxed);
        assert_eq!(wall.zero(), zero + SET / 2, "the clocks drift");
        wall.zero.store(zero + 10 * SET, Ordering::Relaxed);
        assert!(wall.zero().abs_diff(zero) < SET.unsigned_abs());
    }

    #[test]
    fn simulated_time_counts_from_the_first_one() {
        let time = RosTime::simulated();
        let RosTime::Simulated(simulated) = &time else { panic!() };
        let waits = thread::spawn({
            let time = time.clone();
            move || (time.zero(), RosClock(time).wait_until(Time::from_secs(2)))
        });
        for now in [1000, 1001, 1002] {
            thread::sleep(Duration::from_millis(5));
            simulated.set(now * 1_000_000_000);
        }
        assert_eq!(waits.join().ok(), Some((Some(1_000_000_000_000), true)));
        assert_eq!((RosClock(time.clone()).now(), time.now()), (Time::from_secs(2), 1_002_000_000_000));
        time.close();
        assert!(!RosClock(time).wait_until(Time::from_secs(3)));
    }

    #[test]
    fn a_simulation_that_never_runs_has_no_zero() {
        let time = RosTime::simulated();
        let waits = thread::spawn({
            let time = time.clone();
            move || time.zero()
        });
        time.close();
        assert_eq!(waits.join().ok(), Some(None));
    }
}
