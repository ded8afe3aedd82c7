//! `apex run`: the package's own program, or one that is made for the text.

use crate::{project, replace::is_same};
use apex_dsl::{
    graph::{Graph, NodeKind},
    passes::Program,
    report::nearest,
    syntax::MAX_BYTES,
};
use apex_host::{Workspace, cargo, no_cargo, read_text};
use std::{
    env,
    ffi::OsString,
    fs,
    io::{self, IsTerminal, Read as _},
    path::{Path, PathBuf},
    process::{Command, ExitCode},
};

/// Files with the parameters of the program that is run.
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

    /// Says before a build what would be wrong after it.
    fn look(&self, text: &Path) -> Result<(), String> {
        let shown = |path: &Path| path.display().to_string();
        if let Some(load) = &self.load {
            read_text(load, MAX_BYTES).map_err(|reason| format!("cannot read `{}`: {reason}", shown(load)))?;
        }
        let Some(save) = &self.save else { return Ok(()) };
        if is_same(save, text) {
            return Err(format!("the parameters would overwrite the text `{}`: name another file", shown(save)));
        }
        if save.exists() && !save.is_file() {
            return Err(format!("cannot write `{}`: it is no file, which could be replaced", shown(save)));
        }
        has_folder(save).map_err(|e| format!("cannot write `{}`: {e}", shown(save)))
    }
}

/// Whether a file could be made: the folder is there.
fn has_folder(file: &Path) -> Result<(), String> {
    match file.parent().filter(|folder| !folder.as_os_str().is_empty() && !folder.is_dir()) {
        Some(folder) => Err(format!("there is no folder `{}`", folder.display())),
        None => Ok(()),
    }
}

/// The variables by which the made program, whose arguments belong to the nodes, learns the files.
const LOAD: &str = "APEX_PARAMS";
const SAVE: &str = "APEX_SAVE_PARAMS";
const KEPT: &str = "APEX_KEPT_PARAMS";
/// The variable by which every program learns where its profile is written (`apex_rt::drive`).
const PROFILE: &str = "APEX_PROFILE";

/// The variables by which every program learns which recording it makes or repeats (`apex_rt::drive`).
const RECORD: &str = "APEX_RECORD";
const REPLAY: &str = "APEX_REPLAY";

/// What is to be done with a recording.
#[derive(Clone, Copy, Default)]
pub enum Recording<'a> {
    /// What the text says.
    #[default]
    Stated,
    /// The run is recorded in this file.
    Made(&'a Path),
    /// The run in this file is repeated.
    Repeated(&'a Path),
}

/// The feature of programs that can be recorded, and the library whose types then are messages.
pub const RECORDS: &str = "record";
const NODES: &str = "apex-nodes";

/// How an MCAP file begins.
const MAGIC: &[u8; 8] = b"\x89MCAP0\r\n";

impl Recording<'_> {
    /// Says before a build what would be wrong after it.
    fn look(self) -> Result<(), String> {
        match self {
            Self::Stated => Ok(()),
            Self::Made(path) if path.is_dir() => {
                Err(format!("cannot record to `{}`: it is a folder; name a file in it", path.display()))
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
                    Ok(()) => what("it is no MCAP file, or its beginning is damaged"),
                    Err(error) if error.kind() == io::ErrorKind::UnexpectedEof => {
                        what("it is empty, or was cut off before anything was recorded")
                    }
                    Err(error) => what(&error.to_string()),
                }
            }
        }
    }
}

/// What is to be run.
pub struct Wanted<'a> {
    /// The text.
    pub file: &'a Path,
    /// Which robot or graph, if the text has several.
    pub robot: Option<&'a str>,
    /// Its parameters.
    pub params: &'a Params,
    /// Where its profile is written.
    pub profile: Option<&'a Path>,
    /// What is recorded or repeated.
    pub recording: Recording<'a>,
    /// Arguments for the program.
    pub args: &'a [String],
    /// Whether it is built again and again, and what it changed in its parameters is kept.
    pub watch: bool,
}

/// A program as cargo finds it.
pub struct Found {
    /// What says it to cargo.
    select: Vec<OsString>,
    /// Where cargo is called.
    folder: PathBuf,
    /// Where cargo builds it.
    target: PathBuf,
    /// The folder of the package, if it was made for the text.
    pub made: Option<PathBuf>,
}

impl Found {
    /// `cargo run` or `cargo build`.
    pub fn cargo(&self, verb: &str) -> Command {
        say_if_first(&self.target.join("release"));
        let mut command = cargo();
        command.args([verb, "--release", "--quiet"]).args(&self.select).current_dir(&self.folder);
        command
    }
}

