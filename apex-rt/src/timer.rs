//! Timers of sources, timeouts of active nodes, and the time of a program.

use crate::{Next, Observer, Param, ParamField, Time};
use core::time::Duration;

/// Time of a program. It is that of its reactions, but never goes back: if a reaction is earlier than the one before,
/// because a recording is looped or a simulator was restarted, the program's time goes on from where it was.
#[derive(Debug, Clone)]
pub struct ProgramTime {
    /// Time of the last instant.
    last: Time,
    /// Program's time less the time of the reactions, in ns.
    ahead: i64,
}

impl ProgramTime {
    /// Returns the time before the first reaction.
    #[allow(clippy::new_without_default, reason = "made by generated code alone, in constants")]
    pub const fn new() -> Self {
        Self { last: Time::from_nanos(i64::MIN), ahead: 0 }
    }

    /// Returns the program's time of a reaction at `now`. Reports a time that has gone back.
    #[inline(always)]
    pub fn of<O: Observer>(&mut self, now: Time, observer: &mut O) -> Time {
        let own = Time::from_nanos(now.as_nanos().saturating_add(self.ahead));
        if own < self.last { self.set_back(own, observer) } else { own }
    }

    #[cold]
    fn set_back<O: Observer>(&mut self, own: Time, observer: &mut O) -> Time {
        let by = self.last.since(own);
        self.ahead = self.ahead.saturating_add(crate::time::nanos(by));
        observer.set_back(by);
        self.last
    }

    /// Returns the time of the last instant.
    #[inline(always)]
    pub const fn last(&self) -> Time {
        self.last
    }

    /// Returns how far the program's time is ahead of that of the reactions, in ns: more whenever that goes back.
    #[inline(always)]
    pub const fn ahead(&self) -> i64 {
        self.ahead
    }

    /// Begins the instant `at`.
    #[inline(always)]
    pub const fn begin(&mut self, at: Time) {
        self.last = at;
    }

    /// Returns the time of the next reaction by the clock of the reactions.
    #[inline(always)]
    pub fn outside(&self, next: Next) -> Next {
        match next {
            Next::At(time) => Next::At(Time::from_nanos(time.as_nanos().saturating_sub(self.ahead))),
            next => next,
        }
    }
}

/// Returns the earlier of `at` and `due`, unless `due` is not after the `last` instant: what was due then and could not
/// happen is not an instant of its own.
#[inline(always)]
fn instant(due: Time, last: Time, at: Time) -> Time {
    if due > last && due < at { due } else { at }
}

/// Timer of a source with `every` or `after`: due at `first`, `first + period`, `first` + 2·`period`, … Late firings
/// are made up for, unless they are skipped. So the number of firings depends on the time alone and never drifts.
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

    /// Returns the instant at which the timer is due, if that comes after the `last` one and before `at`, else `at`.
    #[inline(always)]
    pub fn instant(&self, last: Time, at: Time) -> Time {
        instant(self.due, last, at)
    }

    /// Skips all firings that are missed at `now`, but for the last one.
    #[inline(always)]
    pub fn skip(&mut self, now: Time) {
        let missed = now.as_nanos().saturating_sub(self.due.as_nanos());
        if missed >= self.period {
            self.due = Time::from_nanos(self.due.as_nanos() + missed / self.period * self.period);
        }
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

/// Time without tokens after which a node is called with ⊥, of at least one millisecond.
pub trait Silence {
    /// Returns the time.
    fn duration(&self) -> Duration;
}

/// Shortest silence: shorter ones would be nothing but a busy loop.
const SHORTEST_SILENCE: Duration = Duration::from_millis(1);

impl Silence for Duration {
    fn duration(&self) -> Duration {
        (*self).max(SHORTEST_SILENCE)
    }
}

/// In s. NaN is the shortest silence.
impl Silence for f64 {
    fn duration(&self) -> Duration {
        let shortest = SHORTEST_SILENCE.as_secs_f64();
        if *self > shortest { Duration::try_from_secs_f64(*self).unwrap_or(Duration::MAX) } else { SHORTEST_SILENCE }
    }
}

/// In s. NaN is the shortest silence.
impl Silence for f32 {
    fn duration(&self) -> Duration {
        f64::from(*self).duration()
    }
}

/// Longest silence that a node endures: its parameter number `I`.
#[doc(hidden)]
pub fn endured<const I: usize, N>(node: &mut N) -> Duration
where
    N: ParamField<I>,
    <N as Param<I>>::Value: Silence,
{
    node.field().duration()
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

    /// Returns the instant at which the timeout expires, if that comes after the `last` one and before `at`, else `at`.
    #[inline(always)]
    pub fn instant(&self, last: Time, at: Time) -> Time {
        self.due.map_or(at, |due| instant(due, last, at))
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
