//! Processes that run candidates.

use crate::build::Built;
use apex_tune::Objective;
use std::{
    io::{BufRead as _, BufReader, Write as _},
    path::Path,
    process::{Child, ChildStdin, ChildStdout, Command, Stdio},
    sync::{Mutex, PoisonError},
};

/// Beginning of the lines in which a process answers (`apex_rt::testing`).
const ANSWER: &str = "apex-study: ";

/// A process that runs one candidate at a time.
struct Worker {
    child: Child,
    /// `None` after its end.
    input: Option<ChildStdin>,
    output: BufReader<ChildStdout>,
}

impl Worker {
    fn start(workers: &Workers<'_>) -> Result<(Self, Vec<f64>), String> {
        let mut command = workers.built.command();
        command.args(["--ignored", "--exact", "--nocapture", "--test-threads=1", &workers.test]);
        command.current_dir(workers.folder).env("APEX_STUDY", "1").env("RUST_BACKTRACE", "0");
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::null());
        apart(&mut command);
        let mut child = command.spawn().map_err(|e| workers.built.not_started(&e))?;
        let (input, output) = (child.stdin.take(), child.stdout.take());
        let output = BufReader::new(output.ok_or("the program has no output")?);
        let mut worker = Self { child, input, output };
        let ready = worker.answer().and_then(|answer| numbers(answer.strip_prefix("ready")?));
        Ok((worker, ready.ok_or("the program does not answer: build the package again")?))
    }

    /// The answer to a line; `None` if the process has ended.
    fn ask(&mut self, line: &str) -> Option<String> {
        let input = self.input.as_mut()?;
        input.write_all(line.as_bytes()).and_then(|()| input.flush()).ok()?;
        self.answer()
    }

    fn answer(&mut self) -> Option<String> {
        let mut line = vec![];
        loop {
            line.clear();
            if self.output.read_until(b'\n', &mut line).ok()? == 0 {
                return None;
            }
            // Nodes print, too.
            let text = String::from_utf8_lossy(&line);
            if let Some((_, answer)) = text.split_once(ANSWER) {
                return Some(answer.trim_end().to_owned());
            }
        }
    }
}

impl Drop for Worker {
    fn drop(&mut self) {
        self.input = None;
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Makes a process that Ctrl-C in the terminal does not end: a run that it cut off would count as failed.
#[cfg(unix)]
fn apart(command: &mut Command) {
    use std::os::unix::process::CommandExt as _;
    command.process_group(0);
}

#[cfg(not(unix))]
fn apart(_: &mut Command) {}

fn numbers(words: &str) -> Option<Vec<f64>> {
    words.split_whitespace().map(|word| word.parse().ok()).collect()
}

/// Processes of a study: as many as there are threads that run candidates.
pub struct Workers<'a> {
    built: Built,
    /// Name of the study in the program.
    test: String,
    folder: &'a Path,
    /// Names of the goals.
    goals: Vec<&'a str>,
    idle: Mutex<Vec<Worker>>,
    /// Reason of the first run that failed.
    failure: Mutex<Option<String>>,
}

impl<'a> Workers<'a> {
    /// Starts the first process. Returns the values of the parameters in the text, too.
    pub fn start(
        built: Built,
        test: String,
        folder: &'a Path,
        goals: Vec<&'a str>,
    ) -> Result<(Self, Vec<f64>), String> {
        let workers = Self { built, test, folder, goals, idle: Mutex::default(), failure: Mutex::default() };
        let (first, defaults) = Worker::start(&workers)?;
        lock(&workers.idle).push(first);
        Ok((workers, defaults))
    }

    /// Reason of the first run that failed.
    pub fn failure(&self) -> Option<String> {
        lock(&self.failure).clone()
    }

    fn failed(&self, reason: impl FnOnce() -> String) {
        lock(&self.failure).get_or_insert_with(reason);
    }
}

fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Seed of a run with other recordings than the script has: the number of the recording, and the seed.
pub fn scenario(recording: usize, seed: u64) -> u64 {
    (recording as u64) << 32 | seed
}

impl Objective for Workers<'_> {
    fn run(&self, values: &[f64], scenario: u64) -> Result<Vec<f64>, String> {
        let idle = lock(&self.idle).pop();
        let mut worker = idle.map_or_else(|| Worker::start(self).map(|(worker, _)| worker), Ok)?;
        let (recording, seed) = (scenario >> 32, scenario & u64::from(u32::MAX));
        // The tests of a candidate belong to its first run.
        let tests = u8::from(scenario == 0);
        let mut line = format!("{seed} {recording} {tests}");
        values.iter().for_each(|value| line.push_str(&format!(" {value:?}")));
        line.push('\n');
        let Some(answer) = worker.ask(&line) else {
            self.failed(|| "the program crashed".to_owned());
            return Ok(vec![f64::NAN; self.goals.len()]);
        };
        lock(&self.idle).push(worker);
        match answer.strip_prefix("ok").and_then(numbers) {
            Some(goals) => {
                if let Some(missing) = goals.iter().position(|goal| goal.is_nan()) {
                    self.failed(|| format!("there was no number at `{}` until the end", self.goals[missing]));
                }
                Ok(goals)
            }
            None => {
                self.failed(|| answer.strip_prefix("failed ").unwrap_or(&answer).to_owned());
                Ok(vec![f64::NAN; self.goals.len()])
            }
        }
    }
}
