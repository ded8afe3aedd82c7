//! `apex studio`: builds and starts a robot, and opens the page on which it can be seen; or opens the page of a study.

mod launched;

use crate::{
    build::How,
    project::{self, print_error},
    replace, run, tune,
};
use apex_diagram::{Item, diagram};
use apex_dsl::{
    fix::applied,
    ide::{ArgumentPlace, set_argument},
};
use apex_host::Workspace;
use apex_studio::{Addresses, ParamChange, Recorded, Remote, Replayed, Robot, Seat, Shadow, Source, Studio, Study};
use apex_tune::Journal;
use launched::Launched;
use std::{
    fs,
    io::{self, IsTerminal as _, Write as _},
    net::SocketAddr,
    path::{Path, PathBuf},
    process::ExitCode,
    sync::{Arc, Mutex, PoisonError},
};

/// A robot that is built and started.
pub struct Launch {
    pub file: PathBuf,
    pub robot: Option<String>,
    pub replay: Option<PathBuf>,
    pub simulated: bool,
    /// `true` for a second robot that gets the inputs of the first one.
    pub shadow: bool,
    pub params: Option<PathBuf>,
    pub args: Vec<String>,
    pub how: How,
}

/// The page.
pub struct Page {
    pub listen: SocketAddr,
    pub read_only: bool,
    pub speed: f64,
}

/// Reads a speed.
pub fn speed(text: &str) -> Result<f64, String> {
    let speed = text.parse().ok().filter(|speed: &f64| *speed > 0.0);
    speed.ok_or_else(|| "a positive number, or `inf` for as fast as possible".to_owned())
}

/// Runs the robot and serves its page until Ctrl-C.
pub fn run(launch: Launch, page: &Page) -> Result<ExitCode, String> {
    let studies = studies(&launch.file);
    let (file, replay) = (Some(launch.file.clone()), launch.replay.clone());
    let text = Arc::new(Text { file, replay, has_params: launch.params.is_some(), errors: Mutex::default() });
    let name = launch.file.display().to_string();
    let recorded = launch.shadow.then(Arc::<Recorded>::default);
    let mut robot = Launched::new(launch, Arc::clone(&text), recorded.clone())?;
    if !robot.build()? {
        return Ok(ExitCode::from(1));
    }
    let mut robots = vec![Seat { name, robot: Box::new(robot), source: Arc::clone(&text) as _, shadow_of: None }];
    if let Some(recorded) = recorded {
        let robot: Box<dyn Robot> = Box::new(Shadow::new(recorded));
        robots.push(Seat { name: "shadow".to_owned(), robot, source: text, shadow_of: Some(0) });
    }
    page.serve(robots, studies, Some(page.speed)).map(|()| ExitCode::SUCCESS)
}

/// Serves a page of the study in a folder until Ctrl-C.
pub fn study(launch: &Launch, page: &Page) -> Result<ExitCode, String> {
    let Launch { file: folder, robot, replay, simulated, shadow, params, args, .. } = launch;
    let of_robots = [
        ("--robot", robot.is_some()),
        ("--replay", replay.is_some()),
        ("--simulated", *simulated),
        ("--shadow", *shadow),
        ("--params", params.is_some()),
        ("--", !args.is_empty()),
    ];
    if let Some((option, _)) = of_robots.iter().find(|(_, is_given)| *is_given) {
        return Err(format!("`{option}` is for robots, and `{}` is the folder of a study", folder.display()));
    }
    if !folder.join(Journal::FILE).is_file() {
        return Err(format!(
            "`{}` is a folder without the journal of a study (`{}`): write the folder in which `apex tune` writes, or a source file",
            folder.display(),
            Journal::FILE
        ));
    }
    let study = Study { name: folder.display().to_string(), folder: folder.to_owned() };
    page.serve(vec![], vec![study], None).map(|()| ExitCode::SUCCESS)
}

/// Studies of the `tune` items of a source file, in the folders in which `apex tune` writes them.
fn studies(file: &Path) -> Vec<Study> {
    let workspace = run::package(file).and_then(|folder| Workspace::load(&folder));
    let (Ok(workspace), Ok(checked)) = (workspace, project::check(file)) else { return vec![] };
    let scripts = checked.programs.iter().filter_map(|program| program.script.as_ref());
    let named = scripts
        .filter(|script| script.study.is_some())
        .map(|script| Study { name: script.name.clone(), folder: tune::default_folder(&workspace, &script.name) });
    named.filter(|study| study.folder.join(Journal::FILE).is_file()).collect()
}

