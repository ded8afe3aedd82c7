//! Errors in graph files.

/// An error in a graph file.
#[derive(Debug, PartialEq)]
pub struct Wrong {
    /// Line, counted from 1.
    pub line: usize,
    /// Message.
    pub message: String,
}

impl Wrong {
    /// An error in a line.
    pub fn new(line: usize, message: impl Into<String>) -> Self {
        Self { line, message: message.into() }
    }
}
