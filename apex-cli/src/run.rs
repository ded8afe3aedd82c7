//! `apex run`: runs the package's own program, or one that is made for the source file.

use crate::{
    answer::Answer,
    build::{self, Built, How, Turn},
    made::{self, Made},
    project,
    replace::is_same,
};
use apex_dsl::{
    checked::CheckedProgram,
    graph::{Graph, NodeKind},
    report::nearest,
    syntax::MAX_BYTES,
    units,
};
use apex_host::{Workspace, read_text};
use serde_json::Value;
use std::{
    env,
    ffi::OsString,
    fs,
    io::{self, Read as _},
    path::{Path, PathBuf},
    process::{self, Command, ExitCode, ExitStatus},
    time::Duration,
};

/// Files with the parameters of the program.
pub struct Params {
    /// Read before the run.
    pub load: Option<PathBuf>,
    /// Written at its end.
    pub save: Option<PathBuf>,
}

impl Params {
    fn are_wanted(&self) -> bool {
        self.load.is_some() || self.save.is_some()
    }

    /// Checks the paths, so that an error is reported before the build.
    fn look(&self, text: &Path) -> Result<(), String> {
        let shown = |path: &Path| path.display().to_string();
        if let Some(load) = &self.load {
            read_text(load, MAX_BYTES).map_err(|reason| format!("cannot read `{}`: {reason}", shown(load)))?;
        }
        let Some(save) = &self.save else { return Ok(()) };
        if is_same(save, text) {
            return Err(format!(
                "the parameters would overwrite the source file `{}`: choose another file",
                shown(save)
            ));
        }
        if save.exists() && !save.is_file() {
            return Err(format!("cannot write `{}`: it is not a regular file", shown(save)));
        }
        has_folder(save).map_err(|e| format!("cannot write `{}`: {e}", shown(save)))
    }
}

/// Fails if the folder of the file does not exist.
pub fn has_folder(file: &Path) -> Result<(), String> {
    match file.parent().filter(|folder| !folder.as_os_str().is_empty() && !folder.is_dir()) {
        Some(folder) => Err(format!("there is no folder `{}`", folder.display())),
        None => Ok(()),
    }
}

/// Environment variables with the files for the made program, whose arguments belong to the nodes.
pub const LOAD: &str = "APEX_PARAMS";
const SAVE: &str = "APEX_SAVE_PARAMS";
pub const KEPT: &str = "APEX_KEPT_PARAMS";
/// Environment variable with the file of the profile, for every program (`apex_rt::drive`).
const PROFILE: &str = "APEX_PROFILE";

/// Environment variables with the recording that is made or repeated, for every program (`apex_rt::drive`).
const RECORD: &str = "APEX_RECORD";
const REPLAY: &str = "APEX_REPLAY";
/// Environment variable with the file to which the report on a replay is written, as JSON.
const REPORT: &str = "APEX_REPLAY_REPORT";
/// Environment variables with the limits of the recording.
const RECORD_LIMIT: &str = "APEX_RECORD_LIMIT";
const RECORD_AGE: &str = "APEX_RECORD_AGE";
const RECORD_COMPRESS: &str = "APEX_RECORD_COMPRESS";

/// Environment variables with the socket for viewers, for every program (`apex_rt::drive`).
const STREAM: &str = "APEX_STUDIO";
const STREAM_WAITS: &str = "APEX_STUDIO_WAIT";

/// Environment variable with the rights of viewers.
const STREAM_ACCESS: &str = "APEX_STUDIO_ACCESS";

/// Rights of viewers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum StreamAccess {
    /// They may look.
    Read,
    /// They may also set parameters.
    Write,
}

impl StreamAccess {
    const fn name(self) -> &'static str {
        match self {
            Self::Read => "read",
            Self::Write => "write",
        }
    }
}

