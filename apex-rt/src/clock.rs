#[cfg(feature = "std")]
use crate::Switch;
use crate::Time;

/// Source of a program's time.
///
/// ```
/// use apex_rt::{drive, prelude::*};
/// use std::time::Duration;
///
/// apex_macros::graph!("examples/blink.afg");
///
/// /// The time of a simulator that runs for a second, in steps of 10 ms.
/// struct Simulator(Time);
///
/// impl Clock for Simulator {
///     const SIMULATED: bool = true;
///
///     fn now(&mut self) -> Time {
///         self.0
///     }
///
///     fn wait_until(&mut self, time: Time) -> bool {
///         while self.0 < time {
///             self.0 += Duration::from_millis(10);
///         }
///         self.0 < Time::from_secs(1)
///     }
/// }
///
/// # fn main() {
/// assert_eq!(drive(Blink::new(), Simulator(Time::ZERO)), 0);
/// # }
/// ```
pub trait Clock {
    /// `true` if time only passes while the program waits.
    const SIMULATED: bool = false;

    /// Returns the current time.
    fn now(&mut self) -> Time;

    /// Waits until `time`. Returns `false` if the clock ends before.
    fn wait_until(&mut self, time: Time) -> bool;

    /// Waits until `until`, forever if that is `None`, or until `woken` returns `true`. `woken` is called at the
    /// beginning and whenever the thread was unparked. Returns `false` if the clock ends before, or if nothing could
    /// end the wait.
    ///
    /// The default is for simulated clocks: nothing comes from outside then, so that a wait without an end would be in
    /// vain. [`WallClock`] parks the thread.
    #[cfg(feature = "std")]
    fn wait(&mut self, until: Option<Time>, woken: &dyn Fn() -> bool) -> bool {
        let _ = woken;
        until.is_some_and(|time| self.wait_until(time))
    }

    /// Returns the timing of the program's threads if this is the machine's clock.
    #[cfg(feature = "std")]
    fn pace(&self) -> Option<Pace> {
        None
    }
}

/// Simulated clock: jumps to the time of the next reaction, and ends at a given time.
///
/// A program that asks for another reaction at once advances the clock by `step`.
///
/// ```
/// use apex_rt::prelude::*;
///
/// let mut clock = SimClock::until(Time::from_secs(60));
/// assert!(clock.wait_until(Time::from_secs(59)));
/// assert_eq!(clock.now(), Time::from_secs(59));
/// assert!(!clock.wait_until(Time::from_secs(60)));
/// ```
#[derive(Debug, Clone, Copy)]
pub struct SimClock {
    now: Time,
    end: Time,
    step: core::time::Duration,
}

impl SimClock {
    /// Returns a clock from zero to `end` (exclusive) with a step of one millisecond.
    pub const fn until(end: Time) -> Self {
        Self { now: Time::ZERO, end, step: core::time::Duration::from_millis(1) }
    }

    /// Returns the clock with another step.
    ///
    /// ```
    /// use apex_rt::prelude::*;
    /// use std::time::Duration;
    ///
    /// let mut clock = SimClock::until(Time::from_secs(60)).with_step(Duration::from_millis(10));
    /// // A source without a period asks for another reaction at once.
    /// let now = clock.now();
    /// assert!(clock.wait_until(now));
    /// assert_eq!(clock.now(), Time::from_millis(10));
    /// ```
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

/// The machine's monotonic clock. Its zero is the time of its construction.
///
/// ```
/// use apex_rt::prelude::*;
///
/// let mut clock = WallClock::new();
/// assert!(clock.wait_until(Time::from_millis(2)));
/// assert!(clock.now() >= Time::from_millis(2));
/// ```
#[cfg(feature = "std")]
#[derive(Debug, Clone, Copy)]
pub struct WallClock {
    start: std::time::Instant,
}

#[cfg(feature = "std")]
impl WallClock {
    /// Returns a clock that starts now.
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

    fn pace(&self) -> Option<Pace> {
        Some(Pace { clock: *self, stopped: None })
    }
}

/// Timing of threads: the machine's clock, and a switch that ends the program.
///
/// ```
/// use apex_rt::{Switch, prelude::*, threads::Pace};
///
/// static STOP: Switch = Switch::new();
/// let pace = Pace { stopped: Some(&STOP), ..WallClock::new().pace().expect("it is the machine's clock") };
/// assert!(pace.stopped.is_some_and(|stop| !stop.is_set()));
/// ```
#[cfg(feature = "std")]
#[derive(Debug, Clone, Copy)]
pub struct Pace {
    /// Clock of all threads.
    pub clock: WallClock,
    /// Switch that ends the program.
    pub stopped: Option<&'static Switch>,
}
