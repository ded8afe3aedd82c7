//! Tokens that a test feeds.

use crate::Time;

/// Result of putting a token in.
pub enum Fed {
    /// The token before is still there.
    NoRoom,
    /// It was put in, and the next one is due at this time.
    Next(Time),
    /// It was put in, and was the last one.
    Last,
}

/// Function that puts in the token that is due at a time.
type Put<P> = Box<dyn FnMut(&mut P, Time) -> Fed>;

/// The tokens of one `feed` statement.
pub struct Feed<P> {
    /// Number of `feed` statements before this one.
    number: usize,
    /// Port of the program.
    port: &'static str,
    /// Place of the statement.
    pub place: &'static str,
    /// Time of the next token.
    pub due: Time,
    /// Number of tokens that were put in.
    count: u64,
    /// `true` for a recording or a value that is repeated: it may go on after the test.
    is_open: bool,
    put: Put<P>,
}

impl<P> Feed<P> {
    /// Returns a feed whose first token is due at `due`; `put` puts in the token that is due at a time.
    pub fn new(
        number: usize,
        (port, place): (&'static str, &'static str),
        due: Time,
        put: impl FnMut(&mut P, Time) -> Fed + 'static,
    ) -> Self {
        Self { number, port, place, due, count: 0, is_open: false, put: Box::new(put) }
    }

    /// Key that sorts feeds: by the times of their next tokens, and those of one time by their statements.
    pub fn order(&self) -> (Time, usize) {
        (self.due, self.number)
    }

    /// Puts the next token in, if there is room.
    pub fn put(&mut self, program: &mut P) -> Fed {
        let fed = (self.put)(program, self.due);
        if let Fed::Next(due) = fed {
            self.due = due;
        }
        self.count += u64::from(!matches!(fed, Fed::NoRoom));
        fed
    }

    /// Returns the feed as one that may go on after the test.
    pub fn open(self) -> Self {
        Self { is_open: true, ..self }
    }

    /// Returns `true` if `next`, which begins now, takes the place of this feed: both go on without an end.
    pub fn is_replaced_by(&self, next: &Self) -> bool {
        self.is_open && next.is_open && self.port == next.port
    }

    /// The message that a token which was due by `now` was never put in; `None` if none is missing. `ended` is the time
    /// at which the program ended, if it did.
    pub fn left(&self, now: Time, ended: Option<Time>) -> Option<String> {
        let why = match ended {
            Some(_) if self.is_open => return None,
            Some(time) => format!("the program ended at {time}"),
            None if self.due <= now => "the program has not taken the one before".to_owned(),
            None => return None,
        };
        let (number, port, due) = (self.count + 1, self.port, self.due);
        Some(format!("token {number} for `{port}`, due at {due}, was never put in: {why}"))
    }
}
