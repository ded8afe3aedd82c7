/// The way into a graph: room for one token of a graph-level input.
///
/// Like every connection it holds at most one token; nothing is ever overwritten.
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

    /// Whether a token waits in it.
    pub const fn is_full(&self) -> bool {
        self.token.is_some()
    }

    /// Called by generated code when the graph takes the token.
    #[doc(hidden)]
    pub fn take(&mut self) -> Option<T> {
        self.token.take()
    }
}

impl<T> Default for Mailbox<T> {
    fn default() -> Self {
        Self::new()
    }
}
