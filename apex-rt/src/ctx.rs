use crate::Time;

/// What a node may ask about the firing it is in.
#[derive(Debug, Clone, Copy)]
pub struct Ctx {
    now: Time,
}

impl Ctx {
    /// The context of a reaction at `now`.
    pub const fn new(now: Time) -> Self {
        Self { now }
    }

    /// The logical time of this reaction. It stands still until the graph is quiet.
    #[inline(always)]
    pub const fn now(&self) -> Time {
        self.now
    }
}
