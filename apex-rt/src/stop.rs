//! A clock that somebody can end: a signal, another thread.

use crate::{Clock, Time};
use core::time::Duration;
use std::sync::atomic::{AtomicBool, Ordering};

/// A clock that ends when a switch is set, by the handler of a signal or by another thread.
#[derive(Debug, Clone, Copy)]
pub struct UntilStopped<C> {
    clock: C,
    stopped: &'static AtomicBool,
}

/// Set by the signals that ask the process to end.
#[cfg(feature = "ctrl-c")]
static STOPPED: AtomicBool = AtomicBool::new(false);

/// How long it may take until the switch is noticed.
const NOTICED: Duration = Duration::from_millis(20);

impl<C: Clock> UntilStopped<C> {
    /// `clock` until `stopped` is true.
    pub const fn new(clock: C, stopped: &'static AtomicBool) -> Self {
        Self { clock, stopped }
    }

    /// `clock` until Ctrl-C or another signal asks the process to end, which it then does not do by itself. Only one
    /// clock of a process can be made so.
    ///
    /// # Errors
    /// The signals cannot be handled, or are handled by somebody else.
    #[cfg(feature = "ctrl-c")]
    pub fn ctrl_c(clock: C) -> Result<Self, String> {
        ctrlc::set_handler(|| STOPPED.store(true, Ordering::Relaxed))
            .map_err(|error| format!("cannot wait for Ctrl-C: {error}"))?;
        Ok(Self::new(clock, &STOPPED))
    }

    /// The same, unless somebody else handles the signals, who then has to end the clock.
    #[cfg(any(feature = "profile", feature = "record"))]
    pub(crate) fn ctrl_c_if_free(clock: C) -> Self {
        let _ = ctrlc::set_handler(|| STOPPED.store(true, Ordering::Relaxed));
        Self::new(clock, &STOPPED)
    }
}

impl<C: Clock> Clock for UntilStopped<C> {
    const SIMULATED: bool = C::SIMULATED;

    fn now(&mut self) -> Time {
        self.clock.now()
    }

    fn wait_until(&mut self, time: Time) -> bool {
        loop {
            if self.stopped.load(Ordering::Relaxed) {
                return false;
            }
            let soon = self.clock.now() + NOTICED;
            if time <= soon {
                return self.clock.wait_until(time) && !self.stopped.load(Ordering::Relaxed);
            }
            if !self.clock.wait_until(soon) {
                return false;
            }
        }
    }

    fn pace(&self) -> Option<crate::threads::Pace> {
        Some(crate::threads::Pace { stopped: Some(self.stopped), ..self.clock.pace()? })
    }
}
