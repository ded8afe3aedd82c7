//! Clocks of nodes: when a source fires, and how long a node was active.

use crate::{Next, Time};
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
    /// A timer that is due at `first` and every `period` from then on, in nanoseconds; `i64::MAX` is once.
    pub const fn new(first: i64, period: i64) -> Self {
        Self { due: Time::from_nanos(first), period }
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

/// The earliest time at which one of many timers and timeouts is due, so that a reaction that concerns none of them looks at
/// none of them.
#[derive(Debug, Clone)]
pub struct Agenda {
    /// `Time::MAX` if none is running.
    next: Time,
    /// A timer has changed since `next` was found, or one that is due is held back.
    open: bool,
}

impl Agenda {
    /// One that has not looked at any timer.
    #[allow(clippy::new_without_default, reason = "made by generated code alone, in constants")]
    pub const fn new() -> Self {
        Self { next: Time::MAX, open: true }
    }

    /// A timer was set, stopped or advanced.
    #[inline(always)]
    pub fn open(&mut self) {
        self.open = true;
    }

    /// The source of a timer fired.
    #[inline(always)]
    pub fn advance(&mut self, timer: &mut Timer) {
        timer.advance();
        self.open();
    }

    /// Whether a timer may be due at `now`, so that all are looked at, and then [`Agenda::close`] is called.
    #[inline(always)]
    pub fn is_due(&self, now: Time) -> bool {
        self.open || now >= self.next
    }

    /// All timers together wish `wish`; with `held_back` one that is due has to be looked at in every reaction.
    #[inline]
    pub fn close(&mut self, wish: Next, held_back: bool) {
        self.next = if let Next::At(time) = wish { time } else { Time::MAX };
        self.open = held_back;
    }

    /// When the first of them wants to be looked at.
    #[inline(always)]
    pub fn wish(&self) -> Next {
        if self.next == Time::MAX { Next::Input } else { Next::At(self.next) }
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
