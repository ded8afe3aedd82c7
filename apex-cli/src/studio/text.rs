//! The source file of a robot, as the studio reads and changes it. What a robot says of its files and values is checked
//! first: robots are programs of others.

use crate::{
    project, replace,
    watch::{files::Files, folders},
};
use apex_bag::Contents;
use apex_diagram::{Item, diagram};
use apex_dsl::{
    report::Diagnostics,
    source::Sources,
    syntax::{
        parse,
        tree::{Expr, ExprKind, Instance, NodeBody},
    },
};
use apex_ide::{ArgumentPlace, fix::applied, set_argument};
use apex_studio::{ParamChange, Replayed, Source};
use std::{
    collections::BTreeMap,
    fs,
    io::{self, Write as _},
    path::{Path, PathBuf},
    sync::{Mutex, OnceLock, PoisonError},
};

/// The source file of a robot.
pub struct Text {
    /// Its path; `None` for a robot whose text is not at hand.
    file: Option<PathBuf>,
    /// Recording that the robot repeats.
    replay: Option<PathBuf>,
    /// `true` if the robot begins with the parameters of a file.
    has_params: bool,
    /// Its errors, for which a changed robot is not started.
    errors: Mutex<Option<String>>,
    /// Folders of its package, and of the libraries in which its source files may be.
    folders: OnceLock<Vec<PathBuf>>,
    pictures: Mutex<Pictures>,
}

/// Pictures of graphs, as long as the files are the same: the compiler draws each once, however many pages show it.
#[derive(Default)]
struct Pictures {
    files: Option<Files>,
    by_name: BTreeMap<String, Option<Item>>,
}

/// Maximum number of pictures. Robots name the graphs.
const MAX_PICTURES: usize = 16;

impl Text {
    /// `replay` is the recording that the robot repeats; `has_params` is `true` if it begins with the parameters of a
    /// file.
    pub fn new(file: Option<PathBuf>, replay: Option<PathBuf>, has_params: bool) -> Self {
        let (errors, folders, pictures) = (Mutex::default(), OnceLock::new(), Mutex::default());
        Self { file, replay, has_params, errors, folders, pictures }
    }

    /// Folders of its package and of the libraries of that.
    fn folders(&self) -> &[PathBuf] {
        let of = |file: &PathBuf| folders(file).ok();
        self.folders.get_or_init(|| self.file.as_ref().and_then(of).unwrap_or_default())
    }

    /// Path of a source file of the package or of one of its libraries. Robots name the files that the compiler was
    /// given, from a folder around the package; and robots are programs of others, which may name any file.
    fn find(&self, file: &str) -> Option<PathBuf> {
        let is_text = Path::new(file).extension().is_some_and(|e| e == "afg" || e == "rs");
        let package = project::package_of(self.file.as_ref()?).unwrap_or_default();
        let mut places = package.ancestors().map(|folder| folder.join(file)).filter(|path| is_text && path.is_file());
        let path = fs::canonicalize(places.next()?).ok()?;
        let is_own = self.folders().iter().any(|folder| path.starts_with(folder));
        (is_own || self.belongs(&path)).then_some(path)
    }

    /// `true` for a file in the package of the robot.
    fn belongs(&self, path: &Path) -> bool {
        let folder = || {
            let own = fs::canonicalize(self.file.as_ref()?).ok()?;
            let folder = project::package_of(&own).or_else(|| Some(own.parent()?.to_owned()))?;
            fs::canonicalize(folder).ok()
        };
        folder().is_some_and(|folder| path.starts_with(folder))
    }

    /// Path of the source file of the robot.
    fn main_file(&self) -> Result<&Path, String> {
        self.file.as_deref().ok_or_else(|| "there is no source file: start the studio with one".to_owned())
    }

    /// Path of a source file that may be changed: one in the package of the robot.
    fn own(&self, file: &str) -> Result<PathBuf, String> {
        let path = self.find(file).filter(|path| self.belongs(path));
        path.ok_or_else(|| format!("`{file}` is not a source file in the package of the robot"))
    }

