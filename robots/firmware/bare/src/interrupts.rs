//! Simulated interrupts.

use apex_rt::prelude::*;
use core::sync::atomic::{AtomicBool, Ordering};

/// Flag set by an interrupt. Only the main loop accesses the graph.
pub struct Flag(AtomicBool);

/// Flag of the button.
pub static BUTTON: Flag = Flag::new();
/// Flag of the bumper.
pub static BUMPER: Flag = Flag::new();

impl Flag {
    const fn new() -> Self {
        Self(AtomicBool::new(false))
    }

    /// Sets the flag. Called by the interrupt.
    fn raise(&self) {
        self.0.store(true, Ordering::Release);
    }

    /// Returns `true` if the interrupt happened since the last call.
    pub fn take(&self) -> bool {
        self.0.swap(false, Ordering::Acquire)
    }
}

/// Raises the simulated interrupts of a person and a wall at the time `now`.
pub fn happen(now: Time) {
    const PRESSED: [i64; 3] = [500, 1000, 3000];
    const HIT: [i64; 2] = [250, 2000];
    let is_now = |times: &[i64]| times.iter().any(|time| Time::from_millis(*time) == now);
    if is_now(&PRESSED) {
        BUTTON.raise();
    }
    if is_now(&HIT) {
        BUMPER.raise();
    }
}
