use crate::Time;

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