/// Use of a recording.
#[derive(Clone, Copy, Default)]
pub enum Recording<'a> {
    /// As the source file states.
    #[default]
    Stated,
    /// Records the run to this file.
    Made(&'a Path),
    /// Repeats the run in this file.
    Repeated(&'a Path),
}

/// Limits of a recording. They take precedence over those of the `record` statement, if its file is recorded.
#[derive(Clone, Copy, Default, clap::Args)]
pub struct Limits {
    /// Keep at most this many bytes of the recording: it is divided into numbered files, and the oldest are removed.
    #[arg(long = "record-limit", value_name = "SIZE", value_parser = size)]
    limit: Option<u64>,
    /// Remove what is older than this from the recording, which is divided into numbered files.
    #[arg(long = "record-age", value_name = "TIME", value_parser = age)]
    age: Option<Duration>,
    /// Compress the recording.
    #[arg(long = "record-compress")]
    compress: bool,
}

impl Limits {
    /// Sets the environment variables of a program.
    fn pass(self, command: &mut Command) {
        let age = self.age.map(|age| format!("{}s", age.as_secs_f64()));
        let limit = self.limit.map(|bytes| bytes.to_string());
        let compress = self.compress.then(|| "1".to_owned());
        for (name, value) in [(RECORD_LIMIT, limit), (RECORD_AGE, age), (RECORD_COMPRESS, compress)] {
            match value {
                Some(value) => command.env(name, value),
                None => command.env_remove(name),
            };
        }
    }
}

/// Reads a size: `1GB`.
fn size(text: &str) -> Result<u64, String> {
    let (digits, unit) = with_unit(text);
    units::bytes(digits, unit)
        .filter(|bytes| *bytes >= units::LEAST_RECORDING)
        .ok_or_else(|| "a size is at least 16MB, for example `1GB`".to_owned())
}

/// Reads a time: `10min`.
fn age(text: &str) -> Result<Duration, String> {
    let (digits, unit) = with_unit(text);
    units::time(digits, unit)
        .filter(|age| *age >= units::YOUNGEST_RECORDING)
        .ok_or_else(|| "a time is at least 8s, for example `10min`".to_owned())
}

/// A number, and the unit behind it.
fn with_unit(text: &str) -> (&str, &str) {
    text.split_at(text.find(|c: char| c.is_ascii_alphabetic()).unwrap_or(text.len()))
}

/// First bytes of an MCAP file.
const MAGIC: &[u8; 8] = b"\x89MCAP0\r\n";

impl Recording<'_> {
    /// Checks the path, so that an error is reported before the build.
    fn look(self) -> Result<(), String> {
        match self {
            Self::Stated => Ok(()),
            Self::Made(path) if path.is_dir() => {
                Err(format!("cannot record to `{}`: it is a folder; choose a file in it", path.display()))
            }
            Self::Made(path) => has_folder(path).map_err(|e| format!("cannot record to `{}`: {e}", path.display())),
            Self::Repeated(path) => {
                let what = |what: &str| Err(format!("cannot read `{}`: {what}", path.display()));
                if path.is_dir() {
                    return what("it is a folder");
                }
                let mut magic = [0; 8];
                match fs::File::open(path).and_then(|mut file| file.read_exact(&mut magic)) {
                    Ok(()) if magic == *MAGIC => Ok(()),
                    Ok(()) => what("it is not an MCAP file, or its beginning is damaged"),
                    Err(error) if error.kind() == io::ErrorKind::UnexpectedEof => {
                        what("it is empty, or was cut off before anything was recorded")
                    }
                    Err(error) => what(&error.to_string()),
                }
            }
        }
    }
}

/// A program to run, with its options.
pub struct Wanted<'a> {
    /// Source file.
    pub file: &'a Path,
    /// Name of the robot or graph, if the source file has several.
    pub robot: Option<&'a str>,
    /// Files with parameters.
    pub params: &'a Params,
    /// File for the profile.
    pub profile: Option<&'a Path>,
    /// Recording or replay.
    pub recording: Recording<'a>,
    /// Limits of the recording.
    pub limits: Limits,
    /// Arguments for the program.
    pub args: &'a [String],
    /// `true` to build again after every change and keep changed parameters.
    pub watch: bool,
    /// Socket at which viewers can connect.
    pub stream: Stream<'a>,
    /// `true` if the time of a program that is made is simulated.
    pub simulated: bool,
    /// Settings of the build.
    pub how: How,
}