/// Serves a page of robots that run already until Ctrl-C. `file` has their text.
pub fn connect(addresses: Vec<String>, file: Option<PathBuf>, page: &Page) -> Result<ExitCode, String> {
    if let Some(file) = &file {
        project::check(file)?.print_diagnostics();
    }
    let seat = |address: String| {
        let text = Text { file: file.clone(), replay: None, has_params: false, errors: Mutex::default() };
        Seat { name: address.clone(), robot: Box::new(Remote { address }), source: Arc::new(text), shadow_of: None }
    };
    let studies = file.as_deref().map(studies).unwrap_or_default();
    page.serve(addresses.into_iter().map(seat).collect(), studies, None).map(|()| ExitCode::SUCCESS)
}

/// Shows a robot in the terminal.
pub fn top(address: String) -> Result<ExitCode, String> {
    if !io::stdout().is_terminal() {
        return Err("`apex top` needs a terminal".to_owned());
    }
    apex_studio::top(Remote { address }).map_err(|error| format!("cannot use the terminal: {error}"))?;
    Ok(ExitCode::SUCCESS)
}

impl Page {
    fn serve(&self, robots: Vec<Seat>, studies: Vec<Study>, speed: Option<f64>) -> Result<(), String> {
        let has_robot = !robots.is_empty();
        let studio = Studio { robots, studies, address: self.listen, readonly: self.read_only, speed };
        let opened = |Addresses { page, foxglove }: &Addresses| {
            let foxglove = if has_robot { format!("Foxglove: {foxglove}\n") } else { String::new() };
            print_error(&format!("studio: {page}\n{foxglove}Ctrl-C ends it"));
        };
        studio.serve(opened).map_err(|error| {
            format!("cannot open the page at {}: {error}; choose another address with `--listen`", self.listen)
        })
    }
}

/// The source file.
struct Text {
    /// Its path; `None` for a robot whose text is not at hand.
    file: Option<PathBuf>,
    /// Recording that the robot repeats.
    replay: Option<PathBuf>,
    /// `true` if the robot begins with the parameters of a file.
    has_params: bool,
    /// Its errors, for which a changed robot is not started.
    errors: Mutex<Option<String>>,
}

impl Text {
    /// Path of a source file. Robots name those that the compiler was given, from a folder around the package.
    fn find(&self, file: &str) -> Option<PathBuf> {
        let is_text = Path::new(file).extension().is_some_and(|e| e == "afg" || e == "rs");
        let package = project::package_of(self.file.as_ref()?).unwrap_or_default();
        let mut places = package.ancestors().map(|folder| folder.join(file)).filter(|path| is_text && path.is_file());
        places.next()
    }

    /// Path of the source file of the robot.
    fn main_file(&self) -> Result<&Path, String> {
        self.file.as_deref().ok_or_else(|| "there is no source file: start the studio with one".to_owned())
    }

    /// Path of a source file that may be changed: one in the package of the robot.
    fn own(&self, file: &str) -> Option<PathBuf> {
        let path = fs::canonicalize(self.find(file)?).ok()?;
        let own = fs::canonicalize(self.file.as_ref()?).ok()?;
        let folder = project::package_of(&own).or_else(|| Some(own.parent()?.to_owned()))?;
        path.starts_with(fs::canonicalize(folder).ok()?).then_some(path)
    }

    fn set_errors(&self, errors: Option<String>) {
        *self.errors.lock().unwrap_or_else(PoisonError::into_inner) = errors;
    }
}

impl Source for Text {
    fn picture(&self, name: &str) -> Option<Item> {
        let checked = project::check(self.file.as_ref()?).ok()?;
        let mut graphs = checked.programs.iter().map(|program| &program.graph).chain(&checked.parts);
        let graph = graphs.find(|graph| graph.name == name)?;
        Some(diagram(graph, &checked.texts.machines, &checked.catalog))
    }

