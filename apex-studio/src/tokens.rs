//! The tokens of a port, as far as a page asked for them.

use std::collections::VecDeque;

/// Number of tokens of a channel that are kept, and their maximum length as text in bytes.
const MAX_TOKENS: usize = 20_000;
const MAX_TEXT: usize = 4 << 20;

/// The newest tokens of a channel, as time in ns and text.
#[derive(Default)]
pub struct Tokens {
    /// Number of all tokens so far.
    pub count: u64,
    pub newest: VecDeque<(i64, String)>,
    /// Length of these texts in bytes.
    length: usize,
    /// The newest token as a message in CDR; empty if it is not known.
    pub bytes: Vec<u8>,
}

impl Tokens {
    /// Adds a token, as text and as a message in CDR.
    pub fn push(&mut self, now: i64, text: String, bytes: Vec<u8>) {
        self.count += 1;
        self.bytes = bytes;
        self.length += text.len();
        self.newest.push_back((now, text));
        while (self.newest.len() > MAX_TOKENS || self.length > MAX_TEXT)
            && let Some((_, text)) = self.newest.pop_front()
        {
            self.length -= text.len();
        }
    }

    /// The last token that was sent at a time in ns, as text.
    pub fn at(&self, time: i64) -> Option<&str> {
        let end = self.newest.partition_point(|(at, _)| *at <= time);
        let (at, text) = self.newest.get(end.checked_sub(1)?)?;
        (*at == time).then_some(text)
    }

    /// Forgets the tokens after a time in ns.
    pub fn take_back(&mut self, now: i64) {
        let before = self.newest.len();
        self.newest.retain(|(at, _)| *at <= now);
        if self.newest.len() < before {
            self.bytes.clear();
        }
        self.length = self.newest.iter().map(|(_, text)| text.len()).sum();
        self.count = self.newest.len() as u64;
    }
}
