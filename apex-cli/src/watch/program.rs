use crate::run::{Found, Wanted};
use apex_host::no_cargo;
use serde_json::Value;
use std::{
    fs,
    path::PathBuf,
    process::{Child, Command, ExitStatus, Stdio},
    thread,
    time::Duration,
};

/// A program that has been built.
pub struct Built {
    program: Found,
    executable: PathBuf,
}

impl Built {
    /// Checks and builds; `None` if there are errors, which are printed.
    pub fn new(wanted: &Wanted<'_>) -> Result<Option<Self>, String> {
        let Some(program) = wanted.find()? else { return Ok(None) };
        let mut command = program.cargo("build");
        command.arg("--message-format=json-render-diagnostics").stderr(Stdio::inherit());
        let output = command.output().map_err(|e| no_cargo(&e))?;
        if !output.status.success() {
            return Ok(None);
        }
        let messages = String::from_utf8_lossy(&output.stdout);
        let executable = messages.lines().filter_map(executable).next_back();
        let executable = executable.ok_or("cargo has built no program")?;
        Ok(Some(Self { program, executable }))
    }

    /// Forgets the parameters that were kept in an earlier watch.
    pub fn forget(&self) {
        if let Some(made) = &self.program.made {
            // It may never have been there.
            let _ = fs::remove_dir_all(made.join("kept"));
        }
    }

    /// Starts it.
    pub fn start(&self, wanted: &Wanted<'_>) -> Result<Running, String> {
        let mut command = Command::new(&self.executable);
        wanted.tell(&self.program, &mut command);
        let child = command.spawn().map_err(|e| format!("cannot run `{}`: {e}", self.executable.display()))?;
        Ok(Running(child))
    }
}

/// The executable that one of cargo's messages speaks of.
fn executable(message: &str) -> Option<PathBuf> {
    let message: Value = serde_json::from_str(message).ok()?;
    message["executable"].as_str().map(PathBuf::from)
}

/// A program that runs, or has ended by itself.
pub struct Running(Child);

/// How often and how many times is looked whether a program ends that was asked to: five seconds in all.
const STEP: Duration = Duration::from_millis(20);
const STEPS: usize = 250;

impl Running {
    /// How it ended, if it has.
    pub fn ended(&mut self) -> Option<ExitStatus> {
        self.0.try_wait().ok().flatten()
    }

    /// Asks it to end, so that it can save what it knows; ends it if it does not listen.
    pub fn end(mut self) {
        if self.ended().is_none() && self.ask() {
            for _ in 0..STEPS {
                if self.ended().is_some() {
                    return;
                }
                thread::sleep(STEP);
            }
        }
        // It may just have ended.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }

    /// Whether it could be asked.
    #[cfg(unix)]
    fn ask(&self) -> bool {
        use nix::{sys::signal, unistd::Pid};
        i32::try_from(self.0.id()).is_ok_and(|id| signal::kill(Pid::from_raw(id), signal::Signal::SIGTERM).is_ok())
    }

    /// Whether it could be asked: elsewhere there is no common word for it.
    #[cfg(not(unix))]
    fn ask(&self) -> bool {
        false
    }
}
