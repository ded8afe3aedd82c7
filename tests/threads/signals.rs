//! Effect of Ctrl-C on a driven program: this test starts itself as another process, which hangs.
#![cfg(unix)]

use apex_macros::graph;
use apex_rt::{UntilStopped, drive, prelude::*};
use std::{
    env,
    io::{BufRead as _, BufReader, Write as _},
    process::{Child, Command, Stdio},
    thread,
};

/// Output of the other process when it hangs.
const HANGS: &str = "it hangs";
/// Output of the other process after the first signal, while it still hangs.
const ASKED: &str = "it was asked";

/// Hangs until the process is killed.
#[node]
#[derive(Default)]
pub struct Never;

#[node]
impl Never {
    fn process(&mut self) {
        say(HANGS);
        loop {
            thread::park();
        }
    }
}

graph! {
    use crate::signals::Never;

    graph Hung {
        node never = Never() every 1ms;
        node other = Never() after 1h on other;
    }
}

fn say(what: &str) {
    let mut out = std::io::stdout();
    writeln!(out, "{what}").and_then(|()| out.flush()).expect("somebody listens");
}

#[test]
#[ignore = "it hangs: `a_second_signal_ends_a_program_that_hangs` runs it as a process"]
fn hangs() {
    let clock = UntilStopped::ctrl_c(WallClock::new()).expect("the signals are free");
    // The group `other` sleeps for an hour, and ends after the first signal, which `Drop` reports.
    let ends = thread::spawn(move || {
        let _ = drive(OnlyOther::new(), clock);
        say(ASKED);
    });
    drive(Hung::new(), clock);
    let _ = ends.join();
}

graph! {
    use apex_nodes::flow::tick;

    graph OnlyOther {
        node later = tick() after 1h;
    }
}

/// Reads lines of the process until one is `line`.
fn wait_for(line: &str, lines: &mut impl Iterator<Item = std::io::Result<String>>) {
    let found = lines.any(|read| read.expect("it writes text").ends_with(line));
    assert!(found, "it said nothing of `{line}`");
}

/// A process that is killed when the value is dropped.
struct Killed(Child);

impl Drop for Killed {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

fn interrupt(child: &Killed) {
    let id = child.0.id().to_string();
    let sent = Command::new("kill").args(["-INT", &id]).status().expect("there is `kill`");
    assert!(sent.success());
}

#[test]
fn a_second_signal_ends_a_program_that_hangs() {
    let own = env::current_exe().expect("the test runs");
    let child = Command::new(own)
        .args(["--ignored", "--exact", "signals::hangs", "--nocapture", "--test-threads=1"])
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn();
    let mut child = Killed(child.expect("the test runs again"));
    let mut lines = BufReader::new(child.0.stdout.take().expect("it is piped")).lines();
    wait_for(HANGS, &mut lines);
    interrupt(&child);
    wait_for(ASKED, &mut lines);
    interrupt(&child);
    let status = child.0.wait().expect("it ends");
    assert_eq!(status.code(), Some(130));
}