    pub fn set_errors(&self, errors: Option<String>) {
        *self.errors.lock().unwrap_or_else(PoisonError::into_inner) = errors;
    }
}

impl Source for Text {
    fn picture(&self, name: &str) -> Option<Item> {
        let mut pictures = self.pictures.lock().unwrap_or_else(PoisonError::into_inner);
        let files = Some(Files::below(self.folders()));
        if pictures.files != files || pictures.by_name.len() >= MAX_PICTURES {
            *pictures = Pictures { files, ..Pictures::default() };
        }
        // Whoever asks for it meanwhile waits for this one.
        pictures.by_name.entry(name.to_owned()).or_insert_with(|| picture(self.file.as_ref()?, name)).clone()
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
        let path = self.own(change.file)?;
        let shown = path.display();
        let text = fs::read_to_string(&path).map_err(|e| format!("cannot read `{shown}`: {e}"))?;
        let ParamChange { line, node, param, unit, value, .. } = *change;
        is_argument(param, &format!("{value}{}", unit.unwrap_or_default()))?;
        let fix = set_argument(&text, ArgumentPlace { node, line, param, unit }, value)?;
        replace::write(&path, &applied(&text, &fix))?;
        Ok(format!("{shown}:{line}"))
    }

    fn texts(&self, files: &[String]) -> Vec<String> {
        let read = |file: &String| fs::read_to_string(self.find(file)?).ok();
        files.iter().map(|file| read(file).unwrap_or_default()).collect()
    }

    fn path(&self, file: &str) -> Option<PathBuf> {
        self.own(file).ok()
    }

    fn write_text(&self, file: &str, text: &str) -> Result<(), String> {
        let path = self.own(file)?;
        replace::replace(&path, text).map_err(|error| format!("cannot write `{}`: {error}", path.display()))
    }
}

/// The picture of a graph of a source file.
fn picture(file: &Path, name: &str) -> Option<Item> {
    let checked = project::check(file).ok()?;
    let mut graphs = checked.programs.iter().map(|program| &program.graph).chain(&checked.parts);
    let graph = graphs.find(|graph| graph.name == name)?;
    Some(diagram(graph, &checked.texts.machines, &checked.catalog))
}

/// Checks that a robot tells the name of a parameter, and a value that the language can express: a plain one, and
/// nothing after it.
fn is_argument(param: &str, value: &str) -> Result<(), String> {
    let text = format!("graph G {{ node n = N({param} = {value}); }}");
    let (mut sources, mut diagnostics) = (Sources::default(), Diagnostics::default());
    let file = parse(sources.add("value.afg", text.as_str()), &text, &mut diagnostics);
    let instance = match (file.graphs.as_slice(), file.graphs.first().map(|graph| graph.nodes.as_slice())) {
        ([_], Some([node])) if !diagnostics.has_errors() => Some(&node.body),
        _ => None,
    };
    match instance {
        Some(NodeBody::Instance(Instance { args, modifiers, .. })) if modifiers.is_empty() => match args.as_slice() {
            [arg] if arg.name.as_ref().is_some_and(|name| name.text == param) && is_plain(&arg.value) => Ok(()),
            _ => Err(format!("the source cannot have the value `{value}`: it is not a plain one")),
        },
        _ => Err(format!("the source cannot have the value `{value}` of `{param}`: the language does not know it")),
    }
}

/// `true` for a number, a text, a truth value, and a list of these.
fn is_plain(value: &Expr) -> bool {
    match &value.kind {
        ExprKind::Number(..) | ExprKind::Text(_) | ExprKind::Bool(_) => true,
        ExprKind::Unary("-", inner) => matches!(inner.kind, ExprKind::Number(..)),
        ExprKind::List(elements) => elements.iter().all(is_plain),
        _ => false,
    }
}