/// Socket for viewers.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Stream<'a> {
    None,
    /// A socket at this address, with other rights of viewers than those that follow from it.
    At(&'a str, Option<StreamAccess>),
    /// A socket at this address; a program in simulated time waits for a viewer.
    WaitAt(&'a str),
}

/// A built program. It may be started while the lock is held.
pub struct Found {
    built: Built,
    /// Folder of the package, if it was made for the source file.
    pub made: Option<PathBuf>,
    _turn: Turn,
}

impl Found {
    /// Error message for a program that does not start.
    pub fn not_started(&self, reason: &io::Error) -> String {
        self.built.not_started(reason)
    }
}

impl Wanted<'_> {
    /// Command that starts the program, with arguments and environment variables.
    pub fn command(&self, program: &Found) -> Command {
        let mut command = program.built.command();
        command.args(self.args);
        match self.profile {
            Some(path) => command.env(PROFILE, env::current_dir().unwrap_or_default().join(path)),
            None => command.env_remove(PROFILE),
        };
        let here = |path: &Path| env::current_dir().unwrap_or_default().join(path);
        command.env_remove(RECORD).env_remove(REPLAY);
        match self.recording {
            Recording::Stated => {}
            Recording::Made(path) => drop(command.env(RECORD, here(path))),
            Recording::Repeated(path) => drop(command.env(REPLAY, here(path))),
        }
        self.limits.pass(&mut command);
        command.env_remove(STREAM).env_remove(STREAM_WAITS);
        match self.stream {
            Stream::None => {}
            Stream::At(address, None) => drop(command.env(STREAM, address)),
            Stream::At(address, Some(access)) => drop(command.env(STREAM, address).env(STREAM_ACCESS, access.name())),
            // The studio has started it, and nobody else reaches it.
            Stream::WaitAt(address) => {
                command.env(STREAM, address).env(STREAM_WAITS, "1").env_remove(STREAM_ACCESS);
            }
        }
        let Some(made) = &program.made else { return command };
        let kept = self.watch.then(|| made.join("kept"));
        for (name, path) in [(LOAD, &self.params.load), (SAVE, &self.params.save), (KEPT, &kept)] {
            match path {
                Some(path) => command.env(name, path),
                None => command.env_remove(name),
            };
        }
        command
    }

    /// Checks the source file. Returns `None` if it has errors, which are printed.
    pub fn check(&self, answer: &mut Answer) -> Result<Option<Vec<CheckedProgram>>, String> {
        let checked = project::check(self.file)?;
        answer.messages(&checked.diagnostics, &checked.sources);
        Ok((!checked.diagnostics.has_errors()).then_some(checked.programs))
    }

    /// Builds the program of a checked source file. Returns `None` after compile errors, which cargo has printed.
    pub fn build(&self, programs: &[CheckedProgram]) -> Result<Option<Found>, String> {
        self.params.look(self.file)?;
        self.recording.look()?;
        if self.profile.is_some() && !self.how.release && !self.how.quiet {
            project::print_error(
                "note: this profile is of an unoptimised program; measure with `--release` for realistic times",
            );
        }
        let folder = package(self.file)?;
        let workspace = Workspace::load(&folder)?;
        has_apex(&folder, &workspace)?;
        let (package, binary) = workspace.binary();
        // The package's own program may not use `apex_rt::drive`, which repeats recordings, and has a clock of its own.
        let repeats = matches!(self.recording, Recording::Repeated(_)) || self.simulated;
        let Some(binary) = binary.filter(|_| self.robot.is_none() && !repeats) else {
            return self.make(choose(programs, self.robot)?, &workspace);
        };
        if self.params.are_wanted() {
            return Err(format!(
                "`--params` and `--save-params` only apply to programs that `apex run` generates, but the package has its own program `{binary}`: remove them, or choose a robot with `--robot`"
            ));
        }
        let graphs: Vec<&Graph> = programs.iter().map(|p| &p.graph).collect();
        let mut select: Vec<OsString> = ["--package", package, "--bin", binary].map(OsString::from).to_vec();
        select.extend(made::select_features(&workspace, &self.features(false, &graphs)));
        let (root, target) = (folder.clone(), workspace.target.clone());
        let turn = Turn::wait(&workspace, self.how)?;
        let built = build::build(
            &build::Wanted { select, package: folder, root, target, hushed: None },
            build::PROGRAM,
            self.how,
        )?
        .program()?;
        Ok(built.map(|built| Found { built, made: None, _turn: turn }))
    }

    /// Features of the runtime that a program with one of `graphs` needs.
    fn features(&self, params: bool, graphs: &[&Graph]) -> Vec<&'static str> {
        let stated = graphs.iter().any(|graph| graph.record.is_some());
        let streams = self.stream != Stream::None;
        let records = stated || streams || !matches!(self.recording, Recording::Stated);
        let mut threads = graphs.iter().flat_map(|graph| &graph.threads);
        let realtime = threads.any(|thread| !thread.cores.is_empty() || thread.priority.is_some());
        let wanted = [
            ("params", params),
            ("ctrl-c", true),
            ("profile", self.profile.is_some()),
            ("realtime", realtime),
            (made::RECORD, records),
            ("studio", streams),
        ];
        wanted.into_iter().filter(|(_, wanted)| *wanted).map(|(feature, _)| feature).collect()
    }

    /// Makes and builds a package that only drives the program.
    fn make(&self, program: &CheckedProgram, workspace: &Workspace) -> Result<Option<Found>, String> {
        let graph = &program.graph;
        if let Some(node) = graph.nodes.iter().find(|n| matches!(&n.kind, NodeKind::Library(l) if l.handed_in)) {
            return Err(format!(
                "`{}` of `{}` is made in Rust: run the robot from your own program{}",
                node.name,
                graph.name,
                if matches!(self.recording, Recording::Repeated(_)) { ", with `apex_rt::record::replay`" } else { "" }
            ));
        }
        let params = self.watch || self.params.are_wanted();
        let text = absolute(self.file)?;
        let made = Made {
            workspace,
            what: if self.simulated { "simulate" } else { "run" },
            text: &text,
            program: &graph.name,
            features: &self.features(params, &[graph]),
            tools: &[],
            file: "src/main.rs",
            code: &main_file(made::utf8(&text)?, &graph.name, self.simulated, params),
        };
        let turn = Turn::wait(workspace, self.how)?;
        let built = build::build(&made.make()?, build::PROGRAM, self.how)?.program()?;
        Ok(built.map(|built| Found { built, made: Some(made.folder()), _turn: turn }))
    }
}

