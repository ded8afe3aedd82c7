//! Timers of sources, and timeouts of active nodes.

use crate::{Next, Time};
use core::time::Duration;

/// Timer of a source with `every` or `after`: due at `first`, `first + period`, `first` + 2·`period`, … Late firings
/// are made up for, so that the number of firings depends on the time alone and never drifts.
#[derive(Debug, Clone)]
pub struct Timer {
    due: Time,
    /// Period in ns. Adding a `Duration` would take a wide multiplication.
    period: i64,
}

impl Timer {
    /// Returns a timer that is due at `first` and then every `period`, in ns; with a period of `i64::MAX` only once.
    pub const fn new(first: i64, period: i64) -> Self {
        Self { due: Time::from_nanos(first), period }
    }

    /// Returns `true` if the timer is due at `now`.
    #[inline(always)]
    pub fn is_due(&self, now: Time) -> bool {
        now >= self.due
    }

    /// Returns the time of its next check. If it is due already, its firing depends on something else.
    pub fn wish(&self, now: Time) -> Next {
        if self.is_due(now) || self.due == Time::MAX { Next::Input } else { Next::At(self.due) }
    }

    /// Advances to the next firing, after its source fired.
    #[inline(always)]
    pub fn advance(&mut self) {
        self.due = Time::from_nanos(self.due.as_nanos().saturating_add(self.period));
    }
}

/// The earliest time at which one of many timers and timeouts is due. A reaction before that time checks none of them.
#[derive(Debug, Clone)]
pub struct Agenda {
    /// Earliest time at which one is due; `Time::MAX` if none is running.
    next: Time,
    /// `true` if a timer changed since `next` was computed, or if one that is due is held back.
    open: bool,
}

impl Agenda {
    /// Returns an agenda whose first reaction checks all timers.
    #[allow(clippy::new_without_default, reason = "made by generated code alone, in constants")]
    pub const fn new() -> Self {
        Self { next: Time::MAX, open: true }
    }

    /// Requests a check of all timers, because one was set, stopped or advanced.
    #[inline(always)]
    pub fn open(&mut self) {
        self.open = true;
    }

    /// Advances `timer` after its source fired, and requests a check.
    #[inline(always)]
    pub fn advance(&mut self, timer: &mut Timer) {
        timer.advance();
        self.open();
    }

    /// Returns `true` if a timer may be due at `now`. Then all are checked, and [`Agenda::close`] is called.
    #[inline(always)]
    pub fn is_due(&self, now: Time) -> bool {
        self.open || now >= self.next
    }

    /// Ends a check of all timers, whose earliest time is `wish`. With `held_back`, one that is due could not fire: the
    /// next reaction checks again.
    #[inline]
    pub fn close(&mut self, wish: Next, held_back: bool) {
        self.next = if let Next::At(time) = wish { time } else { Time::MAX };
        self.open = held_back;
    }

    /// Returns the time of the next check.
    #[inline(always)]
    pub fn wish(&self) -> Next {
        if self.next == Time::MAX { Next::Input } else { Next::At(self.next) }
    }
}

/// Timeout of a node: runs while the node is active.
#[derive(Debug, Clone, Default)]
pub struct Timeout {
    due: Option<Time>,
}

impl Timeout {
    /// Returns a timeout that does not run.
    pub const fn new() -> Self {
        Self { due: None }
    }

    /// Starts the timeout when the node becomes active.
    pub fn start(&mut self, now: Time, after: Duration) {
        self.due = Some(now + after);
    }

    /// Stops the timeout when the node is no longer active, or the event was triggered.
    pub fn stop(&mut self) {
        self.due = None;
    }

    /// Returns `true` if the timeout has expired at `now`.
    #[inline(always)]
    pub fn is_due(&self, now: Time) -> bool {
        self.due.is_some_and(|due| now >= due)
    }

    /// Returns the time of its next check. If it is due already, its firing depends on something else.
    pub fn wish(&self, now: Time) -> Next {
        match self.due {
            Some(due) if due > now => Next::At(due),
            _ => Next::Input,
        }
    }
}
