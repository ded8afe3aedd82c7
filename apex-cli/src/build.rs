//! Builds of programs with cargo. They use the target folder of the workspace, so that finished crates are not built
//! again.

pub mod earlier;
mod trim;
mod wanted;

use crate::project::print_error;
use apex_host::{Workspace, cargo, no_cargo};
use serde_json::Value;
use std::{
    env,
    fs::{self, File, TryLockError},
    io::{self, BufRead as _, BufReader, IsTerminal as _, Read},
    path::{Path, PathBuf},
    process::{Child, Command, Stdio},
    thread,
    time::{Duration, Instant},
};
use trim::Trimmed;

pub use wanted::Wanted;

/// Settings of a build.
#[derive(Clone, Copy, Default)]
pub struct How {
    /// `true` for an optimised build, as with `cargo build --release`.
    pub release: bool,
    /// `true` to print errors only.
    pub quiet: bool,
    /// `true` to leave the paths of this machine out of the program.
    pub trims: bool,
}

impl How {
    /// Settings with these values; the build is also quiet if the user's `CARGO_TERM_QUIET` says so.
    pub fn new(release: bool, quiet: bool) -> Self {
        let quiet = quiet || env::var_os("CARGO_TERM_QUIET").is_some_and(|value| value == "true");
        Self { release, quiet, trims: false }
    }
}

/// A program that has been built.
pub struct Built {
    executable: PathBuf,
    package: PathBuf,
    /// Folders with shared libraries that the program may load.
    libraries: Vec<PathBuf>,
}

impl Built {
    /// Command that starts the program, with the environment variables that cargo would set.
    pub fn command(&self) -> Command {
        let mut command = Command::new(&self.executable);
        let before = env::var_os(LIBRARY_PATH).unwrap_or_default();
        let all = self.libraries.iter().cloned().chain(env::split_paths(&before).filter(|p| !p.as_os_str().is_empty()));
        // A folder whose name contains the separator cannot be in the list.
        if let Ok(all) = env::join_paths(all) {
            command.env(LIBRARY_PATH, all);
        }
        command.env("CARGO_MANIFEST_DIR", &self.package);
        command
    }

    /// Error message for a program that does not start.
    pub fn not_started(&self, reason: &io::Error) -> String {
        format!("cannot run `{}`: {reason}", self.executable.display())
    }
}

/// Environment variable with the folders in which the system looks for shared libraries.
const LIBRARY_PATH: &str = if cfg!(windows) {
    "PATH"
} else if cfg!(target_os = "macos") {
    "DYLD_FALLBACK_LIBRARY_PATH"
} else {
    "LD_LIBRARY_PATH"
};