/// Checks, builds and runs.
pub fn run(wanted: &Wanted<'_>, answer: &mut Answer) -> Result<ExitCode, String> {
    let Some(programs) = wanted.check(answer)? else { return Ok(ExitCode::from(1)) };
    let Some(program) = wanted.build(&programs)? else { return answer.not_built() };
    let mut command = wanted.command(&program);
    command.env_remove(REPORT);
    if answer.is_json() {
        return reported(command, program, answer);
    }
    let Recording::Made(path) = wanted.recording else { return become_program(command, program) };
    let status = wait_for(command, program)?;
    if status.success() && !is_recorded(path) {
        return Err(format!(
            "nothing was recorded to `{}`: your own program records if `apex_rt::run` or `apex_rt::drive` drives it, or with an `apex_rt::record::Recorder`",
            path.display()
        ));
    }
    Ok(exit_code(status))
}

/// Repeats a run and gives its report, which the program writes to a file: its nodes may print, too.
fn reported(mut command: Command, program: Found, answer: &mut Answer) -> Result<ExitCode, String> {
    let file = env::temp_dir().join(format!("apex-replay-{}.json", process::id()));
    command.env(REPORT, &file).stdout(io::stderr());
    let status = wait_for(command, program)?;
    let report = fs::read_to_string(&file);
    let _ = fs::remove_file(&file);
    let Ok(report) = report else { return Err(format!("the program has not reported on the replay: {status}")) };
    let report: Value = serde_json::from_str(&report).map_err(|e| format!("the report cannot be read: {e}"))?;
    answer.give(String::new, || report)?;
    Ok(exit_code(status))
}

/// Returns `true` if there is a recording in `path`, or one that is divided into numbered files.
fn is_recorded(path: &Path) -> bool {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let start = format!("{}.", path.file_stem().unwrap_or_default().to_string_lossy());
    let mut files = fs::read_dir(folder).into_iter().flatten().flatten();
    path.exists() || files.any(|file| file.file_name().to_string_lossy().starts_with(&start))
}

/// Replaces this process by the program, so that signals and exit codes are those of the program.
#[cfg(unix)]
fn become_program(mut command: Command, program: Found) -> Result<ExitCode, String> {
    use std::os::unix::process::CommandExt as _;
    Err(program.not_started(&command.exec()))
}

/// Runs the program, because a process can be replaced only on Unix.
#[cfg(not(unix))]
fn become_program(command: Command, program: Found) -> Result<ExitCode, String> {
    Ok(exit_code(wait_for(command, program)?))
}

