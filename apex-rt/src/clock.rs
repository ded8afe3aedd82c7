use crate::Time;

/// Where a program's time comes from.
pub trait Clock {
    /// Whether its time stands still while nobody asks for it.
    const SIMULATED: bool = false;

    /// The time now.
    fn now(&mut self) -> Time;

    /// Lets the time pass until `time`; returns `false` if the clock ends before.
    fn wait_until(&mut self, time: Time) -> bool;

    /// Lets the time pass until `until`, for ever if that is `None`, but only as long as `woken` says no: it is asked
    /// at the beginning, and again whenever the thread was unparked. Returns `false` if the clock ends before, or if
    /// nothing could end the wait.
    ///
    /// As it is here, it is for clocks that stand still while a program reacts: nothing comes from outside then, so
    /// that a wait without end is one in vain. The clock of a machine parks the thread.
    #[cfg(feature = "std")]
    fn wait(&mut self, until: Option<Time>, woken: &dyn Fn() -> bool) -> bool {
        let _ = woken;
        until.is_some_and(|time| self.wait_until(time))
    }

    /// What sets the pace of threads, if this is the machine's clock.
    #[cfg(feature = "std")]
    fn pace(&self) -> Option<crate::threads::Pace> {
        None
    }
}

/// Simulated time: jumps to where the program wants to be called next, and ends at a given time.
///
/// A program that wants to be called again at once advances it by `step`.
#[derive(Debug, Clone, Copy)]
pub struct SimClock {
    now: Time,
    end: Time,
    step: core::time::Duration,
}

impl SimClock {
    /// A clock from zero to `end` (exclusive), one millisecond a step.
    pub const fn until(end: Time) -> Self {
        Self { now: Time::ZERO, end, step: core::time::Duration::from_millis(1) }
    }

    /// The same clock with another step.
    #[must_use]
    pub const fn with_step(self, step: core::time::Duration) -> Self {
        Self { step, ..self }
    }
}

impl Clock for SimClock {
    const SIMULATED: bool = true;

    fn now(&mut self) -> Time {
        self.now
    }

    fn wait_until(&mut self, time: Time) -> bool {
        self.now = if time > self.now { time } else { self.now + self.step };
        self.now < self.end
    }
}

/// The machine's monotonic clock; zero is when it was made.
#[cfg(feature = "std")]
#[derive(Debug, Clone, Copy)]
pub struct WallClock {
    start: std::time::Instant,
}

#[cfg(feature = "std")]
impl WallClock {
    /// A clock that starts now.
    pub fn new() -> Self {
        Self { start: std::time::Instant::now() }
    }
}

#[cfg(feature = "std")]
impl Default for WallClock {
    fn default() -> Self {
        Self::new()
    }
}

#[cfg(feature = "std")]
impl Clock for WallClock {
    fn now(&mut self) -> Time {
        Time::ZERO + self.start.elapsed()
    }

    fn wait_until(&mut self, time: Time) -> bool {
        let left = time.since(self.now());
        if !left.is_zero() {
            std::thread::sleep(left);
        }
        true
    }

    fn wait(&mut self, until: Option<Time>, woken: &dyn Fn() -> bool) -> bool {
        while !woken() {
            match until.map(|time| time.since(self.now())) {
                Some(left) if left.is_zero() => break,
                Some(left) => std::thread::park_timeout(left),
                None => std::thread::park(),
            }
        }
        true
    }

    fn pace(&self) -> Option<crate::threads::Pace> {
        Some(crate::threads::Pace { clock: *self, stopped: None })
    }
}
