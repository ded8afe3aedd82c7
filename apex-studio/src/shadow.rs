//! A second robot that gets the inputs of the first one: it repeats the recording that the first one is making.

use crate::robot::Robot;
use std::{
    fs,
    path::{Path, PathBuf},
    process::{Child, Command, Stdio},
    sync::{Arc, Mutex, MutexGuard, PoisonError},
};

/// Environment variables of the programs (`apex_rt::drive`): recordings and profiles that are made, recordings that are
/// repeated, that of a replay which waits for more inputs where the recording ends so far, and sockets for viewers.
const RECORD: &str = "APEX_RECORD";
const PROFILE: &str = "APEX_PROFILE";
const REPLAY: &str = "APEX_REPLAY";
const FOLLOW: &str = "APEX_REPLAY_FOLLOW";
const STREAM: &str = "APEX_STUDIO";
const STREAM_WAITS: &str = "APEX_STUDIO_WAIT";

/// The recording of the robot's current run.
#[derive(Default)]
pub struct Recorded(Mutex<Run>);

#[derive(Default)]
struct Run {
    /// Number of the run, from 1.
    number: u32,
    recording: PathBuf,
    /// Command that starts the shadow.
    shadow: Option<Command>,
}

impl Recorded {
    fn run(&self) -> MutexGuard<'_, Run> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Lets the robot that a command starts make a recording in `folder`. The shadow is started by a copy of the
    /// command that `adapt` may change.
    pub fn begin(&self, robot: &mut Command, folder: &Path, adapt: impl FnOnce(&mut Command)) {
        let mut run = self.run();
        // A shadow that still reads it can do so.
        let _ = fs::remove_file(&run.recording);
        run.number += 1;
        run.recording = folder.join(format!("inputs-{}.mcap", run.number));
        let mut shadow = copy(robot);
        // It would print everything a second time.
        shadow.stdout(Stdio::null());
        robot.env(RECORD, &run.recording);
        // It writes no files: those of the robot have the same names.
        shadow.env_remove(RECORD).env_remove(PROFILE).env(REPLAY, &run.recording).env(FOLLOW, "1");
        shadow.env(STREAM, folder.join("shadow")).env(STREAM_WAITS, "1");
        adapt(&mut shadow);
        run.shadow = Some(shadow);
    }
}

/// A command that does the same.
fn copy(command: &Command) -> Command {
    let mut copy = Command::new(command.get_program());
    copy.args(command.get_args());
    for (name, value) in command.get_envs() {
        match value {
            Some(value) => copy.env(name, value),
            None => copy.env_remove(name),
        };
    }
    if let Some(folder) = command.get_current_dir() {
        copy.current_dir(folder);
    }
    copy
}

/// The second robot.
pub struct Shadow {
    recorded: Arc<Recorded>,
    /// Number of the run that it repeats.
    number: u32,
    child: Option<Child>,
}

impl Shadow {
    /// A shadow of the robot that makes these recordings.
    pub fn new(recorded: Arc<Recorded>) -> Self {
        Self { recorded, number: 0, child: None }
    }
}

impl Robot for Shadow {
    fn start(&mut self, _again: bool) -> Result<String, String> {
        let mut run = self.recorded.run();
        let number = run.number;
        if !run.recording.exists() {
            return Err(
                "the robot has recorded nothing yet; a program with a loop of its own records nothing".to_owned()
            );
        }
        let command = run.shadow.as_mut().ok_or("the robot has not been started yet")?;
        let address = command.get_envs().find_map(|(name, value)| (name == STREAM).then_some(value?.to_owned()));
        self.child = Some(command.spawn().map_err(|error| format!("cannot start the shadow: {error}"))?);
        self.number = number;
        Ok(address.unwrap_or_default().to_string_lossy().into_owned())
    }

    fn runs(&mut self) -> bool {
        self.child.as_mut().is_some_and(|child| child.try_wait().is_ok_and(|ended| ended.is_none()))
    }

    fn stop(&mut self) {
        if let Some(mut child) = self.child.take() {
            // It may wait for an input that never comes, and has nothing to save.
            let _ = child.kill();
            let _ = child.wait();
        }
    }

    fn repeats(&self) -> bool {
        false
    }

    fn has_changed(&mut self) -> bool {
        let run = self.recorded.run();
        run.number != self.number && run.recording.exists()
    }
}

impl Drop for Shadow {
    fn drop(&mut self) {
        self.stop();
    }
}
