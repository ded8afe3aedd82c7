//! Queue of slot tokens, and the step budget of a reaction.

use crate::rows::Slot;

/// Numbers of the slots with waiting tokens, in the order in which these were emitted. Each of the `N` connections to
/// slots holds at most one token, so that there is room for all.
#[derive(Debug, Clone)]
pub struct Queue<const N: usize> {
    waiting: [u16; N],
    start: usize,
    len: usize,
}

impl<const N: usize> Queue<N> {
    /// Returns an empty queue.
    pub const fn new() -> Self {
        Self { waiting: [0; N], start: 0, len: 0 }
    }

    /// Adds a token for `slot`.
    #[inline(always)]
    pub fn push(&mut self, slot: u16) {
        self.waiting[(self.start + self.len) % N] = slot;
        self.len += 1;
    }

    /// Returns `true` if no token waits.
    #[inline(always)]
    pub const fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// Takes out the first token whose slot `is_ready`; the others keep their order.
    #[inline(always)]
    pub fn next(&mut self, is_ready: impl Fn(u16) -> bool) -> Option<u16> {
        for at in 0..self.len {
            let slot = self.waiting[(self.start + at) % N];
            if is_ready(slot) {
                for i in (0..at).rev() {
                    self.waiting[(self.start + i + 1) % N] = self.waiting[(self.start + i) % N];
                }
                self.start = (self.start + 1) % N;
                self.len -= 1;
                return Some(slot);
            }
        }
        None
    }

    /// Calls `found` with the connections whose tokens wait for one another, so that none is ever taken, if there are
    /// more than are `known`.
    pub fn stuck(&self, slots: &[Slot; N], known: &mut usize, found: impl FnMut(usize)) {
        let mut left = [u16::MAX; N];
        for (at, slot) in left.iter_mut().enumerate().take(self.len) {
            *slot = self.waiting[(self.start + at) % N];
        }
        loop {
            let waits = |slot: u16| slots[usize::from(slot)].after.iter().any(|other| left.contains(other));
            let free = left.iter().position(|slot| *slot != u16::MAX && !waits(*slot));
            match free {
                Some(free) => left[free] = u16::MAX,
                None => break,
            }
        }
        let stuck = left.into_iter().filter(|slot| *slot != u16::MAX);
        let count = stuck.clone().count();
        if core::mem::replace(known, count) < count {
            stuck.filter_map(|slot| slots[usize::from(slot)].connection).for_each(found);
        }
    }
}

impl<const N: usize> Default for Queue<N> {
    fn default() -> Self {
        Self::new()
    }
}

/// Step budget of a reaction, for programs whose tokens may cycle endlessly without time passing.
#[derive(Debug, Clone)]
pub struct Steps<const N: usize> {
    budget: u32,
    left: u32,
    counts: [u32; N],
}

impl<const N: usize> Steps<N> {
    /// Default budget: a reaction with more steps is taken for an endless loop.
    pub const BUDGET: u32 = 1_000_000;
    /// Number of steps at the end of the budget that are counted by kind, to identify the nodes of an endless loop.
    const WATCHED: u32 = 1_000;

    /// Returns a full budget.
    pub const fn new() -> Self {
        Self { budget: Self::BUDGET, left: Self::BUDGET, counts: [0; N] }
    }

    /// Sets the number of steps that a reaction may take, at least one.
    pub fn set_budget(&mut self, steps: u32) {
        self.budget = if steps == 0 { 1 } else { steps };
    }

    /// Refills the budget when a reaction begins.
    #[inline(always)]
    pub fn begin(&mut self) {
        self.left = self.budget;
    }

    /// Returns `true` if the budget is used up.
    #[inline(always)]
    pub const fn is_used_up(&self) -> bool {
        self.left == 0
    }

    /// Takes one step of this `kind`.
    #[inline(always)]
    pub fn take(&mut self, kind: usize) {
        self.left -= 1;
        if self.left < Self::WATCHED {
            self.count(kind);
        }
    }

    #[cold]
    fn count(&mut self, kind: usize) {
        self.counts[kind] += 1;
    }

    /// Returns how often each kind of step was taken at the end of a reaction that used up its budget, and resets the
    /// counts.
    pub fn counts(&mut self) -> [u32; N] {
        core::mem::replace(&mut self.counts, [0; N])
    }
}

impl<const N: usize> Default for Steps<N> {
    fn default() -> Self {
        Self::new()
    }
}
