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
pub use watch::Felt;

#[cfg(feature = "std")]
pub use drive::{Pace, drive_on_threads, react_on_threads};

/// A token on its way from one thread group to another, with what goes with it.
#[derive(Debug)]
pub struct Parcel<T> {
    /// The token; `None` is ⊥.
    pub token: Option<T>,
    /// It carries activity.
    pub active: bool,
    /// When the source fired that it descends from.
    pub stamp: Time,
}

impl<T> Parcel<T> {
    /// An empty one.
    pub const fn new() -> Self {
        Self { token: None, active: false, stamp: Time::ZERO }
    }
}

impl<T> Default for Parcel<T> {
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

/// Remembers which groups were woken: for groups that run one after the other on one thread.
#[derive(Debug, Default)]
pub struct Woken(Cell<u64>);

impl Woken {
    /// All `groups` of a program are awake: it starts.
    pub const fn all(groups: usize) -> Self {
        Self(Cell::new(if groups < 64 { (1 << groups) - 1 } else { u64::MAX }))
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

impl Wake for Woken {
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

/// Takes the thread groups of a program, to run each of them.
pub trait Spawn<'a> {
    /// Takes a group that may run on any thread.
    fn spawn<G: Group + Send + 'a>(&mut self, group: usize, part: G);

    /// Takes the way to tell group `group` that a node hangs: it comes before all groups.
    fn watch(&mut self, group: usize, hung: crate::CellSender<'a, Parcel<()>>);

    /// Takes the main group, which stays where it is: it comes last.
    fn stay<G: Group + 'a>(&mut self, group: usize, part: G);
}

/// A program that is a single group.
#[derive(Debug)]
pub struct Alone<'a, P>(pub &'a mut P);

impl<P: Program> Program for Alone<'_, P> {
    const INFO: crate::Info = P::INFO;

    fn react_with<O: Observer>(&mut self, now: Time, observer: &mut O) -> crate::Next {
        self.0.react_with(now, observer)
    }
}

impl<P: Program> Group for Alone<'_, P> {
    fn react_part<O: Observer>(&mut self, now: Time, begins: bool, observer: &mut O) -> crate::Next {
        if begins { self.0.react_with(now, observer) } else { crate::Next::Input }
    }
}

/// Rounds between groups that may follow on one another while the time stands still.
pub const MAX_ROUNDS: u32 = 1_000_000;