/// Lock on making packages, building them and starting the program. It is released when it is dropped, or when the
/// process becomes the program, so that no other command replaces the program in between.
pub struct Turn(#[expect(dead_code, reason = "it is locked as long as it is open")] Option<File>);

/// Tag of a cache folder, which backups and searches leave out: <https://bford.info/cachedir/>.
const MARK: &str = "Signature: 8a477f597d28d172789f06886806bc55\n# Made by `apex`.\n";

impl Turn {
    /// Waits for the lock, with a message if another process holds it.
    pub fn wait(workspace: &Workspace, how: How) -> Result<Self, String> {
        let folder = workspace.cache_folder();
        let failed = |e: io::Error| format!("cannot write in `{}`: {e}", folder.display());
        fs::create_dir_all(&folder).map_err(failed)?;
        write_if_other(&folder.join("CACHEDIR.TAG"), MARK)?;
        let lock = File::options().create(true).append(true).open(folder.join("lock")).map_err(failed)?;
        match lock.try_lock() {
            Ok(()) => Ok(Self(Some(lock))),
            Err(TryLockError::WouldBlock) => {
                if !how.quiet {
                    let target = workspace.target.display();
                    print_error(&format!("waiting for another `apex` that builds in `{target}`"));
                }
                lock.lock().map_err(failed)?;
                Ok(Self(Some(lock)))
            }
            // On file systems without locks, cargo has none either.
            Err(TryLockError::Error(_)) => Ok(Self(None)),
        }
    }
}

/// Writes a file unless it has this content already, because cargo compares modification times. Returns `true` if it
/// wrote.
pub fn write_if_other(path: &Path, text: &str) -> Result<bool, String> {
    if fs::read(path).is_ok_and(|old| old == text.as_bytes()) {
        return Ok(false);
    }
    fs::create_dir_all(path.parent().unwrap_or(Path::new(".")))
        .and_then(|()| fs::write(path, text))
        .map_err(|e| format!("cannot write `{}`: {e}", path.display()))?;
    Ok(true)
}

/// Cargo command for a crate.
fn cargo_for(wanted: &Wanted, verb: &[&str], how: How) -> Command {
    let mut command = cargo();
    command.args(verb).args(&wanted.select).current_dir(&wanted.root).env("CARGO_TARGET_DIR", &wanted.target);
    command.args(how.release.then_some("--release")).args(how.quiet.then_some("--quiet"));
    command.arg(match &wanted.hushed {
        None => "--message-format=json-render-diagnostics",
        Some(_) if io::stderr().is_terminal() => "--message-format=json-diagnostic-rendered-ansi",
        Some(_) => "--message-format=json",
    });
    command.stdin(Stdio::null()).stdout(Stdio::piped());
    command
}

/// Arguments of cargo that build a program.
pub const PROGRAM: &[&str] = &["build"];
pub const TESTS: &[&str] = &["test", "--no-run"];

/// Result of a build.
pub enum Outcome {
    /// A program.
    Built(Built),
    /// No program: the crate has no binary, or no tests.
    Nothing,
    /// Compile errors, which cargo has printed.
    Broken,
    /// Compile errors in the crate whose messages are not shown, and only there.
    Refused,
}

impl Outcome {
    /// The program, or `None` after compile errors.
    ///
    /// # Errors
    /// Fails if the crate has no program.
    pub fn program(self) -> Result<Option<Built>, String> {
        match self {
            Self::Built(built) => Ok(Some(built)),
            Self::Broken | Self::Refused => Ok(None),
            Self::Nothing => Err("cargo did not build a program".to_owned()),
        }
    }
}

/// Builds a program, or its tests.
///
/// A terminal shows cargo's progress. Otherwise one line is printed for each crate that is compiled.
pub fn build(wanted: &Wanted, verb: &[&str], how: How) -> Result<Outcome, String> {
    let mut command = cargo_for(wanted, verb, how);
    let trimmed = how.trims.then(|| Trimmed::of(wanted));
    trimmed.iter().for_each(|trimmed| trimmed.apply(&mut command));
    if !how.quiet && is_first(wanted, how) {
        print_error(FIRST);
    }
    let (sees_progress, start) = (io::stderr().is_terminal(), Instant::now());
    let passes_on = !how.quiet && !sees_progress;
    command.stderr(if passes_on { Stdio::piped() } else { Stdio::inherit() });
    let mut child = command.spawn().map_err(|e| no_cargo(&e))?;
    let progress = child.stderr.take().map(|lines| {
        let hushed = wanted.hushed.clone();
        thread::spawn(move || pass_on(lines, hushed.as_deref()))
    });
    let messages = Messages::read(&mut child, verb == TESTS, wanted.hushed.as_deref())?;
    if let Some(progress) = progress {
        // The thread only prints; a panic in it does not matter.
        let _ = progress.join();
    }
    if !child.wait().map_err(|e| no_cargo(&e))?.success() {
        return Ok(if messages.is_hushed { Outcome::Refused } else { Outcome::Broken });
    }
    if sees_progress && !how.quiet && messages.compiled == 0 {
        // Erases the line that reports that nothing had to be done.
        eprint!("\x1b[1A\x1b[2K");
    }
    if let Some(line) = took(messages.compiled, start.elapsed()).filter(|_| !how.quiet) {
        print_error(&line);
    }
    let Some(executable) = messages.executable else { return Ok(Outcome::Nothing) };
    trimmed.iter().for_each(|trimmed| trimmed.check(&executable));
    let folder = executable.parent().unwrap_or(Path::new("."));
    let is_ours = |path: &PathBuf| path.starts_with(&wanted.target);
    let mut libraries: Vec<PathBuf> = messages.linked.into_iter().filter(is_ours).collect();
    libraries.extend([folder.join("deps"), folder.to_owned()]);
    Ok(Outcome::Built(Built { executable, package: wanted.package.clone(), libraries }))
}

/// Note before the first build.
const FIRST: &str = "note: the first build compiles the compiler, the runtime and the library, once: this takes minutes. \
    Later builds compile only what has changed, in seconds";

/// `true` if nothing has been built in the target folder with these settings.
fn is_first(wanted: &Wanted, how: How) -> bool {
    !program_folder(wanted, how).exists()
}

/// Folder of the programs that are built with these settings.
fn program_folder(wanted: &Wanted, how: How) -> PathBuf {
    wanted.target.join(if how.release { "release" } else { "debug" })
}

/// Time from which on a build is long enough to say what it took.
const LONG: Duration = Duration::from_secs(10);

/// Line about a long build.
fn took(compiled: usize, time: Duration) -> Option<String> {
    let crates = if compiled == 1 { "1 crate".to_owned() } else { format!("{compiled} crates") };
    let seconds = time.as_secs();
    let time_shown =
        if seconds < 60 { format!("{seconds} s") } else { format!("{} min {} s", seconds / 60, seconds % 60) };
    (compiled > 0 && time >= LONG).then(|| format!("compiled {crates} in {time_shown}"))
}

/// Prints cargo's progress messages, without the final ones that report the end of the build, and without the failure
/// of a crate that is `hushed`.
fn pass_on(lines: impl Read, hushed: Option<&str>) {
    for line in BufReader::new(lines).split(b'\n').map_while(Result::ok) {
        let line = String::from_utf8_lossy(&line);
        let is_end = ["Finished `", "Executable "].iter().any(|word| line.trim_start().starts_with(word));
        let is_hushed = hushed.is_some_and(|name| line.starts_with(&format!("error: could not compile `{name}`")));
        if !is_end && !is_hushed {
            print_error(&line);
        }
    }
}

/// Cargo's messages about the built programs.
#[derive(Default)]
struct Messages {
    /// Number of crates that were compiled.
    compiled: usize,
    /// Executable of the last program.
    executable: Option<PathBuf>,
    /// Folders into which build scripts have put libraries.
    linked: Vec<PathBuf>,
    /// All errors were in the crate whose messages are not shown.
    is_hushed: bool,
}

impl Messages {
    /// Reads all messages of a build of a program, or of `tests`. With a crate that is `hushed`, the messages of the
    /// others are printed.
    fn read(child: &mut Child, tests: bool, hushed: Option<&str>) -> Result<Self, String> {
        let mut messages = Self::default();
        let Some(output) = child.stdout.take() else { return Ok(messages) };
        for line in BufReader::new(output).lines() {
            let line = line.map_err(|e| format!("cannot read the output of cargo: {e}"))?;
            // Lines of other programs are not JSON.
            let Ok(message) = serde_json::from_str::<Value>(&line) else { continue };
            if let (Some(hushed), Some(text)) = (hushed, message["message"]["rendered"].as_str()) {
                let is_error = message["message"]["level"] == "error";
                match message["target"]["name"] == hushed {
                    true => messages.is_hushed |= is_error,
                    false => print_error(text.trim_end()),
                }
            }
            let is_script = message["target"]["kind"][0] == "custom-build";
            messages.compiled += usize::from(message["fresh"] == false && !is_script);
            if let Some(executable) = message["executable"].as_str().filter(|_| message["profile"]["test"] == tests) {
                messages.executable = Some(executable.into());
            }
            let linked = message["linked_paths"].as_array().into_iter().flatten().filter_map(Value::as_str);
            messages.linked.extend(linked.map(|path| path.split_once('=').map_or(path, |(_, path)| path).into()));
        }
        Ok(messages)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_builds_say_what_they_took() {
        let took = |compiled, seconds| took(compiled, Duration::from_secs(seconds)).unwrap_or_default();
        assert_eq!([took(0, 100), took(5, 9), took(1, 10)], ["", "", "compiled 1 crate in 10 s"]);
        assert_eq!(took(54, 338), "compiled 54 crates in 5 min 38 s");
    }
}
