//! Errors in words.

use std::fmt;

/// Reason why something cannot be done, in words: what, where, why, and how to fix it.
#[derive(Clone, PartialEq, Eq)]
pub struct Error {
    text: String,
    is_passing: bool,
}

impl Error {
    /// Returns the error with this text.
    pub fn new(text: impl Into<String>) -> Self {
        Self { text: text.into(), is_passing: false }
    }

    /// Returns the error of something that may go well the next time.
    pub(crate) fn passing(text: impl Into<String>) -> Self {
        Self { is_passing: true, ..Self::new(text) }
    }

    /// Returns `true` if the same may go well the next time.
    pub(crate) fn is_passing(&self) -> bool {
        self.is_passing
    }

    /// Returns the error of Zenoh in doing `what`.
    #[cfg(feature = "zenoh")]
    pub(crate) fn zenoh(what: &str) -> impl FnOnce(zenoh::Error) -> Self {
        move |error| Self::new(format!("{what}: Zenoh: {error}"))
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

/// The text: `main` may return the error.
impl fmt::Debug for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

impl std::error::Error for Error {}
