//! Storage for tokens at the ports of a program.

#[cfg(target_has_atomic = "32")]
use core::sync::atomic::{AtomicU32, Ordering};

/// Storage for one token at a graph-level input, slot or event.
///
/// As in every connection, there is at most one token and nothing is ever overwritten. The sender of an event is held
/// back until the token in the mailbox has been taken. Tokens in several slots are served in the order in which they
/// were put in.
///
/// ```
/// use apex_rt::prelude::*;
///
/// apex_macros::graph!("examples/count.afg");
///
/// # fn main() {
/// let mut count = Count::new();
/// let tick: &mut Mailbox<()> = &mut count.inputs().tick;
/// assert_eq!([tick.put(()), tick.put(())], [Ok(()), Err(())]);
/// count.react(Time::ZERO);
/// assert_eq!(count.events().count.take(), Some(1));
/// # }
/// ```
#[derive(Debug, Clone)]
pub struct Mailbox<T> {
    token: Option<T>,
    arrival: Arrival,
}

/// Number of a token in the order in which tokens were put into the mailboxes of a program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Arrival(u32);

impl Arrival {
    const NONE: Self = Self(0);

    /// Returns the number of the next token. All programs of a process share the numbers: only their order matters.
    fn next() -> Self {
        #[cfg(target_has_atomic = "32")]
        {
            static COUNT: AtomicU32 = AtomicU32::new(0);
            Self(COUNT.fetch_add(1, Ordering::Relaxed))
        }
        // Without atomic operations the tokens keep the order of the ports.
        #[cfg(not(target_has_atomic = "32"))]
        Self::NONE
    }

    /// Returns `true` if this token was put in before the other one. The numbers may have wrapped around between them.
    const fn is_before(self, other: Self) -> bool {
        self.0.wrapping_sub(other.0) > u32::MAX / 2
    }
}

/// Returns the place of the token that was put in first; of those that came together, the first place.
pub fn first_arrival(arrivals: &[Option<Arrival>]) -> Option<usize> {
    first(arrivals.iter().copied().enumerate()).map(|(place, _)| place)
}

/// Returns the event whose token was put in first, and the number of the token.
pub fn untaken(events: &[(&'static str, Option<Arrival>)]) -> Option<(&'static str, Arrival)> {
    first(events.iter().copied())
}

/// Returns the item whose token was put in first, and the number of the token.
fn first<T>(items: impl Iterator<Item = (T, Option<Arrival>)>) -> Option<(T, Arrival)> {
    let waiting = items.filter_map(|(item, arrival)| Some((item, arrival?)));
    waiting.reduce(|first, next| if next.1.is_before(first.1) { next } else { first })
}

impl<T> Mailbox<T> {
    /// Returns an empty mailbox.
    pub const fn new() -> Self {
        Self { token: None, arrival: Arrival::NONE }
    }

    /// Puts a token in, for a later reaction.
    ///
    /// # Errors
    /// Returns the token if the previous one has not been taken.
    pub fn put(&mut self, token: T) -> Result<(), T> {
        if self.token.is_some() {
            return Err(token);
        }
        self.token = Some(token);
        self.arrival = Arrival::next();
        Ok(())
    }

    /// Returns the token in the mailbox.
    ///
    /// ```
    /// use apex_rt::prelude::*;
    ///
    /// let mut mailbox = Mailbox::new();
    /// assert_eq!(mailbox.peek(), None);
    /// assert_eq!(mailbox.put(7), Ok(()));
    /// assert_eq!((mailbox.peek(), mailbox.is_full()), (Some(&7), true));
    /// ```
    pub const fn peek(&self) -> Option<&T> {
        self.token.as_ref()
    }

    /// Returns `true` if there is a token in the mailbox.
    pub const fn is_full(&self) -> bool {
        self.token.is_some()
    }

    /// Returns the number of the token in the mailbox, if there is one.
    #[doc(hidden)]
    pub fn arrival(&self) -> Option<Arrival> {
        self.token.as_ref().map(|_| self.arrival)
    }

    /// Takes the token out: the graph those of its inputs and slots, its user those of events.
    pub fn take(&mut self) -> Option<T> {
        self.token.take()
    }
}

impl<T> Default for Mailbox<T> {
    fn default() -> Self {
        Self::new()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_token_is_the_one_that_was_put_in_first() {
        let mut mailboxes = [Mailbox::new(), Mailbox::new(), Mailbox::new()];
        for place in [2, 0, 1] {
            assert_eq!(mailboxes[place].put(place), Ok(()));
        }
        let first = |mailboxes: &[Mailbox<usize>]| {
            let arrivals: std::vec::Vec<_> = mailboxes.iter().map(Mailbox::arrival).collect();
            first_arrival(&arrivals)
        };
        for place in [2, 0, 1] {
            assert_eq!(first(&mailboxes), Some(place));
            assert_eq!(mailboxes[place].take(), Some(place));
        }
        assert_eq!(first(&mailboxes), None);
    }

    #[test]
    fn numbers_wrap_around() {
        assert!(Arrival(u32::MAX).is_before(Arrival(0)) && !Arrival(0).is_before(Arrival(u32::MAX)));
        assert!(!Arrival(7).is_before(Arrival(7)));
    }
}