impl Wanted<'_> {
    /// Gives a program that is about to start what it gets.
    pub fn tell(&self, program: &Found, command: &mut Command) {
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
        let Some(made) = &program.made else { return };
        let kept = self.watch.then(|| made.join("kept"));
        for (name, path) in [(LOAD, &self.params.load), (SAVE, &self.params.save), (KEPT, &kept)] {
            match path {
                Some(path) => command.env(name, path),
                None => command.env_remove(name),
            };
        }
    }

    /// Checks the text and finds its program; `None` if the text has errors, which are printed.
    pub fn find(&self) -> Result<Option<Found>, String> {
        let checked = project::check(self.file)?;
        checked.print_diagnostics();
        if checked.diagnostics.has_errors() {
            return Ok(None);
        }
        self.params.look(self.file)?;
        self.recording.look()?;
        let folder = package(self.file)?;
        let workspace = Workspace::load(&folder)?;
        has_runtime(&folder, &workspace)?;
        let (package, binary) = workspace.binary();
        // A program of one's own may have a loop of its own, which repeats nothing.
        let repeats = matches!(self.recording, Recording::Repeated(_));
        match binary.filter(|_| self.robot.is_none() && !repeats) {
            Some(binary) if self.params.are_wanted() => Err(format!(
                "`--params` and `--save-params` are for programs that are made for the text, but `{binary}` is a program of its own: leave them out, or choose a robot with `--robot`"
            )),
            Some(binary) => {
                let mut select = ["--package", package, "--bin", binary].map(OsString::from).to_vec();
                let graphs: Vec<&Graph> = checked.programs.iter().map(|p| &p.graph).collect();
                for feature in self.features(false, &graphs) {
                    select.extend(["--features".into(), format!("apex-rt/{feature}").into()]);
                    if feature == RECORDS && workspace.libraries().iter().any(|(name, _)| *name == NODES) {
                        select.extend(["--features".into(), format!("{NODES}/{feature}").into()]);
                    }
                }
                Ok(Some(Found { select, folder, target: workspace.target, made: None }))
            }
            None => self.make(choose(&checked.programs, self.robot)?, &workspace).map(Some),
        }
    }

    /// The features of the runtime that a program of one of `graphs` needs.
    fn features(&self, params: bool, graphs: &[&Graph]) -> Vec<&'static str> {
        let stated = graphs.iter().any(|graph| graph.record.is_some());
        let records = stated || !matches!(self.recording, Recording::Stated);
        let mut threads = graphs.iter().flat_map(|graph| &graph.threads);
        let realtime = threads.any(|thread| !thread.cores.is_empty() || thread.priority.is_some());
        let wanted = [
            ("params", params),
            ("ctrl-c", params),
            ("profile", self.profile.is_some()),
            ("realtime", realtime),
            (RECORDS, records),
        ];
        wanted.into_iter().filter(|(_, wanted)| *wanted).map(|(feature, _)| feature).collect()
    }

    /// Makes a package whose only job is to drive the program.
    fn make(&self, program: &Program, workspace: &Workspace) -> Result<Found, String> {
        let graph = &program.graph;
        if let Some(node) = graph.nodes.iter().find(|n| matches!(&n.kind, NodeKind::Library(l) if l.handed_in)) {
            return Err(format!(
                "`{}` of `{}` is made in Rust: run it from a program of your own{}",
                node.name,
                graph.name,
                if matches!(self.recording, Recording::Repeated(_)) { ", with `apex_rt::record::replay`" } else { "" }
            ));
        }
        let params = self.watch || self.params.are_wanted();
        let made = workspace.cache_folder().join("run").join(&graph.name);
        let main = main_file(&absolute(self.file)?, &graph.name, params);
        let manifest = make_package(&made, workspace, &self.features(params, &[graph]), "src/main.rs", &main)?;
        let target = workspace.target.join("apex/run");
        let select = ["--manifest-path".into(), manifest.into(), "--target-dir".into(), target.clone().into()].to_vec();
        // Files are named as the user sees them.
        let folder = env::current_dir().map_err(|e| format!("cannot see the current folder: {e}"))?;
        Ok(Found { select, folder, target, made: Some(made) })
    }
}

/// Checks, builds and runs.
pub fn run(wanted: &Wanted<'_>) -> Result<ExitCode, String> {
    let Some(program) = wanted.find()? else { return Ok(ExitCode::from(1)) };
    let mut command = program.cargo("run");
    command.arg("--");
    wanted.tell(&program, &mut command);
    let status = command.status().map_err(|e| no_cargo(&e))?;
    if let Recording::Made(path) = wanted.recording
        && status.success()
        && !path.exists()
    {
        return Err(format!(
            "nothing was recorded to `{}`: a program of your own records if `apex_rt::run` or `apex_rt::drive` drives it, or with an `apex_rt::record::Recorder`",
            path.display()
        ));
    }
    Ok(status.code().and_then(|c| u8::try_from(c).ok()).map_or(ExitCode::from(2), ExitCode::from))
}

/// The package that a text belongs to.
pub fn package(file: &Path) -> Result<PathBuf, String> {
    project::package_of(file).ok_or_else(|| {
        format!("`{}` is in no cargo package, so that its nodes cannot be found; put it beside a Cargo.toml that depends on `apex-rt`", file.display())
    })
}

