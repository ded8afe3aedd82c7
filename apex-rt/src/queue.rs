//! What waits for its turn: slot tokens, and how many steps a reaction may take.

/// The slot tokens that wait, in the order in which they were emitted. Each of the `N` connections to slots holds
/// at most one token, so that there is room for all.
#[derive(Debug, Clone)]
pub struct Queue<const N: usize> {
    waiting: [u16; N],
    start: usize,
    len: usize,
}

impl<const N: usize> Queue<N> {
    /// An empty queue.
    pub const fn new() -> Self {
        Self { waiting: [0; N], start: 0, len: 0 }
    }

    /// The token for `slot` was emitted.
    #[inline(always)]
    pub fn push(&mut self, slot: u16) {
        self.waiting[(self.start + self.len) % N] = slot;
        self.len += 1;
    }

    /// Whether no token waits.
    #[inline(always)]
    pub const fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// Takes the first token out whose slot `is_ready`; the others keep their places.
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
}

impl<const N: usize> Default for Queue<N> {
    fn default() -> Self {
        Self::new()
    }
}

/// How many steps a reaction may still take, in programs whose tokens can go round for ever without time passing.
#[derive(Debug, Clone)]
pub struct Steps<const N: usize> {
    budget: u32,
    left: u32,
    counts: [u32; N],
}

impl<const N: usize> Steps<N> {
    /// So many steps of a reaction are taken as the sign of an endless loop, unless the program says otherwise.
    pub const BUDGET: u32 = 1_000_000;
    /// So many of the last steps are counted, to tell what goes round.
    const WATCHED: u32 = 1_000;

    /// The full budget.
    pub const fn new() -> Self {
        Self { budget: Self::BUDGET, left: Self::BUDGET, counts: [0; N] }
    }

    /// Sets how many steps a reaction may take, at least one.
    pub fn set_budget(&mut self, steps: u32) {
        self.budget = if steps == 0 { 1 } else { steps };
    }

    /// A reaction begins.
    #[inline(always)]
    pub fn begin(&mut self) {
        self.left = self.budget;
    }

    /// Whether the budget is used up.
    #[inline(always)]
    pub const fn is_used_up(&self) -> bool {
        self.left == 0
    }

    /// Step number `kind` is taken.
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

    /// How often each kind of step was taken towards the end of a reaction that used up its budget. Counts anew then.
    pub fn counts(&mut self) -> [u32; N] {
        core::mem::replace(&mut self.counts, [0; N])
    }
}

impl<const N: usize> Default for Steps<N> {
    fn default() -> Self {
        Self::new()
    }
}