/// Reads a recording: the channels that have tokens, and the times of its first and last message.
fn recorded(path: &Path, file: String) -> Result<Replayed, String> {
    let Contents { topics, times, cut, .. } = Contents::read(path).map_err(|error| error.to_string())?;
    if let Some(cut) = cut {
        return Err(format!("it is incomplete: {cut}"));
    }
    let channels = topics.into_iter().filter(|topic| topic.count > 0).map(|topic| topic.channel.name).collect();
    let time = |time: u64| i64::try_from(time).ok();
    let range = times.and_then(|(first, last)| time(first).zip(time(last)));
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_plain_values_become_text() {
        for value in ["1", "-2.5", "1.5m", "true", "\"a \\\" b\"", "[1, -2.0]", "0.25", "1e-5"] {
            assert_eq!(is_argument("gain", value), Ok(()), "{value}");
        }
        let others = [
            "1) every 7ms; node evil = Pulse(boom = 1",
            "1, boom = 2",
            "1 /*",
            "1 //",
            "EVIL",
            "std::process::exit(1)",
            "1 + 1",
            "",
            "nan",
            "1); } graph H { node n = N(x = 1",
            "1 every 7ms",
        ];
        for value in others {
            assert!(is_argument("gain", value).is_err(), "{value}");
        }
        assert!(is_argument("gain = 1, boom", "1").is_err() && is_argument("", "1").is_err());
    }

    /// A package with a robot, in a folder that has another file beside it.
    fn package(name: &str) -> (PathBuf, Text) {
        let folder = std::env::temp_dir().join(format!("apex-text-{}-{name}", std::process::id()));
        fs::create_dir_all(folder.join("robot/src")).unwrap();
        let manifest = "[package]\nname = \"robot\"\nversion = \"0.0.0\"\n[workspace]\n";
        let robot = "graph G {\n    in  x: u8;\n    out y: u8;\n    node pulse = Pulse();\n    x -> y;\n}\n";
        for (file, text) in [
            ("robot/Cargo.toml", manifest),
            ("robot/src/lib.rs", ""),
            ("robot/robot.afg", robot),
            ("outside.afg", robot),
            ("robot/secret.txt", "secret"),
        ] {
            fs::write(folder.join(file), text).unwrap();
        }
        let text = Text::new(Some(folder.join("robot/robot.afg")), None, false);
        (folder, text)
    }

    #[cfg(unix)]
    #[test]
    fn a_robot_names_no_files_outside_of_its_package() {
        let (folder, text) = package("outside");
        std::os::unix::fs::symlink(folder.join("outside.afg"), folder.join("robot/link.afg")).unwrap();
        let outside = folder.join("outside.afg").display().to_string();
        let change = |file: &str| {
            text.write_param(&ParamChange { file, line: 4, node: "pulse", param: "gain", unit: None, value: "2.5" })
        };
        for file in [outside.as_str(), "outside.afg", "../outside.afg", "link.afg", "/etc/passwd", "secret.txt", ""] {
            assert_eq!(text.texts(&[file.to_owned()]), [""], "{file}");
            assert!(change(file).is_err_and(|error| error.contains("in the package of the robot")), "{file}");
            assert!(text.path(file).is_none() && text.write_text(file, "x").is_err(), "{file}");
        }
        assert!(!fs::read_to_string(&outside).unwrap().contains("gain"));
        assert!(change("robot.afg").is_ok_and(|place| place.ends_with("robot.afg:4")));
        assert!(text.texts(&["robot.afg".to_owned()])[0].contains("Pulse(gain = 2.5)"));
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn a_picture_is_drawn_once_for_each_text() {
        let (folder, text) = package("drawn");
        assert!(text.picture("G").is_some_and(|picture| picture.name == "G"));
        // What is there already is not drawn again, and that is what all pages get.
        text.pictures.lock().unwrap().by_name.get_mut("G").unwrap().as_mut().unwrap().name = "known".to_owned();
        assert!(text.picture("G").is_some_and(|picture| picture.name == "known"));
        fs::write(
            folder.join("robot/robot.afg"),
            "graph G {\n    in  longer: u8;\n    out y: u8;\n    longer -> y;\n}\n",
        )
        .unwrap();
        assert!(text.picture("G").is_some_and(|picture| picture.name == "G"));
        fs::remove_dir_all(folder).unwrap();
    }
}
