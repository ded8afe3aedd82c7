use crate::run::{Found, Wanted};
use std::{
    fs,
    process::{Child, ExitStatus},
    thread,
    time::Duration,
};

/// Forgets the parameters that were kept in an earlier watch.
pub fn forget(program: &Found) {
    if let Some(made) = &program.made {
        // It may never have been there.
        let _ = fs::remove_dir_all(made.join("kept"));
    }
}

/// Starts a program; others may build as soon as it has.
pub fn start(program: Found, wanted: &Wanted<'_>) -> Result<Running, String> {
    let child = wanted.command(&program).spawn().map_err(|e| program.not_started(&e))?;
    Ok(Running(child))
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
