/// An event that a node may trigger at most once per firing: it is passed by value, and [`Event::emit`] consumes it.
///
/// ```
/// use apex_rt::{event, prelude::*};
///
/// /// Reports a change of sign.
/// #[node]
/// fn crossing(from: &f64, to: &f64, crossed: Event<f64>) {
///     if from * to < 0.0 {
///         crossed.emit(to - from);
///     }
/// }
///
/// // A test can call it without a graph: the token of the event comes into `token`.
/// let mut token = None;
/// crossing(&-1.0, &2.0, event(&mut token));
/// assert_eq!(token, Some(3.0));
/// ```
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

/// Returns an event whose token is put into `slot`: for tests of nodes without a graph.
///
/// ```
/// let mut token = None;
/// apex_rt::event(&mut token).emit(5);
/// assert_eq!(token, Some(5));
/// ```
pub const fn event<T>(slot: &mut Option<T>) -> Event<'_, T> {
    Event { slot: Some(slot) }
}
