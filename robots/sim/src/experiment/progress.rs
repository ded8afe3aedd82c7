use std::io::{IsTerminal as _, Write as _};

/// Shows the progress in one line on standard error, if that is a terminal.
#[derive(Debug)]
pub struct Progress(bool);

/// Shows the progress if standard error is a terminal.
impl Default for Progress {
    fn default() -> Self {
        Self(std::io::stderr().is_terminal())
    }
}

impl Progress {
    /// Shows the finished part of the work.
    pub fn step(&self, what: &str, done: u64, of: u64) {
        self.show(&format!("{what}: {done} of {of}"));
    }

    /// Erases the line.
    pub fn clear(&self) {
        self.show("");
    }

    fn show(&self, line: &str) {
        if self.0 {
            let mut terminal = std::io::stderr();
            // Failing to show the line is not a reason to stop. The previous line is erased.
            let _ = write!(terminal, "\r\x1b[K{line}").and_then(|()| terminal.flush());
        }
    }
}
