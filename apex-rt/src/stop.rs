use crate::{Clock, Switch, Time};

/// A clock that ends when a switch is turned, by the handler of a signal or by another thread.
#[derive(Debug, Clone, Copy)]
pub struct UntilStopped<C> {
    clock: C,
    switch: &'static Switch,
}

/// Turned by the signals that ask the process to end.
#[cfg(feature = "ctrl-c")]
static STOPPED: Switch = Switch::new();

/// The exit code of a process that was asked to end twice: that of one that Ctrl-C ends, as shells see it.
#[cfg(feature = "ctrl-c")]
const INTERRUPTED: i32 = 130;

impl<C: Clock> UntilStopped<C> {
    /// `clock` until `switch` is turned. A clock of one's own hears of it while it waits if it has [`Clock::wait`].
    pub const fn new(clock: C, switch: &'static Switch) -> Self {
        Self { clock, switch }
    }

    /// `clock` until Ctrl-C or another signal asks the process to end, which it then does not do by itself. A second
    /// one ends the process at once: a node that hangs does not come back. Only one clock of a process can be made so.
    ///
    /// # Errors
    /// The signals cannot be handled, or are handled by somebody else.
    #[cfg(feature = "ctrl-c")]
    pub fn ctrl_c(clock: C) -> Result<Self, String> {
        ctrlc::set_handler(asked).map_err(|error| format!("cannot wait for Ctrl-C: {error}"))?;
        Ok(Self::new(clock, &STOPPED))
    }

    /// The same, unless somebody else handles the signals, who then has to end the clock.
    #[cfg(any(feature = "profile", feature = "record"))]
    pub(crate) fn ctrl_c_if_free(clock: C) -> Self {
        let _ = ctrlc::set_handler(asked);
        Self::new(clock, &STOPPED)
    }
}

/// A signal asks the process to end.
#[cfg(feature = "ctrl-c")]
fn asked() {
    if STOPPED.is_set() {
        eprintln!("ended at once, since it was asked to end again before it had");
        std::process::exit(INTERRUPTED);
    }
    STOPPED.set();
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
        // A program that sets no pace is called again at once: it has no time to listen.
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

    /// Counts how often it waits, and is unparked as the machine's clock is.
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
