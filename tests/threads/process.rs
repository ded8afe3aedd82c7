//! This test as another process.
#![cfg(unix)]

use std::{
    env,
    io::{self, BufRead as _, BufReader, Lines, PipeReader, Result},
    process::{Child, Command},
};

/// A process that is killed when the value is dropped.
pub struct Killed(pub Child);

impl Drop for Killed {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// Starts this test again, to run the ignored test `name` only. Returns the process and the lines that it writes,
/// errors too.
pub fn again(name: &str, variables: &[(&str, &str)]) -> (Killed, Lines<BufReader<PipeReader>>) {
    let own = env::current_exe().expect("the test runs");
    let (reads, writes) = io::pipe().expect("there is a pipe");
    let child = Command::new(own)
        .args(["--ignored", "--exact", name, "--nocapture", "--test-threads=1"])
        .envs(variables.iter().copied())
        .stdout(writes.try_clone().expect("it has two ends"))
        .stderr(writes)
        .spawn();
    (Killed(child.expect("the test runs again")), BufReader::new(reads).lines())
}

/// Reads lines until one `is_it`.
pub fn read_until(lines: &mut impl Iterator<Item = Result<String>>, is_it: impl Fn(&str) -> bool) {
    let found = lines.any(|read| is_it(&read.expect("it writes text")));
    assert!(found, "it ended before");
}

/// Sends a signal, such as `INT`.
pub fn send(child: &Killed, signal: &str) {
    let id = child.0.id().to_string();
    let sent = Command::new("kill").args([&format!("-{signal}"), &id]).status().expect("there is `kill`");
    assert!(sent.success());
}
