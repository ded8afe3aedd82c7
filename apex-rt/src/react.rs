//! A reaction of a driven program, and what is looked at after it.

use crate::{Arrival, Next, Observer, Program, Time};
use core::time::Duration;

/// Executes a reaction, and tells the observer before and after it. `elapsed` returns the duration of the reaction so
/// far. Also returns `true` if a deadline was missed.
#[inline]
pub(crate) fn react<P: Program, O: Observer>(
    program: &mut P,
    now: Time,
    observer: &mut O,
    elapsed: &mut dyn FnMut() -> Duration,
) -> (Next, bool) {
    react_timed(program, now, observer, Stopwatch { elapsed, is_late: false, ends_early: true })
}

/// Repeats a reaction, which `ends_early` as the recorded one did.
#[cfg(feature = "record")]
pub(crate) fn react_again<P: Program>(program: &mut P, now: Time, observer: &mut impl Observer, ends_early: bool) {
    let elapsed = &mut || Duration::ZERO;
    react_timed(program, now, observer, Stopwatch { elapsed, is_late: false, ends_early });
}

#[inline]
fn react_timed<P: Program, O: Observer>(
    program: &mut P,
    now: Time,
    observer: &mut O,
    stopwatch: Stopwatch<'_>,
) -> (Next, bool) {
    observer.before_reaction(now, program);
    let mut observers = (&mut *observer, stopwatch);
    let next = program.react_with(now, &mut observers);
    let (observer, Stopwatch { is_late, .. }) = observers;
    observer.after_reaction(next);
    (next, is_late)
}

/// Observer that measures the duration of a reaction, and mostly ends a late one after each instant: tokens and
/// requests of other threads are served before the next. Its type does not depend on the clock, and that of all runs
/// with one type of observer is the same: the program is compiled once for them.
struct Stopwatch<'a> {
    elapsed: &'a mut dyn FnMut() -> Duration,
    /// `true` if a deadline was missed.
    is_late: bool,
    ends_early: bool,
}

impl Observer for Stopwatch<'_> {
    #[inline]
    fn ends_early(&mut self) -> bool {
        self.ends_early
    }

    #[inline]
    fn elapsed(&mut self) -> Duration {
        (self.elapsed)()
    }

    #[inline]
    fn late(&mut self, _node: usize, _age: Duration) {
        self.is_late = true;
    }
}

/// Lateness of a program, which is reported once until it has caught up.
#[derive(Debug, Default)]
pub(crate) struct Lateness {
    is_told: bool,
}

/// Lateness from which on it is reported.
const TOLD_FROM: Duration = Duration::from_secs(1);

impl Lateness {
    /// Looks at a reaction that began at `now`. `elapsed` returns its duration.
    #[inline]
    pub fn look<O: Observer>(&mut self, next: Next, now: Time, observer: &mut O, elapsed: impl FnOnce() -> Duration) {
        match next {
            Next::At(due) if due <= now => {
                let behind = now.since(due);
                if behind >= TOLD_FROM && !self.is_told {
                    self.is_told = true;
                    observer.behind(behind, elapsed());
                }
            }
            _ => self.is_told = false,
        }
    }
}

/// Watch over the events of a program: what triggers an event is held back until its token was taken, so that a program
/// whose events are not taken comes to a standstill.
#[derive(Debug, Default)]
pub(crate) struct Untaken {
    /// The token that waits, and since when.
    waits: Option<(Arrival, Time)>,
    /// The event that was reported last.
    told: Option<&'static str>,
}

/// Time from which on an event that is not taken is reported.
const UNTAKEN_FROM: Duration = Duration::from_secs(1);

impl Untaken {
    /// Looks at the events after a reaction at `now`. Returns when to look again, at the latest.
    #[inline]
    pub fn look<P: Program, O: Observer>(&mut self, program: &P, now: Time, observer: &mut O) -> Option<Time> {
        let Some((event, token)) = program.untaken().filter(|(event, _)| self.told != Some(*event)) else {
            self.waits = None;
            return None;
        };
        let since = self.waits.filter(|(waits, _)| *waits == token).map_or(now, |(_, since)| since);
        self.waits = Some((token, since));
        if now.since(since) < UNTAKEN_FROM {
            return Some(since + UNTAKEN_FROM);
        }
        self.told = Some(event);
        observer.untaken(event, now.since(since));
        None
    }
}
