//! Clocks of nodes: when a source fires, and how long a node was active.

use crate::{Next, Time, time::nanos};
use core::time::Duration;

/// The clock of a source with `every` or `after`: due at `first`, `first + period`, `first` + 2·`period`, … Late
/// calls are made up for, so that the number of firings depends on the time alone and never drifts.
#[derive(Debug, Clone)]
pub struct Timer {
    due: Time,
    /// In nanoseconds: adding a `Duration` takes a wide multiplication.
    period: i64,
}

impl Timer {
    /// A timer that is due at `first` and every `period` from then on; `Duration::MAX` is once.
    pub const fn new(first: Duration, period: Duration) -> Self {
        Self { due: Time::from_nanos(nanos(first)), period: nanos(period) }
    }

    /// Whether it is due at `now`.
    #[inline(always)]
    pub fn is_due(&self, now: Time) -> bool {
        now >= self.due
    }

    /// When it wants to be looked at again. What is due already waits for something else.
    pub fn wish(&self, now: Time) -> Next {
        if self.is_due(now) || self.due == Time::MAX { Next::Input } else { Next::At(self.due) }
    }

    /// Its source fired.
    #[inline(always)]
    pub fn advance(&mut self) {
        self.due = Time::from_nanos(self.due.as_nanos().saturating_add(self.period));
    }
}

/// The clock of a node with `timeout`: runs while the node is active.
#[derive(Debug, Clone, Default)]
pub struct Timeout {
    due: Option<Time>,
}

impl Timeout {
    /// One that does not run.
    pub const fn new() -> Self {
        Self { due: None }
    }

    /// The node became active.
    pub fn start(&mut self, now: Time, after: Duration) {
        self.due = Some(now + after);
    }

    /// The node is no longer active, or the event was triggered.
    pub fn stop(&mut self) {
        self.due = None;
    }

    /// Whether the node was active for so long.
    #[inline(always)]
    pub fn is_due(&self, now: Time) -> bool {
        self.due.is_some_and(|due| now >= due)
    }

    /// When it wants to be looked at again. What is due already waits for something else.
    pub fn wish(&self, now: Time) -> Next {
        match self.due {
            Some(due) if due > now => Next::At(due),
            _ => Next::Input,
        }
    }
}
