//! Cells between thread groups, which are run in turn.

use crate::Value;
use apex_dsl::threads;
use apex_rt::Time;

/// Token on its way to another group.
pub struct Parcel {
    /// The token; `None` is ⊥.
    pub token: Option<Value>,
    /// It carries activity.
    pub active: bool,
    /// Time at which its source fired.
    pub stamp: Time,
}

/// State of a cell.
pub enum Content {
    /// A token can be put in.
    Free,
    /// A token waits.
    Full(Parcel),
    /// The receiver has taken the token, and is not done with it.
    Taken,
}

/// All cells of a program, and the groups that have to poll theirs.
pub struct Cells<'a> {
    pub ends: &'a [threads::Cell],
    pub contents: Vec<Content>,
    pub woken: Vec<bool>,
}

impl<'a> Cells<'a> {
    /// Empty cells between `groups` groups.
    pub fn new(ends: &'a [threads::Cell], groups: usize) -> Self {
        Self { ends, contents: ends.iter().map(|_| Content::Free).collect(), woken: vec![false; groups] }
    }

    /// Wakes all groups.
    pub fn wake_all(&mut self) {
        self.woken.fill(true);
    }

    /// Returns `true` if a group has been woken since the last call.
    pub fn take_woken(&mut self, group: usize) -> bool {
        std::mem::take(&mut self.woken[group])
    }

    /// Returns `true` if a group is awake.
    pub fn any_woken(&self) -> bool {
        self.woken.iter().any(|woken| *woken)
    }
}
