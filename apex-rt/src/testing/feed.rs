//! Tokens that a test feeds.

use crate::Time;
use core::time::Duration;

/// Times of the tokens of a `feed` statement.
pub enum Times {
    /// One every period, if there is one. A single token with a period is repeated.
    Every {
        /// Number of tokens.
        tokens: usize,
        period: Option<Duration>,
    },
    /// Those of a recording, from its beginning.
    At(Time, Vec<Duration>),
}

/// The `feed` statement of some tokens.
pub struct Feed {
    /// Number of `feed` statements before this one.
    pub number: usize,
    /// Port of the program.
    port: &'static str,
    /// Place of the statement.
    pub place: &'static str,
    /// Time of the next token.
    pub due: Time,
    /// Number of tokens that were put in.
    count: usize,
    times: Times,
}

impl Feed {
    /// Returns a feed whose first token is due at `due`.
    pub fn new(number: usize, (port, place): (&'static str, &'static str), due: Time, times: Times) -> Self {
        Self { number, port, place, due, count: 0, times }
    }

    /// Key that sorts feeds: by the times of their next tokens, and those of one time by their statements.
    pub fn order(&self) -> (Time, usize) {
        (self.due, self.number)
    }

    /// Returns the number of the next token among those of the statement.
    pub fn next(&self) -> usize {
        if matches!(self.times, Times::Every { tokens: 1, .. }) { 0 } else { self.count }
    }

    /// Takes note that the next token was put in. Returns `false` if it was the last one.
    pub fn is_put(&mut self) -> bool {
        self.count += 1;
        let due = match &self.times {
            Times::Every { tokens, period } => {
                period.filter(|_| *tokens == 1 || self.count < *tokens).map(|period| self.due + period)
            }
            Times::At(start, times) => times.get(self.count).map(|time| *start + *time),
        };
        self.due = due.unwrap_or(self.due);
        due.is_some()
    }

    /// Returns `true` for a recording or a value that is repeated: it may go on after the test.
    fn is_open(&self) -> bool {
        match self.times {
            Times::Every { tokens, period } => tokens == 1 && period.is_some(),
            Times::At(..) => true,
        }
    }

    /// Returns `true` if `next`, which begins now, takes the place of this feed: both go on without an end.
    pub fn is_replaced_by(&self, next: &Self) -> bool {
        self.is_open() && next.is_open() && self.port == next.port
    }

    /// The message that a token which was due by `now` was never put in; `None` if none is missing. `ended` is the time
    /// at which the program ended, if it did.
    pub fn left(&self, now: Time, ended: Option<Time>) -> Option<String> {
        let why = match ended {
            Some(_) if self.is_open() => return None,
            Some(time) => format!("the program ended at {time}"),
            None if self.due <= now => "the program has not taken the one before".to_owned(),
            None => return None,
        };
        let (number, port, due) = (self.count + 1, self.port, self.due);
        Some(format!("token {number} for `{port}`, due at {due}, was never put in: {why}"))
    }
}