/// Runs the program; releases the lock as soon as it has started.
fn wait_for(mut command: Command, program: Found) -> Result<ExitStatus, String> {
    let mut child = command.spawn().map_err(|e| program.not_started(&e))?;
    drop(program);
    child.wait().map_err(|e| format!("cannot wait for the program: {e}"))
}

/// Exit code of a program; after a signal, the code that shells use.
fn exit_code(status: ExitStatus) -> ExitCode {
    #[cfg(unix)]
    let signal = std::os::unix::process::ExitStatusExt::signal(&status).map(|signal| 128 + signal);
    #[cfg(not(unix))]
    let signal = None;
    status.code().or(signal).and_then(|c| u8::try_from(c).ok()).map_or(ExitCode::from(2), ExitCode::from)
}

/// Package that a source file belongs to.
pub fn package(file: &Path) -> Result<PathBuf, String> {
    project::package_of(file).ok_or_else(|| {
        format!("`{}` is not in a cargo package, so its nodes cannot be found; move it to a package that depends on `apex-rt`", file.display())
    })
}

/// The named program, or else the only robot, or else the only graph.
fn choose<'a>(programs: &'a [CheckedProgram], name: Option<&str>) -> Result<&'a CheckedProgram, String> {
    let programs: Vec<&CheckedProgram> = programs.iter().filter(|p| !p.is_test()).collect();
    let names = || programs.iter().map(|p| format!("`{}`", p.graph.name)).collect::<Vec<_>>().join(", ");
    if let Some(name) = name {
        return programs.iter().copied().find(|p| p.graph.name == name).ok_or_else(|| {
            match nearest(name, programs.iter().map(|p| p.graph.name.as_str())) {
                Some(near) => format!("there is no robot or graph `{name}`; did you mean `{near}`?"),
                None => format!("there is no robot or graph `{name}`; the file has {}", names()),
            }
        });
    }
    let robots: Vec<&CheckedProgram> = programs.iter().copied().filter(|p| p.graph.robot).collect();
    match (robots.as_slice(), programs.as_slice()) {
        ([only], _) => Ok(*only),
        ([], [only]) => Ok(*only),
        _ => Err(format!("there are several robots or graphs: choose one with `--robot`: {}", names())),
    }
}

/// Refuses a package whose texts cannot be compiled.
pub fn has_apex(folder: &Path, workspace: &Workspace) -> Result<(), String> {
    let libraries = workspace.libraries();
    match ["apex-rt", "apex-macros"].iter().find(|name| libraries.iter().all(|(library, _)| library != *name)) {
        None => Ok(()),
        Some(name) => {
            let manifest = folder.join("Cargo.toml");
            let manifest = manifest.display();
            Err(format!("the package in `{manifest}` does not depend on `{name}`: add it to `[dependencies]`"))
        }
    }
}

/// Absolute path of a source file, for made packages.
pub fn absolute(file: &Path) -> Result<PathBuf, String> {
    fs::canonicalize(file).map_err(|e| format!("cannot find `{}`: {e}", file.display()))
}

/// Code of the made program. It drives the graph `name` of `file`, with parameters from files if `params` is set.
fn main_file(file: &str, name: &str, simulated: bool, params: bool) -> String {
    let clock = if simulated { "SimClock::until(Time::MAX)" } else { "WallClock::new()" };
    if !params {
        return format!(
            "use apex_macros::graph;\nuse apex_rt::prelude::*;\n\ngraph!({file:?});\n\nfn main() {{\n    run({name}::new(), {clock});\n}}\n"
        );
    }
    format!(
        r#"use apex_macros::graph;
use apex_rt::{{UntilStopped, params::run_with_files, prelude::*}};
use std::{{env, path::PathBuf, process::ExitCode}};

graph!({file:?});

fn drive() -> Result<u8, String> {{
    let file = |name| env::var_os(name).map(PathBuf::from);
    let (load, save, kept) = (file("{LOAD}"), file("{SAVE}"), file("{KEPT}"));
    // Without this clock, Ctrl-C would end the program at once, and nothing would be saved.
    let clock = UntilStopped::ctrl_c({clock})?;
    run_with_files({name}::new(), clock, load.as_deref(), save.as_deref(), kept.as_deref())
}}

fn main() -> ExitCode {{
    match drive() {{
        Ok(code) => ExitCode::from(code),
        Err(message) => {{
            eprintln!("error: {{message}}");
            ExitCode::from(2)
        }}
    }}
}}
"#
    )
}
