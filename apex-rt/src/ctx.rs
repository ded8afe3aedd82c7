use crate::Time;

/// What a node may ask about the firing it is in.
#[derive(Debug, Clone, Copy)]
pub struct Ctx {
    now: Time,
    active: bool,
}

impl Ctx {
    /// The context of a reaction at `now`.
    pub const fn new(now: Time) -> Self {
        Self { now, active: false }
    }

    /// The same for a node that is `active` or not.
    #[doc(hidden)]
    #[inline(always)]
    pub const fn of_node(self, active: bool) -> Self {
        Self { active, ..self }
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
}
