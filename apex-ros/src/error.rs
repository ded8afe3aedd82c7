//! Errors in words.

use std::fmt;

/// Reason why something cannot be done, in words: what, where, why, and how to fix it.
#[derive(Clone, PartialEq, Eq)]
pub struct Error(String);

impl Error {
    /// Returns the error with this text.
    pub(crate) fn new(text: impl Into<String>) -> Self {
        Self(text.into())
    }

    /// Returns the error of Zenoh in doing `what`.
    pub(crate) fn zenoh(what: &str) -> impl FnOnce(zenoh::Error) -> Self {
        move |error| Self(format!("{what}: Zenoh: {error}"))
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

/// The text: `main` may return the error.
impl fmt::Debug for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for Error {}
