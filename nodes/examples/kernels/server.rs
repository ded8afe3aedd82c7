//! Processes that measure: a line with the name of a kernel is answered by its time per call and a digest of its
//! result, or by `skipped`.

use super::{kernels::Kernel, measure::cpu_time};
use std::{
    io::{BufRead, BufReader, Write},
    path::Path,
    process::{Child, ChildStdin, ChildStdout, Command, Stdio},
};

/// CPU time of a measurement, in ns.
const SPAN: f64 = 20e6;

/// Process that measures.
pub struct Server {
    process: Child,
    words: ChildStdin,
    answers: BufReader<ChildStdout>,
}

/// Result of a measurement.
#[derive(Clone, Copy)]
pub struct Answer {
    /// Thread CPU time of a call.
    pub nanoseconds: f64,
    /// Digest of the result.
    pub digest: u64,
}

impl Server {
    /// Starts a build of this program.
    pub fn of(program: &Path, folder: &Path) -> Result<Self, String> {
        Self::start(program, Command::new(program).arg("--serve").arg(folder))
    }

    /// Starts the script with the libraries.
    pub fn of_python(python: &Path, folder: &Path) -> Result<Self, String> {
        let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/kernels/reference.py");
        Self::start(python, Command::new(python).arg("-B").arg(script).arg(folder).arg(SPAN.to_string()))
    }

    fn start(program: &Path, command: &mut Command) -> Result<Self, String> {
        let process = command.stdin(Stdio::piped()).stdout(Stdio::piped()).spawn();
        let mut process = process.map_err(|e| format!("{} does not start: {e}", program.display()))?;
        let (words, answers) = (process.stdin.take(), process.stdout.take());
        let (words, answers) = words.zip(answers).ok_or("a process without pipes")?;
        Ok(Self { process, words, answers: BufReader::new(answers) })
    }

    /// Asks for the time of a kernel; `None` if its input is missing.
    pub fn ask(&mut self, name: &str) -> Result<Option<Answer>, String> {
        let mut line = String::new();
        writeln!(self.words, "{name}").map_err(|e| e.to_string())?;
        self.answers.read_line(&mut line).map_err(|e| e.to_string())?;
        if line.trim() == "skipped" {
            return Ok(None);
        }
        let mut words = line.split_whitespace();
        let nanoseconds = words.next().and_then(|word| word.parse().ok());
        let digest = words.next().and_then(|word| word.parse().ok());
        let answer = nanoseconds.zip(digest).map(|(nanoseconds, digest)| Answer { nanoseconds, digest });
        answer.map(Some).ok_or_else(|| format!("{name}: a process answers `{}`", line.trim()))
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        drop(self.process.kill());
        drop(self.process.wait());
    }
}

/// Answers until the input ends.
pub fn serve(folder: &Path) -> Result<(), String> {
    for name in std::io::stdin().lines() {
        let name = name.map_err(|e| e.to_string())?;
        match Kernel::new(&name, folder)? {
            Some(mut kernel) => println!("{} {}", time(&mut kernel), kernel.digest()),
            None => println!("skipped"),
        }
    }
    Ok(())
}

/// Thread CPU time of a call, in ns, of as many calls as fill the span.
fn time(kernel: &mut Kernel) -> f64 {
    kernel.run();
    let begin = cpu_time();
    for calls in 1.. {
        kernel.run();
        let time = cpu_time() - begin;
        if time > SPAN {
            return time / f64::from(calls);
        }
    }
    f64::NAN
}
