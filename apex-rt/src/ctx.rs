use crate::{Observer, Time};
use core::time::Duration;

/// What a node may ask about the firing it is in.
#[derive(Debug, Clone, Copy)]
pub struct Ctx {
    now: Time,
    stamp: Time,
    active: bool,
}

impl Ctx {
    /// The context of a reaction at `now`.
    pub const fn new(now: Time) -> Self {
        Self { now, stamp: now, active: false }
    }

    /// The same for a node that is `active` or not.
    #[doc(hidden)]
    #[inline(always)]
    pub const fn of_node(self, active: bool) -> Self {
        Self { active, ..self }
    }

    /// The same for a firing whose oldest token descends from a source that fired at `stamp`.
    #[doc(hidden)]
    #[inline(always)]
    pub const fn since(self, stamp: Time) -> Self {
        Self { stamp, ..self }
    }

    /// When the source fired that the oldest token of this firing descends from; for a source, now. Earlier than
    /// [`now`](Self::now) if a token had to wait on its way.
    #[inline(always)]
    pub const fn stamp(&self) -> Time {
        self.stamp
    }

    /// Whether the node is active (thesis eq. 7.1). Tokens that it takes in this firing have already counted.
    #[inline(always)]
    pub const fn active(&self) -> bool {
        self.active
    }

    /// The logical time of this reaction. It stands still until the graph is quiet.
    #[inline(always)]
    pub const fn now(&self) -> Time {
        self.now
    }

    /// Whether node `node` has finished later than its `deadline` allows, which the observer is told.
    #[doc(hidden)]
    pub fn is_late<O: Observer>(&self, node: usize, deadline: Duration, observer: &mut O) -> bool {
        let age = self.now.since(self.stamp).saturating_add(elapsed(observer));
        let late = age > deadline;
        if late {
            observer.late(node, age);
        }
        late
    }
}

/// How long the reaction has been going on; in a replay, what it was then.
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
