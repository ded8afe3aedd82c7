/// An event that a node may trigger at most once per firing: it is passed by value, and [`Event::emit`] consumes it.
#[derive(Debug)]
pub struct Event<'a, T> {
    slot: Option<&'a mut Option<T>>,
}

impl<'a, T> Event<'a, T> {
    /// Returns an event without connections.
    #[doc(hidden)]
    pub const fn unconnected() -> Self {
        Self { slot: None }
    }

    /// Returns the same event, for one of several places that may trigger it.
    #[doc(hidden)]
    pub const fn by_ref(&mut self) -> Event<'_, T> {
        match &mut self.slot {
            Some(slot) => Event { slot: Some(slot) },
            None => Event { slot: None },
        }
    }

    /// Triggers the event with `value`.
    pub fn emit(self, value: T) {
        if let Some(slot) = self.slot {
            *slot = Some(value);
        }
    }
}

/// Returns an event whose token is put into `slot`.
#[doc(hidden)]
pub const fn event<T>(slot: &mut Option<T>) -> Event<'_, T> {
    Event { slot: Some(slot) }
}
