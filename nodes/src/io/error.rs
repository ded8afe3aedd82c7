use std::{
    fmt,
    path::{Path, PathBuf},
};

/// Error of a file, or of one line of it, that cannot be read.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ReadError {
    /// Path of the file.
    pub path: PathBuf,
    /// Line number, counted from 1, or `None` if the file could not be opened.
    pub line: Option<usize>,
    /// Description of the error.
    pub message: String,
}

impl ReadError {
    pub(crate) fn open(path: &Path, message: impl fmt::Display) -> Self {
        Self { path: path.into(), line: None, message: message.to_string() }
    }
}

impl fmt::Display for ReadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:", self.path.display())?;
        if let Some(line) = self.line {
            write!(f, "{line}:")?;
        }
        write!(f, " {}", self.message)
    }
}

impl std::error::Error for ReadError {}
