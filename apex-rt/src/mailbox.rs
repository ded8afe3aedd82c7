/// Storage for one token at a graph-level input, slot or event.
///
/// As in every connection, there is at most one token and nothing is ever overwritten. The sender of an event is held
/// back until the token in the mailbox has been taken.
#[derive(Debug, Clone)]
pub struct Mailbox<T> {
    token: Option<T>,
}

impl<T> Mailbox<T> {
    /// Returns an empty mailbox.
    pub const fn new() -> Self {
        Self { token: None }
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
        Ok(())
    }

    /// Returns the token in the mailbox.
    pub const fn peek(&self) -> Option<&T> {
        self.token.as_ref()
    }

    /// Returns `true` if there is a token in the mailbox.
    pub const fn is_full(&self) -> bool {
        self.token.is_some()
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
