use crate::run::{Found, Wanted};
use std::{
    fs,
    process::{Child, ExitStatus},
    thread,
    time::Duration,
};

/// Removes the parameters that were kept by an earlier watch.
pub fn forget(program: &Found) {
    if let Some(made) = &program.made {
        // The folder need not exist.
        let _ = fs::remove_dir_all(made.join("kept"));
    }
}

/// Starts a program; releases the lock as soon as it has started.
pub fn start(program: Found, wanted: &Wanted<'_>) -> Result<Running, String> {
    let child = wanted.command(&program).spawn().map_err(|e| program.not_started(&e))?;
    Ok(Running(child))
}

/// A running program, or one that has ended by itself.
pub struct Running(Child);

/// Interval and number of checks whether a program has ended after `SIGTERM`: five seconds in total.
const STEP: Duration = Duration::from_millis(20);
const STEPS: usize = 250;

impl Running {
    /// A program that has been started.
    pub fn new(child: Child) -> Self {
        Self(child)
    }

    /// Exit status, if the program has ended.
    pub fn ended(&mut self) -> Option<ExitStatus> {
        self.0.try_wait().ok().flatten()
    }

    /// Sends `SIGTERM`, so that the program can save its state; kills it if it does not end.
    pub fn end(mut self) {
        if self.ended().is_none() && self.ask() {
            for _ in 0..STEPS {
                if self.ended().is_some() {
                    return;
                }
                thread::sleep(STEP);
            }
        }
        // The program may have ended in the meantime.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }

    /// Sends `SIGTERM`. Returns `true` if the signal was sent.
    #[cfg(unix)]
    fn ask(&self) -> bool {
        use nix::{sys::signal, unistd::Pid};
        i32::try_from(self.0.id()).is_ok_and(|id| signal::kill(Pid::from_raw(id), signal::Signal::SIGTERM).is_ok())
    }

    /// Returns `false`: there is no portable signal on other systems.
    #[cfg(not(unix))]
    fn ask(&self) -> bool {
        false
    }
}
