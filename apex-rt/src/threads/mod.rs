//! Programs with several thread groups: exchange between the groups, and their parallel execution.

#[cfg(feature = "std")]
mod drive;
#[cfg(feature = "std")]
mod idle;
#[cfg(feature = "std")]
mod pulse;
#[cfg(feature = "std")]
mod settings;
#[cfg(feature = "std")]
mod watch;

use core::cell::Cell;

#[cfg(feature = "std")]
pub use crate::clock::Pace;
#[doc(hidden)]
pub use crate::{
    cell_message::CellMessage,
    program::{Group, SingleGroup, Spawn, Wake},
};

#[cfg(feature = "std")]
#[doc(hidden)]
pub use pulse::WatchdogObserver;

#[cfg(feature = "std")]
pub(crate) use drive::drive_from_threads;
#[cfg(feature = "std")]
pub use drive::{drive_on_threads, react_on_threads};

/// Maximum number of thread groups in a program: each has a bit of [`ReadySet`].
#[doc(hidden)]
pub const MAX_GROUPS: usize = u64::BITS as usize;

/// Set of the groups that were woken, for groups that run in turn on one thread.
#[derive(Debug, Default)]
#[doc(hidden)]
pub struct ReadySet(Cell<u64>);

impl ReadySet {
    /// Returns the set of all `groups`, for the start of a program.
    ///
    /// # Panics
    /// There are more than [`MAX_GROUPS`]; the compiler rejects such programs.
    pub const fn all(groups: usize) -> Self {
        assert!(groups <= MAX_GROUPS, "a program has at most 64 thread groups");
        Self(Cell::new(if groups < MAX_GROUPS { (1 << groups) - 1 } else { u64::MAX }))
    }

    /// Removes a group. Returns `true` if it was woken.
    pub fn take(&self, group: usize) -> bool {
        let woken = self.0.get();
        self.0.set(woken & !(1 << group));
        woken & 1 << group != 0
    }

    /// Returns `true` if no group is awake.
    pub fn is_none(&self) -> bool {
        self.0.get() == 0
    }
}

impl Wake for ReadySet {
    fn wake(&self, group: usize) {
        self.0.set(self.0.get() | 1 << group);
    }
}

/// Maximum number of rounds of all groups in one reaction.
#[doc(hidden)]
pub const MAX_ROUNDS: u32 = 1_000_000;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn as_many_groups_as_there_may_be_are_woken_one_by_one() {
        let woken = ReadySet::all(MAX_GROUPS);
        assert!((0..MAX_GROUPS).all(|group| woken.take(group)));
        assert!(woken.is_none());
        woken.wake(MAX_GROUPS - 1);
        assert!(!woken.take(0) && woken.take(MAX_GROUPS - 1) && woken.is_none());
    }

    #[test]
    #[should_panic(expected = "at most 64 thread groups")]
    fn more_groups_are_refused() {
        ReadySet::all(MAX_GROUPS + 1);
    }
}
