/// The way into a graph and out of it: room for one token of a graph-level input, slot or event.
///
/// Like every connection it holds at most one token; nothing is ever overwritten. As long as nobody takes the token
/// of an event, what sends it is held back.
#[derive(Debug, Clone)]
pub struct Mailbox<T> {
    token: Option<T>,
}

impl<T> Mailbox<T> {
    /// An empty mailbox.
    pub const fn new() -> Self {
        Self { token: None }
    }

    /// Puts a token in, to be taken by a following reaction.
    ///
    /// # Errors
    /// Gives the token back while the one before has not been taken.
    pub fn put(&mut self, token: T) -> Result<(), T> {
        if self.token.is_some() {
            return Err(token);
        }
        self.token = Some(token);
        Ok(())
    }

    /// The token that waits in it.
    pub const fn peek(&self) -> Option<&T> {
        self.token.as_ref()
    }

    /// Whether a token waits in it.
    pub const fn is_full(&self) -> bool {
        self.token.is_some()
    }

    /// Takes the token out: the graph does so with what comes in, its user with the events that come out.
    pub fn take(&mut self) -> Option<T> {
        self.token.take()
    }
}

impl<T> Default for Mailbox<T> {
    fn default() -> Self {
        Self::new()
    }
}