    fn errors(&self) -> Option<String> {
        self.errors.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    fn save_params(&self, params: &str) -> Result<String, String> {
        let head = "# Parameters that were changed in `apex studio`, for `--params`.\n";
        let names = (1..).map(|n| if n == 1 { "params.toml".to_owned() } else { format!("params-{n}.toml") });
        let own = self.main_file()?;
        create(names.map(|end| own.with_extension(end)), &[head, params]).map(|path| path.display().to_string())
    }

    fn replayed(&self) -> Result<Option<Replayed>, String> {
        if self.has_params {
            return Err("a test has the parameters of the source, and the robot began with those of a file".to_owned());
        }
        let Some(replay) = &self.replay else { return Ok(None) };
        let folder = self.main_file()?.canonicalize().ok().and_then(|file| Some(file.parent()?.to_path_buf()));
        let path = replay.canonicalize().map_err(|e| format!("cannot find `{}`: {e}", replay.display()))?;
        let inside = folder.and_then(|folder| Some(path.strip_prefix(folder).ok()?.to_path_buf()));
        let file = inside.unwrap_or_else(|| path.clone()).display().to_string();
        recorded(&path, file).map(Some).map_err(|why| format!("cannot read `{}`: {why}", path.display()))
    }

    fn write_test(&self, program: &str, test: &str) -> Result<String, String> {
        let own = self.main_file()?;
        let module = own.file_stem().and_then(|stem| stem.to_str()).ok_or("the source file has no name")?;
        let text = format!("//! A moment in a run of `{program}`.\nuse {module}::{program};\n\n{test}");
        let name = |n: u32| if n == 1 { format!("{module}_moment.afg") } else { format!("{module}_moment_{n}.afg") };
        let path = create((1..).map(|n| own.with_file_name(name(n))), &[&text])?;
        let checked = project::check(&path)?;
        if checked.diagnostics.has_errors() {
            // Nothing that does not work stays.
            let _ = fs::remove_file(&path);
            return Err(checked.rendered());
        }
        Ok(path.display().to_string())
    }

    fn write_param(&self, change: &ParamChange<'_>) -> Result<String, String> {
        let path = self.find(change.file).ok_or_else(|| format!("there is no file `{}`", change.file))?;
        let shown = path.display();
        let text = fs::read_to_string(&path).map_err(|e| format!("cannot read `{shown}`: {e}"))?;
        let ParamChange { line, node, param, unit, value, .. } = *change;
        let fix = set_argument(&text, ArgumentPlace { node, line, param, unit }, value)?;
        replace::write(&path, &applied(&text, &fix))?;
        Ok(format!("{shown}:{line}"))
    }

    fn texts(&self, files: &[String]) -> Vec<String> {
        let read = |file: &String| fs::read_to_string(self.find(file)?).ok();
        files.iter().map(|file| read(file).unwrap_or_default()).collect()
    }

    fn path(&self, file: &str) -> Option<PathBuf> {
        self.own(file)
    }

    fn write_text(&self, file: &str, text: &str) -> Result<(), String> {
        let path = self.own(file).ok_or_else(|| format!("`{file}` does not belong to the package of the robot"))?;
        replace::replace(&path, text).map_err(|error| format!("cannot write `{}`: {error}", path.display()))
    }
}

/// Reads the summary of a recording: the channels that have tokens, and the times of its first and last message.
fn recorded(path: &Path, file: String) -> Result<Replayed, String> {
    let bytes = fs::read(path).map_err(|error| error.to_string())?;
    let summary = mcap::Summary::read(&bytes).map_err(|error| error.to_string())?.unwrap_or_default();
    // A file that was cut off has no statistics.
    let stats = summary.stats.ok_or("it is incomplete")?;
    let has_tokens = |id: &u16| stats.channel_message_counts.get(id).is_some_and(|count| *count > 0);
    let channels = summary.channels.iter().filter(|(id, _)| has_tokens(id)).map(|(_, c)| c.topic.clone()).collect();
    let time = |time: u64| i64::try_from(time).ok();
    let range = time(stats.message_start_time).zip(time(stats.message_end_time)).filter(|_| stats.message_count > 0);
    Ok(Replayed { file, channels, range })
}

/// Writes `parts` to the first of these files that does not exist. Returns its path.
fn create(mut paths: impl Iterator<Item = PathBuf>, parts: &[&str]) -> Result<PathBuf, String> {
    loop {
        let path = paths.next().ok_or("there is no free name")?;
        let error = match fs::File::create_new(&path) {
            Ok(mut file) => match parts.iter().try_for_each(|part| file.write_all(part.as_bytes())) {
                Ok(()) => return Ok(path),
                Err(error) => error,
            },
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => continue,
            Err(error) => error,
        };
        return Err(format!("cannot write `{}`: {error}", path.display()));
    }
}
