use std::{
    fmt,
    path::{Path, PathBuf},
};

/// Why a file, or one line of it, could not be read.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ReadError {
    /// The file.
    pub path: PathBuf,
    /// The line, counted from 1; `None` if the file could not be opened.
    pub line: Option<usize>,
    /// What is wrong.
    pub message: String,
}

impl ReadError {
    pub(super) fn open(path: &Path, message: impl fmt::Display) -> Self {
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

/// Why a file could not be written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct WriteError {
    /// The file.
    pub path: PathBuf,
    /// What is wrong.
    pub message: String,
}

impl WriteError {
    pub(super) fn new(path: &Path, message: impl fmt::Display) -> Self {
        Self { path: path.into(), message: message.to_string() }
    }
}

impl fmt::Display for WriteError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.path.display(), self.message)
    }
}

impl std::error::Error for WriteError {}
