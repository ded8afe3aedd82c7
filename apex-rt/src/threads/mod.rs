//! Programs whose nodes run in several thread groups: what passes between the groups, and how they run side by side.

#[cfg(feature = "std")]
mod drive;
#[cfg(feature = "std")]
mod idle;
#[cfg(feature = "std")]
mod settings;
#[cfg(feature = "std")]
mod watch;

use crate::{Observer, Program, Time};
use core::cell::Cell;

#[cfg(feature = "std")]
pub use watch::WatchdogObserver;

#[cfg(feature = "std")]
pub(crate) use drive::drive_from_threads;
#[cfg(feature = "std")]
pub use drive::{Pace, drive_on_threads, react_on_threads};

/// A token on its way from one thread group to another, with what goes with it.
#[derive(Debug)]
pub struct CellMessage<T> {
    /// The token; `None` is ⊥.
    pub token: Option<T>,
    /// It carries activity.
    pub active: bool,
    /// When the source fired that it descends from.
    pub stamp: Time,
}

impl<T> CellMessage<T> {
    /// An empty one.
    pub const fn new() -> Self {
        Self { token: None, active: false, stamp: Time::ZERO }
    }
}

impl<T> Default for CellMessage<T> {
    fn default() -> Self {
        Self::new()
    }
}

/// Tells thread groups, by number, that something has come for them, or has been taken from them.
pub trait Wake {
    /// Group `group` has something to look at.
    fn wake(&self, group: usize);
}

impl<W: Wake> Wake for &W {
    fn wake(&self, group: usize) {
        (**self).wake(group);
    }
}

/// The most thread groups that a program can have: each has a bit of [`ReadySet`].
pub const MAX_GROUPS: usize = u64::BITS as usize;

/// Remembers which groups were woken: for groups that run one after the other on one thread.
#[derive(Debug, Default)]
pub struct ReadySet(Cell<u64>);

impl ReadySet {
    /// All `groups` of a program are awake: it starts.
    ///
    /// # Panics
    /// There are more than [`MAX_GROUPS`], which the compiler of texts refuses.
    pub const fn all(groups: usize) -> Self {
        assert!(groups <= MAX_GROUPS, "a program has at most 64 thread groups");
        Self(Cell::new(if groups < MAX_GROUPS { (1 << groups) - 1 } else { u64::MAX }))
    }

    /// Whether a group was woken. It sleeps then.
    pub fn take(&self, group: usize) -> bool {
        let woken = self.0.get();
        self.0.set(woken & !(1 << group));
        woken & 1 << group != 0
    }

    /// Whether none is awake.
    pub fn is_none(&self) -> bool {
        self.0.get() == 0
    }
}

impl Wake for ReadySet {
    fn wake(&self, group: usize) {
        self.0.set(self.0.get() | 1 << group);
    }
}

/// A part of a program that one thread runs.
pub trait Group: Program {
    /// Reacts at `now`. Sources without a pace fire only if a reaction `begins`, not if it goes on because of what other
    /// groups did meanwhile.
    fn react_part<O: Observer>(&mut self, now: Time, begins: bool, observer: &mut O) -> crate::Next;
}

/// Takes the thread groups of a program with the mailboxes `I` and `E`, to run each of them.
pub trait Spawn<'a, I, E> {
    /// Takes a group that may run on any thread.
    fn spawn<G: Group + Send + 'a>(&mut self, group: usize, part: G);

    /// Takes the way to tell group `group` that a node hangs: it comes before all groups.
    fn watch(&mut self, group: usize, hung: crate::CellSender<'a, CellMessage<()>>);

    /// Takes the main group, which has the ports of the program and stays where it is: it comes last.
    fn stay<G: Group<Inputs = I, Events = E> + 'a>(&mut self, group: usize, part: G);
}

/// A program that is a single group.
#[derive(Debug)]
pub struct SingleGroup<'a, P>(pub &'a mut P);

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
}

impl<P: Program> Group for SingleGroup<'_, P> {
    fn react_part<O: Observer>(&mut self, now: Time, begins: bool, observer: &mut O) -> crate::Next {
        if begins { self.0.react_with(now, observer) } else { crate::Next::Input }
    }
}

/// Rounds between groups that may follow on one another while the time stands still.
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
