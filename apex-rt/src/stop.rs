#[cfg(feature = "ctrl-c")]
use crate::end;
use crate::{Clock, Switch, Time};

/// A clock that ends when a switch is turned, by the handler of a signal or by another thread.
///
/// ```
/// use apex_rt::{Switch, UntilStopped, prelude::*};
///
/// static STOP: Switch = Switch::new();
/// let mut clock = UntilStopped::new(SimClock::until(Time::MAX), &STOP);
/// assert!(clock.wait_until(Time::from_secs(1)));
/// STOP.set();
/// assert!(clock.is_stopped() && !clock.wait_until(Time::from_secs(2)));
/// ```
#[derive(Debug, Clone, Copy)]
pub struct UntilStopped<C> {
    clock: C,
    switch: &'static Switch,
}

impl<C: Clock> UntilStopped<C> {
    /// Returns `clock` with an end when `switch` is turned. A custom clock notices that during a wait only if it
    /// implements [`Clock::wait`].
    pub const fn new(clock: C, switch: &'static Switch) -> Self {
        Self { clock, switch }
    }

    /// Returns `clock` with an end at Ctrl-C or another signal that would otherwise end the process. A second signal
    /// ends the process within a second, in case a node hangs.
    /// [`run`](crate::run) and [`drive`](crate::drive) by the machine's clock need none.
    ///
    /// ```
    /// use apex_rt::{UntilStopped, drive, prelude::*};
    ///
    /// apex_macros::graph!("examples/blink.afg");
    ///
    /// # fn main() -> Result<(), String> {
    /// // By the machine's clock, `drive` handles the signals itself.
    /// let clock = UntilStopped::ctrl_c(SimClock::until(Time::from_secs(60)))?;
    /// assert_eq!(drive(Blink::new(), clock), 0);
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    /// The signals cannot be handled, or already have another handler.
    #[cfg(feature = "ctrl-c")]
    pub fn ctrl_c(clock: C) -> Result<Self, String> {
        end::handle_signals().map_err(|error| format!("cannot wait for Ctrl-C: {error}"))?;
        Ok(Self::new(clock, &end::ASKED))
    }

    /// Returns `true` if the switch was turned.
    pub fn is_stopped(&self) -> bool {
        self.switch.is_set()
    }
}

impl<C: Clock> Clock for UntilStopped<C> {
    const SIMULATED: bool = C::SIMULATED;

    fn now(&mut self) -> Time {
        self.clock.now()
    }

    fn wait_until(&mut self, time: Time) -> bool {
        self.wait(Some(time), &|| false)
    }

    fn wait(&mut self, until: Option<Time>, woken: &dyn Fn() -> bool) -> bool {
        if self.switch.is_set() {
            return false;
        }
        // A program that does not wait reacts again at once: listening would only cost time.
        let _listens = until.is_none_or(|time| time > self.clock.now()).then(|| self.switch.listen());
        let woken = || self.switch.is_set() || woken();
        self.clock.wait(until, &woken) && !self.switch.is_set()
    }

    fn pace(&self) -> Option<crate::threads::Pace> {
        Some(crate::threads::Pace { stopped: Some(self.switch), ..self.clock.pace()? })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::{cell::Cell, thread};

    /// Clock that counts its waits, and is unparked as the machine's clock is.
    struct Counting<'a> {
        waits: &'a Cell<u32>,
        now: Time,
    }

    impl Clock for Counting<'_> {
        fn now(&mut self) -> Time {
            self.now
        }

        fn wait_until(&mut self, time: Time) -> bool {
            self.wait(Some(time), &|| false)
        }

        fn wait(&mut self, until: Option<Time>, woken: &dyn Fn() -> bool) -> bool {
            self.waits.set(self.waits.get() + 1);
            while until.is_none() && !woken() {
                thread::park();
            }
            self.now = until.unwrap_or(self.now);
            true
        }
    }

    #[test]
    fn an_hour_is_a_single_wait() {
        static SWITCH: Switch = Switch::new();
        let waits = Cell::new(0);
        let mut clock = UntilStopped::new(Counting { waits: &waits, now: Time::ZERO }, &SWITCH);
        assert!(clock.wait_until(Time::from_secs(3600)));
        assert_eq!((waits.get(), clock.now()), (1, Time::from_secs(3600)));
    }

    #[test]
    fn the_switch_ends_a_wait_without_end_and_all_later_ones() {
        static SWITCH: Switch = Switch::new();
        let waits = Cell::new(0);
        let mut clock = UntilStopped::new(Counting { waits: &waits, now: Time::ZERO }, &SWITCH);
        let turns = thread::spawn(|| SWITCH.set());
        assert!(!clock.wait(None, &|| false), "it is over");
        assert!(turns.join().is_ok());
        assert!(waits.get() <= 1, "whether the switch was turned before or while it waited");
        let before = waits.get();
        assert!(!clock.wait_until(Time::from_secs(1)));
        assert_eq!(waits.get(), before, "nobody waits any more");
    }
}