/// The program that is meant: the named one, the only robot, or the only graph.
fn choose<'a>(programs: &'a [Program], name: Option<&str>) -> Result<&'a Program, String> {
    let programs: Vec<&Program> = programs.iter().filter(|p| p.script.is_none()).collect();
    let names = || programs.iter().map(|p| format!("`{}`", p.graph.name)).collect::<Vec<_>>().join(", ");
    if let Some(name) = name {
        return programs.iter().copied().find(|p| p.graph.name == name).ok_or_else(|| {
            match nearest(name, programs.iter().map(|p| p.graph.name.as_str())) {
                Some(near) => format!("there is no robot or graph `{name}`; did you mean `{near}`?"),
                None => format!("there is no robot or graph `{name}`; there are {}", names()),
            }
        });
    }
    let robots: Vec<&Program> = programs.iter().copied().filter(|p| p.graph.robot).collect();
    match (robots.as_slice(), programs.as_slice()) {
        ([only], _) => Ok(*only),
        ([], [only]) => Ok(*only),
        _ => Err(format!("which one is to run? choose with `--robot`: {}", names())),
    }
}

/// Where nothing has been built yet, cargo, which is quiet, seems to hang: a person is told.
pub fn say_if_first(target: &Path) {
    if !target.exists() && io::stderr().is_terminal() {
        project::print_error("building for the first time, which takes a minute or two");
    }
}

/// Refuses a package whose texts cannot be compiled.
pub fn has_runtime(folder: &Path, workspace: &Workspace) -> Result<(), String> {
    if workspace.libraries().iter().any(|(name, _)| *name == "apex-rt") {
        return Ok(());
    }
    let manifest = folder.join("Cargo.toml");
    Err(format!("the package in `{}` does not depend on `apex-rt`: add it to `[dependencies]`", manifest.display()))
}

/// The whole path of a text, as a made package names it.
pub fn absolute(file: &Path) -> Result<PathBuf, String> {
    fs::canonicalize(file).map_err(|e| format!("cannot find `{}`: {e}", file.display()))
}

/// Makes a package in `folder` that depends on everything a text can name, and on the runtime with these features, with
/// one file; returns its manifest.
pub fn make_package(
    folder: &Path,
    workspace: &Workspace,
    features: &[&str],
    name: &str,
    code: &str,
) -> Result<PathBuf, String> {
    let dependencies: String = workspace
        .libraries()
        .iter()
        .map(|(name, path)| match *name {
            NODES if features.contains(&RECORDS) => {
                format!("{name} = {{ path = {path:?}, features = [{RECORDS:?}] }}\n")
            }
            "apex-rt" => format!("{name} = {{ path = {path:?}, features = {features:?} }}\n"),
            _ => format!("{name} = {{ path = {path:?} }}\n"),
        })
        .collect();
    // Cargo tells packages of one name apart by what they are made of only: the program of another text would count as up
    // to date.
    let made_for = folder.file_name().unwrap_or_default().to_string_lossy().to_lowercase();
    let made_for = made_for.replace(|c: char| !c.is_ascii_alphanumeric(), "_");
    let manifest = format!(
        "[package]\nname = \"apex-run-{made_for}\"\nversion = \"0.0.0\"\nedition = \"2024\"\n\n[workspace]\n\n[profile.dev.build-override]\nopt-level = 2\n\n[dependencies]\n{dependencies}"
    );
    let write = |path: PathBuf, text: &str| {
        let same = fs::read_to_string(&path).is_ok_and(|old| old == text);
        let result = if same {
            Ok(())
        } else {
            fs::create_dir_all(path.parent().unwrap_or(Path::new("."))).and_then(|()| fs::write(&path, text))
        };
        result.map_err(|e| format!("cannot write `{}`: {e}", path.display()))
    };
    write(folder.join("Cargo.toml"), &manifest)?;
    write(folder.join(name), code)?;
    Ok(folder.join("Cargo.toml"))
}

/// The code of the made program: it drives the graph `name` of `file`, with parameters from files if they are wanted.
fn main_file(file: &Path, name: &str, params: bool) -> String {
    if !params {
        return format!(
            "use apex_rt::prelude::*;\n\ngraph!({file:?});\n\nfn main() {{\n    run({name}::new(), WallClock::new());\n}}\n"
        );
    }
    format!(
        r#"use apex_rt::{{UntilStopped, params::run_with_files, prelude::*}};
use std::{{env, path::PathBuf, process::ExitCode}};

graph!({file:?});

fn drive() -> Result<u8, String> {{
    let file = |name| env::var_os(name).map(PathBuf::from);
    let (load, save, kept) = (file("{LOAD}"), file("{SAVE}"), file("{KEPT}"));
    // Without it the program would end at once, and nothing would be saved.
    let clock = UntilStopped::ctrl_c(WallClock::new())?;
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
