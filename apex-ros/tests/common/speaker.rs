//! Programs in Python that say what they do, line by line.

use super::{Collected, within};
use std::{
    io::{BufRead as _, BufReader, Write as _},
    path::Path,
    process::{Child, ChildStdin, Command, Stdio},
    thread,
};

/// A program, and what it says.
pub struct Speaker {
    child: Child,
    input: ChildStdin,
    pub lines: Collected<String>,
}

impl Speaker {
    /// Starts a script of the folder `tests` with these arguments, and waits until it is ready.
    pub fn start(mut python: Command, script: &str, args: &[&str]) -> Self {
        let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests").join(script);
        // `-B`: what it imports leaves no files beside it.
        python.arg("-B").arg(script).args(args).stdin(Stdio::piped()).stdout(Stdio::piped());
        let mut child = python.spawn().expect("python runs");
        let (input, output) = (child.stdin.take().expect("a pipe"), child.stdout.take().expect("a pipe"));
        let lines = Collected::new();
        let add = lines.collector();
        thread::spawn(move || BufReader::new(output).lines().map_while(Result::ok).for_each(add));
        let speaker = Self { child, input, lines };
        within(20.0, "the peer is ready", || speaker.says("ready"));
        speaker
    }

    pub fn says(&self, start: &str) -> bool {
        self.lines.all().iter().any(|line| line.starts_with(start))
    }

    /// Lets the program do something.
    pub fn hears(&mut self, word: &str) {
        writeln!(self.input, "{word}").expect("it reads");
    }
}

impl Drop for Speaker {
    fn drop(&mut self) {
        drop(self.child.kill());
        drop(self.child.wait());
    }
}
