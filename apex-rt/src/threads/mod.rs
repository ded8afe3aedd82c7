//! Programs with several thread groups: exchange between the groups, and their parallel execution.

#[cfg(feature = "std")]
mod drive;
#[cfg(feature = "std")]
mod idle;
#[cfg(feature = "std")]
mod settings;
#[cfg(feature = "std")]
mod watch;

use crate::{
    Observer, Parameters, Program, Time,
    params::{ParamInfo, ParamVisitor},
};
use core::cell::Cell;

#[cfg(feature = "std")]
#[doc(hidden)]
pub use watch::WatchdogObserver;

#[cfg(feature = "std")]
pub(crate) use drive::drive_from_threads;
#[cfg(feature = "std")]
pub use drive::{Pace, drive_on_threads, react_on_threads};

/// A token between two thread groups, with its stamp and activity.
#[derive(Debug)]
#[doc(hidden)]
pub struct CellMessage<T> {
    /// The token; `None` is ⊥.
    pub token: Option<T>,
    /// `true` if the token carries activity.
    pub active: bool,
    /// Firing time of the source from which the token descends.
    pub stamp: Time,
}

impl<T> CellMessage<T> {
    /// Returns a parcel without a token.
    pub const fn new() -> Self {
        Self { token: None, active: false, stamp: Time::ZERO }
    }
}

impl<T> Default for CellMessage<T> {
    fn default() -> Self {
        Self::new()
    }
}

/// Wakes thread groups, by number, when a token has come for them or has been taken from them.
#[doc(hidden)]
pub trait Wake {
    /// Wakes group `group`, because there is something to react to.
    fn wake(&self, group: usize);
}

impl<W: Wake> Wake for &W {
    fn wake(&self, group: usize) {
        (**self).wake(group);
    }
}

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

/// A part of a program that runs on one thread.
#[doc(hidden)]
pub trait Group: Program {
    /// Reacts at `now`. Sources without a period fire only if `begins` is `true`: the reaction then begins, instead of
    /// continuing because of actions of other groups.
    fn react_part<O: Observer>(&mut self, now: Time, begins: bool, observer: &mut O) -> crate::Next;
}

/// Runner of the thread groups of a program with the mailboxes `I` and `E`. Each group is passed to it.
#[doc(hidden)]
pub trait Spawn<'a, I, E> {
    /// Runs a group on any thread.
    fn spawn<G: Group + Send + 'a>(&mut self, group: usize, part: G);

    /// Takes the cell that reports hanging nodes to group `group`. Called before the other methods.
    fn watch(&mut self, group: usize, hung: crate::CellSender<'a, CellMessage<()>>);

    /// Runs the main group, which has the ports of the program, on the current thread. Called last.
    fn stay<G: Group<Inputs = I, Events = E> + 'a>(&mut self, group: usize, part: G);
}

/// A program with a single group.
#[derive(Debug)]
#[doc(hidden)]
pub struct SingleGroup<'a, P>(pub &'a mut P);

impl<P: Program> Parameters for SingleGroup<'_, P> {
    const PARAMS: &'static [ParamInfo] = P::PARAMS;

    fn visit_params(&mut self, visitor: &mut dyn ParamVisitor) {
        self.0.visit_params(visitor);
    }
}

impl<P: Program> Program for SingleGroup<'_, P> {
    const INFO: crate::Info = P::INFO;
    type Inputs = P::Inputs;
    type Events = P::Events;

    fn react_with<O: Observer>(&mut self, now: Time, observer: &mut O) -> crate::Next {
        self.0.react_with(now, observer)
    }

    fn mailboxes(&mut self) -> (&mut P::Inputs, &mut P::Events) {
        self.0.mailboxes()
    }

    fn untaken(&self) -> Option<(&'static str, crate::Arrival)> {
        self.0.untaken()
    }
}

impl<P: Program> Group for SingleGroup<'_, P> {
    fn react_part<O: Observer>(&mut self, now: Time, begins: bool, observer: &mut O) -> crate::Next {
        if begins { self.0.react_with(now, observer) } else { crate::Next::Input }
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
