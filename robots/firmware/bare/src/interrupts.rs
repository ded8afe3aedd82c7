//! Interrupts, and when they happen here.

use apex_rt::prelude::*;
use core::sync::atomic::{AtomicBool, Ordering};

/// What an interrupt leaves behind for the loop, which alone touches the graph.
pub struct Flag(AtomicBool);

/// The button was pressed.
pub static BUTTON: Flag = Flag::new();
/// The bumper hit something.
pub static BUMPER: Flag = Flag::new();

impl Flag {
    const fn new() -> Self {
        Self(AtomicBool::new(false))
    }

    /// Called by the interrupt.
    fn raise(&self) {
        self.0.store(true, Ordering::Release);
    }

    /// Whether the interrupt happened since the last call.
    pub fn take(&self) -> bool {
        self.0.swap(false, Ordering::Acquire)
    }
}

/// Stands in for a person and a wall: the interrupts that happen at `now`.
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
