use std::io::{IsTerminal as _, Write as _};

/// Keeps a line about what is done up to date on standard error, if that is a terminal.
#[derive(Debug)]
pub struct Progress(bool);

/// Looks at what standard error is.
impl Default for Progress {
    fn default() -> Self {
        Self(std::io::stderr().is_terminal())
    }
}

impl Progress {
    /// Says how much of something is done.
    pub fn step(&self, what: &str, done: u64, of: u64) {
        self.show(&format!("{what}: {done} of {of}"));
    }

    /// Takes the line away.
    pub fn clear(&self) {
        self.show("");
    }

    fn show(&self, line: &str) {
        if self.0 {
            let mut terminal = std::io::stderr();
            // A line that cannot be shown is no reason to stop. What was there before is erased.
            let _ = write!(terminal, "\r\x1b[K{line}").and_then(|()| terminal.flush());
        }
    }
}
