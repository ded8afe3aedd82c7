//! Measurements of checkpoints with any program, given by environment variables:
//! `APEX_MEASURED="target/release/sick-robot-day --minutes 11" cargo test -p apex-tests --test studio -- --ignored
//! --nocapture checkpoints_of_a_program`. `APEX_MEASURED_AT` is the time at which steps back begin, in s.

use crate::{socket, stream::Viewer};
use apex_rt::studio::message::{Command, Report};
use std::{
    env, fs,
    io::Read,
    path::PathBuf,
    process::{self, Child, Stdio},
    thread,
    time::{Duration, Instant},
};

/// A program that is measured, with its viewer.
struct Measured {
    process: Child,
    path: PathBuf,
    viewer: Viewer,
    /// Bytes that have not been looked at.
    came: Vec<u8>,
    reactions: u64,
}

impl Measured {
    fn start(command: &str, keeps: bool) -> Self {
        let path = socket("measured");
        let mut words = command.split_whitespace();
        let mut program = process::Command::new(words.next().expect("a program"));
        program.args(words).env("APEX_STUDIO", &path).env("APEX_STUDIO_WAIT", "1").stdout(Stdio::null());
        let process = program.spawn().expect("it starts");
        let viewer = loop {
            if let Ok(viewer) = Viewer::connect(path.to_str().expect("UTF-8")) {
                break viewer;
            }
            thread::sleep(Duration::from_millis(10));
        };
        let mut measured = Self { process, path, viewer, came: vec![], reactions: 0 };
        measured.greet(keeps);
        measured
    }

    fn greet(&mut self, keeps: bool) {
        self.viewer.tell(&Command::Follow(true));
        self.viewer.tell(&Command::Keep(keeps));
        self.reactions = self.halted();
    }

    /// Reads until the program is halted. Only the messages that matter here are decoded, so that the reader is faster
    /// than the program.
    fn halted(&mut self) -> u64 {
        loop {
            while let Some(length) = self.came.first_chunk::<4>().map(|length| u32::from_le_bytes(*length) as usize) {
                if self.came.len() < length + 4 {
                    break;
                }
                let bytes: Vec<u8> = self.came.drain(..length + 4).collect();
                // The number of the variant: that of `Pace` and those after it.
                if bytes[4] >= 18 {
                    match apex_rt::studio::message::read(&mut &bytes[..]) {
                        Ok(Some(Report::Pace { paused: true, reactions, .. })) => return reactions,
                        Ok(Some(Report::NoCheckpoints(why))) => println!("no checkpoints: {why}"),
                        _ => {}
                    }
                }
            }
            let mut bytes = vec![0; 1 << 20];
            let count = self.viewer.from.read(&mut bytes).expect("the program runs");
            assert!(count > 0, "the program has ended");
            self.came.extend_from_slice(&bytes[..count]);
        }
    }

    /// Runs up to a time in s. Returns the duration.
    fn run_until(&mut self, seconds: f64) -> Duration {
        let start = Instant::now();
        self.viewer.tell(&Command::RunUntil { now: (seconds * 1e9) as i64 });
        self.reactions = self.halted();
        start.elapsed()
    }

    /// Takes the last reaction back. Returns the duration, and the number of reactions that were repeated.
    fn back(&mut self) -> (Duration, u64) {
        let (start, goal) = (Instant::now(), self.reactions - 1);
        self.viewer.tell(&Command::GoBack { reactions: goal });
        let mut bytes = vec![0; 1 << 20];
        while self.viewer.from.read(&mut bytes).is_ok_and(|count| count > 0) {}
        self.viewer = Viewer::connect(self.path.to_str().expect("UTF-8")).expect("it listens");
        self.came.clear();
        self.greet(true);
        let from = self.reactions;
        self.viewer.tell(&Command::RunTo { reactions: goal });
        while self.reactions < goal {
            self.reactions = self.halted();
        }
        (start.elapsed(), goal - from)
    }

    /// Numbers of the program's processes, and their memory in MB: in total, and that of the first one alone.
    fn memory(&self) -> (usize, f64, f64) {
        let line = fs::read(format!("/proc/{}/cmdline", self.process.id())).expect("Linux");
        let all = fs::read_dir("/proc").expect("Linux").flatten();
        let own = all.filter(|process| fs::read(process.path().join("cmdline")).is_ok_and(|other| other == line));
        let megabytes = |path: PathBuf| {
            let text = fs::read_to_string(path.join("smaps_rollup")).unwrap_or_default();
            let value = |name: &str| {
                let found = text.lines().find_map(|line| line.strip_prefix(name)?.split_whitespace().next());
                found.and_then(|kilobytes| kilobytes.parse::<f64>().ok()).unwrap_or(0.0) / 1024.0
            };
            (value("Pss:"), value("Rss:"))
        };
        let each: Vec<(f64, f64)> = own.map(|process| megabytes(process.path())).collect();
        let largest = each.iter().map(|(_, rss)| *rss).fold(0.0, f64::max);
        (each.len(), each.iter().map(|(pss, _)| *pss).sum(), largest)
    }
}

impl Drop for Measured {
    fn drop(&mut self) {
        let _ = self.process.kill();
        let _ = self.process.wait();
        let _ = fs::remove_file(&self.path);
    }
}

#[test]
#[ignore = "measures a program in the environment variable `APEX_MEASURED`"]
fn checkpoints_of_a_program() {
    let Ok(command) = env::var("APEX_MEASURED") else { return };
    let at: f64 = env::var("APEX_MEASURED_AT").map_or(600.0, |at| at.parse().expect("a time in s"));
    let without = Measured::start(&command, false).run_until(at);
    let mut program = Measured::start(&command, true);
    let with = program.run_until(at);
    println!("{at} s of simulated time: {without:.2?} without checkpoints, {with:.2?} with them");
    let (count, all, one) = program.memory();
    println!("{count} processes with {all:.0} MB in total; the largest one has {one:.0} MB");
    let steps: Vec<(Duration, u64)> = (0..10).map(|_| program.back()).collect();
    for (time, repeated) in &steps {
        println!("one reaction back: {time:.0?}, {repeated} reactions repeated");
    }
    let (count, all, _) = program.memory();
    println!("{count} processes with {all:.0} MB in total after that");
}
