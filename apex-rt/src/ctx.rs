use crate::{Observer, Time};
use core::time::Duration;

/// Context of a firing: time, stamp and activity.
///
/// ```
/// use apex_rt::prelude::*;
///
/// /// Age of a measurement in s, while the node is active.
/// #[node]
/// fn age(measured: &Time, ctx: &Ctx) -> Option<f64> {
///     ctx.active().then(|| ctx.now().since(*measured).as_secs_f64())
/// }
///
/// // A test can call it without a graph: in a context in which it is not active.
/// let ctx = Ctx::new(Time::from_secs(3));
/// assert_eq!(age(&Time::from_secs(1), &ctx), None);
/// assert_eq!(ctx.now(), Time::from_secs(3));
/// ```
#[derive(Debug, Clone, Copy)]
pub struct Ctx {
    now: Time,
    stamp: Time,
    /// Time of the reaction: later than `now` while it makes up for what is late.
    reaction: Time,
    active: bool,
}

impl Ctx {
    /// Returns the context of a reaction at `now`, for a node that is not active.
    pub const fn new(now: Time) -> Self {
        Self::at(now, now)
    }

    /// Returns the context of the instant `now` of a reaction at `reaction`.
    #[doc(hidden)]
    #[inline(always)]
    pub const fn at(now: Time, reaction: Time) -> Self {
        Self { now, stamp: now, reaction, active: false }
    }

    /// Returns the context of a node that is `active` or not.
    #[doc(hidden)]
    #[inline(always)]
    pub const fn of_node(self, active: bool) -> Self {
        Self { active, ..self }
    }

    /// Returns the context of a firing whose oldest token descends from a source that fired at `stamp`.
    #[doc(hidden)]
    #[inline(always)]
    pub const fn since(self, stamp: Time) -> Self {
        Self { stamp, ..self }
    }

    /// Returns the context of a firing whose tokens descend from sources that fired at these `stamps`.
    #[doc(hidden)]
    #[inline(always)]
    pub fn since_oldest<const N: usize>(self, stamps: [Time; N]) -> Self {
        self.since(stamps.into_iter().fold(self.now, Time::min))
    }

    /// Returns the firing time of the source from which the oldest token of this firing descends; for a source, the
    /// current time. It is earlier than [`now`](Self::now) if a token had to wait on its way.
    #[inline(always)]
    pub const fn stamp(&self) -> Time {
        self.stamp
    }

    /// Returns `true` if the node is active (thesis eq. 7.1). Tokens that this firing takes are already accounted for.
    #[inline(always)]
    pub const fn active(&self) -> bool {
        self.active
    }

    /// Returns the logical time of this instant. A late reaction consists of all instants that have passed.
    #[inline(always)]
    pub const fn now(&self) -> Time {
        self.now
    }

    /// Returns the time by which this instant is late: zero, unless the program has fallen behind its clock.
    #[inline(always)]
    pub const fn behind(&self) -> Duration {
        self.reaction.since(self.now)
    }

    /// Returns `true` if node `node` has finished later than its `deadline` allows, and reports that to the observer.
    #[doc(hidden)]
    pub fn is_late<O: Observer>(&self, node: usize, deadline: Duration, observer: &mut O) -> bool {
        let age = self.reaction.since(self.stamp).saturating_add(elapsed(observer));
        let late = age > deadline;
        if late {
            observer.late(node, age);
        }
        late
    }
}

/// Returns the time since the beginning of the reaction; in a replay, the recorded one.
#[inline(always)]
fn elapsed<O: Observer>(observer: &mut O) -> Duration {
    let elapsed = observer.elapsed();
    #[cfg(feature = "record")]
    let elapsed = match observer.tap() {
        Some(tap) => tap.elapsed(elapsed),
        None => elapsed,
    };
    elapsed
}
