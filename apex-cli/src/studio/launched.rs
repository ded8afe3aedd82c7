//! A robot that this program builds and starts.

use super::{launch::Launch, text::Text};
use crate::{
    project::{self, print_error},
    run::{Found, KEPT, LOAD, Limits, Params, Recording, Stream, Wanted},
    watch::{
        files::Files,
        folders,
        program::{Running, forget},
    },
};
use apex_dsl::checked::CheckedProgram;
use apex_studio::{Recorded, Robot};
use std::{
    env, fs,
    path::{Path, PathBuf},
    process::Command,
    sync::Arc,
    time::{Duration, Instant, SystemTime},
};

/// Interval between checks of the files.
const INTERVAL: Duration = Duration::from_millis(300);

/// A robot that this program builds and starts.
pub struct Launched {
    launch: Launch,
    params: Params,
    text: Arc<Text>,
    /// Folder of the robot's socket, and of its recording.
    folder: PathBuf,
    /// The recording for a shadow, if there is one.
    recorded: Option<Arc<Recorded>>,
    /// A program that has been built, but not started.
    built: Option<Found>,
    /// Command that has started the current program, and the time at which that was built.
    command: Option<Command>,
    built_at: Option<SystemTime>,
    running: Option<Running>,
    has_started: bool,
    folders: Vec<PathBuf>,
    /// The files at the last build, at the last check, and the time of that.
    files: (Files, Files, Instant),
}

impl Launched {
    pub fn new(launch: Launch, text: Arc<Text>, recorded: Option<Arc<Recorded>>) -> Result<Self, String> {
        let folder = private_folder()?;
        let params = Params { load: launch.params.clone(), save: None };
        let folders = folders(&launch.file)?;
        let files = (Files::default(), Files::default(), Instant::now());
        Ok(Self {
            launch,
            params,
            text,
            folder,
            recorded,
            built: None,
            command: None,
            built_at: None,
            running: None,
            has_started: false,
            folders,
            files,
        })
    }

    fn wanted<'a>(launch: &'a Launch, params: &'a Params, socket: &'a str) -> Wanted<'a> {
        Wanted {
            file: &launch.file,
            robot: launch.robot.as_deref(),
            params,
            profile: None,
            recording: launch.replay.as_deref().map_or(Recording::Stated, Recording::Repeated),
            limits: Limits::default(),
            args: &launch.args,
            // Parameters that were set survive a restart. In simulated time they are set again at the same reactions.
            watch: launch.replay.is_none() && !launch.simulated,
            stream: Stream::WaitAt(socket),
            simulated: launch.simulated,
            how: launch.how,
        }
    }

    /// Builds the program. Returns `false` after errors, which are printed.
    pub fn build(&mut self) -> Result<bool, String> {
        let files = Files::below(&self.folders);
        self.files = (files.clone(), files, Instant::now());
        let socket = self.folder.join("robot").to_string_lossy().into_owned();
        let wanted = Self::wanted(&self.launch, &self.params, &socket);
        let Some(programs) = self.check(&wanted)? else { return Ok(false) };
        self.built = wanted.build(&programs)?;
        let failed = "the program cannot be built; the terminal has the errors";
        self.text.set_errors(self.built.is_none().then(|| failed.to_owned()));
        Ok(self.built.is_some())
    }

    fn check(&self, wanted: &Wanted<'_>) -> Result<Option<Vec<CheckedProgram>>, String> {
        let checked = project::check(wanted.file)?;
        checked.print_diagnostics();
        if checked.diagnostics.has_errors() {
            self.text.set_errors(Some(checked.rendered()));
            return Ok(None);
        }
        Ok(Some(checked.programs))
    }
}

impl Robot for Launched {
    fn start(&mut self, again: bool) -> Result<String, String> {
        let socket = self.folder.join("robot").to_string_lossy().into_owned();
        if let Some(command) = self.command.as_mut().filter(|_| again) {
            // With the parameters of the text, not with those at the end of the last run.
            command.env_remove(KEPT);
            record(self.recorded.as_deref(), command, &self.folder);
            let child = command.spawn();
            self.running = Some(Running::new(child.map_err(|e| format!("cannot start the robot again: {e}"))?));
            return Ok(socket);
        }
        if self.built.is_none() && !self.build()? {
            return Err("the program has errors".to_owned());
        }
        let built = self.built.take().ok_or("the program has not been built")?;
        if !std::mem::replace(&mut self.has_started, true) {
            forget(&built);
        }
        let mut command = Self::wanted(&self.launch, &self.params, &socket).command(&built);
        record(self.recorded.as_deref(), &mut command, &self.folder);
        self.running = Some(Running::new(command.spawn().map_err(|e| built.not_started(&e))?));
        self.built_at = built_at(&command);
        self.command = Some(command);
        Ok(socket)
    }

    fn runs(&mut self) -> bool {
        self.running.as_mut().is_some_and(|running| running.ended().is_none())
    }

    fn stop(&mut self) {
        if let Some(running) = self.running.take() {
            running.end();
        }
    }

    fn has_changed(&mut self) -> bool {
        let (built, last, at) = &mut self.files;
        if at.elapsed() < INTERVAL {
            return false;
        }
        let now = Files::below(&self.folders);
        let is_stable = now == std::mem::replace(last, now.clone());
        *at = Instant::now();
        if !is_stable || now == *built {
            return false;
        }
        let is_built = self.build().unwrap_or_else(|message| {
            print_error(&format!("error: {message}"));
            self.text.set_errors(Some(message));
            false
        });
        // A new file that the program does not use, such as a test, does not change it.
        let is_same = self.command.as_ref().is_some_and(|command| built_at(command) == self.built_at);
        if is_built && is_same {
            self.built = None;
        }
        is_built && !is_same
    }
}

/// Lets a robot record its run for its shadow, which begins with the parameters that the robot keeps from the run
/// before.
fn record(recorded: Option<&Recorded>, robot: &mut Command, folder: &Path) {
    let Some(recorded) = recorded else { return };
    recorded.begin(robot, folder, |shadow| {
        let kept = shadow.get_envs().find_map(|(name, value)| (name == KEPT).then_some(value?).map(PathBuf::from));
        let copied = folder.join("parameters");
        if let Some(kept) = kept
            && fs::copy(kept, &copied).is_ok()
        {
            shadow.env(LOAD, copied);
        }
        shadow.env_remove(KEPT);
    });
}

/// Time at which the program of a command was built.
fn built_at(command: &Command) -> Option<SystemTime> {
    fs::metadata(command.get_program()).and_then(|file| file.modified()).ok()
}

impl Drop for Launched {
    fn drop(&mut self) {
        self.stop();
        // A robot that was killed has left its socket there.
        let _ = fs::remove_dir_all(&self.folder);
    }
}

/// Makes a folder that only this user can enter: everyone who can connect to a robot can set its parameters.
fn private_folder() -> Result<PathBuf, String> {
    let folder = env::temp_dir().join(format!("apex-studio-{}", std::process::id()));
    // One of an earlier process with the same number; it cannot be removed if it belongs to another user.
    let _ = fs::remove_dir_all(&folder);
    let mut builder = fs::DirBuilder::new();
    #[cfg(unix)]
    std::os::unix::fs::DirBuilderExt::mode(&mut builder, 0o700);
    builder.create(&folder).map_err(|e| format!("cannot create `{}` for the socket: {e}", folder.display()))?;
    Ok(folder)
}
