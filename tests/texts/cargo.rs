//! A workspace with a package for each case of a batch.

use apex_host::Workspace;
use apex_tests::{
    Libraries, root,
    texts::{Case, Shape},
};
use rayon::prelude::*;
use serde_json::Value;
use std::{
    fs, io,
    path::{Path, PathBuf},
    process::Command,
    sync::{LazyLock, OnceLock},
    thread,
    time::{Duration, Instant},
};

/// An error of rustc.
#[derive(Debug, Clone)]
pub struct Message {
    /// Code, such as `E0425`.
    pub code: String,
    /// Message.
    pub text: String,
    /// The rendered message.
    pub rendered: String,
    /// `true` if it refers to code that `graph!` generated.
    pub in_graph: bool,
    /// `true` if it points into the source text of the call.
    pub in_text: bool,
}

/// The packages, which are written again for each batch. Cargo is asked once for the metadata of those that are used.
pub struct Packages {
    workspaces: Vec<[OnceLock<Workspace>; 2]>,
}

fn folder() -> PathBuf {
    PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("texts")
}

/// Name of the package of a case.
fn package(slot: usize, shape: Shape) -> String {
    match shape {
        Shape::Library => format!("text{slot}"),
        Shape::Both => format!("both{slot}"),
    }
}

/// Name of the crate that calls `graph!`.
pub fn call_of(slot: usize, shape: Shape) -> String {
    match shape {
        Shape::Library => format!("text{slot}"),
        Shape::Both => format!("main{slot}"),
    }
}

fn write(path: &Path, text: &str) {
    match fs::read_to_string(path) {
        Ok(old) if old == text => {}
        _ => {
            fs::create_dir_all(path.parent().unwrap_or(Path::new("."))).expect("the folder of the texts can be made");
            fs::write(path, text).unwrap_or_else(|e| panic!("cannot write `{}`: {e}", path.display()));
        }
    }
}

fn manifest(slot: usize, shape: Shape) -> String {
    let (name, root) = (package(slot, shape), root().display());
    let binary = match shape {
        Shape::Library => String::new(),
        Shape::Both => format!("[[bin]]\nname = \"main{slot}\"\npath = \"src/main.rs\"\n\n"),
    };
    format!(
        "[package]\nname = \"{name}\"\nversion = \"0.0.0\"\nedition = \"2024\"\n\n{binary}[features]\nfast = []\n\n[dependencies]\n\
         apex-macros = {{ path = {:?} }}\napex-rt = {{ path = {:?}, features = [\"record\"] }}\napex-nodes = {{ path = {:?} }}\n",
        format!("{root}/apex-macros"),
        format!("{root}/apex-rt"),
        format!("{root}/nodes"),
    )
}

const WORKSPACE: &str = "[workspace]
resolver = \"3\"
members = [\"*\"]
exclude = [\"target\"]
";

impl Packages {
    /// Makes `count` packages of each shape.
    pub fn new(count: usize) -> Self {
        let folder = folder();
        let _ = fs::remove_dir_all(&folder);
        write(&folder.join("Cargo.toml"), WORKSPACE);
        for slot in 0..count {
            for shape in [Shape::Library, Shape::Both] {
                let package = folder.join(package(slot, shape));
                write(&package.join("Cargo.toml"), &manifest(slot, shape));
                write(&package.join("src/lib.rs"), "");
                if shape == Shape::Both {
                    write(&package.join("src/main.rs"), "fn main() {}");
                    write(&package.join("src/bin/other.rs"), "fn main() {}");
                }
            }
        }
        fs::copy(root().join("Cargo.lock"), folder.join("Cargo.lock")).expect("there is a lock file");
        // Adds the packages to the lock file. Unlike `metadata`, this downloads nothing for other platforms.
        let made = cargo().args(["update", "--workspace", "--offline"]).output().expect("cargo runs");
        assert!(made.status.success(), "{}", String::from_utf8_lossy(&made.stderr));
        Self { workspaces: vec![<[OnceLock<Workspace>; 2]>::default(); count] }
    }

    /// Writes the files of a case. Returns the folder of its package.
    pub fn write(&self, slot: usize, case: &Case) -> PathBuf {
        let package = folder().join(package(slot, case.shape));
        let _ = fs::remove_dir_all(package.join("src"));
        for (name, text) in case.files() {
            write(&package.join("src").join(name), &text);
        }
        package
    }

    /// Metadata of a package from cargo.
    pub fn workspace(&self, slot: usize, shape: Shape) -> &Workspace {
        self.workspaces[slot][usize::from(shape == Shape::Both)].get_or_init(|| {
            Workspace::load(&folder().join(package(slot, shape))).expect("cargo knows the packages of the texts")
        })
    }
}

fn cargo() -> Command {
    let mut command = apex_host::cargo();
    command.current_dir(folder());
    command
}

static LIBRARIES: LazyLock<Libraries> = LazyLock::new(|| Libraries::ask(Path::new(env!("CARGO_TARGET_TMPDIR"))));

/// Errors of rustc in packages, including their tests.
pub fn check_all(packages: &[(usize, Shape)]) -> Vec<Vec<Message>> {
    packages.par_iter().map(|(slot, shape)| check(&LIBRARIES, *slot, *shape)).collect()
}

/// Errors in one package.
fn check(libraries: &Libraries, slot: usize, shape: Shape) -> Vec<Message> {
    let (folder, name) = (folder().join(package(slot, shape)), package(slot, shape));
    let library = folder.join("lib.rmeta");
    match shape {
        Shape::Library => rustc(libraries, &folder, &name, "lib.rs", &["--test"]),
        Shape::Both => {
            let mut messages = rustc(libraries, &folder, &name, "lib.rs", &["--crate-type", "lib"]);
            if messages.is_empty() {
                let library = format!("{name}={}", library.display());
                let args = ["--test", "--extern", &library];
                messages = rustc(libraries, &folder, &format!("main{slot}"), "main.rs", &args);
            }
            messages
        }
    }
}

/// Compiles the tests of a package that is a library, with the code of a module `interpreted` beside them.
///
/// # Errors
/// Returns what rustc says.
pub fn compile_tests(slot: usize, interpreted: &str) -> Result<PathBuf, String> {
    let (folder, name) = (package_folder(slot), package(slot, Shape::Library));
    let (program, root) = (folder.join("tests"), folder.join("src/tests.rs"));
    let library = fs::read_to_string(folder.join("src/lib.rs")).expect("the case was written");
    write(&root, &format!("{library}\n#[cfg(test)]\nmod interpreted {{ {interpreted} }}\n"));
    let mut command = LIBRARIES.rustc(&folder, &name);
    command.current_dir(&folder).args(["--test", "-o"]).arg(&program).arg(root);
    let output = command.output().expect("rustc runs");
    if output.status.success() { Ok(program) } else { Err(String::from_utf8_lossy(&output.stderr).into_owned()) }
}

/// Folder of the package of a case that is a library.
pub fn package_folder(slot: usize) -> PathBuf {
    folder().join(package(slot, Shape::Library))
}

/// Time limit of a program: far more than its simulated seconds take, also on a busy machine, to detect hangs.
const GUARD: Duration = Duration::from_secs(60);

/// Runs the tests of a program, each time in the same order. Returns what they write, without times; `None` if they do
/// not end.
pub fn run(program: &Path, args: &[&str]) -> Option<String> {
    let (reads, writes) = io::pipe().expect("there is a pipe");
    let mut command = Command::new(program);
    command
        .args(["--test-threads=1"])
        .args(args)
        .env("RUST_BACKTRACE", "0")
        .stdout(writes.try_clone().expect("it has two ends"))
        .stderr(writes);
    let mut child = command.spawn().expect("it starts");
    drop(command);
    let said = thread::spawn(|| io::read_to_string(reads).unwrap_or_default());
    let begin = Instant::now();
    let status = loop {
        match child.try_wait().expect("it can be waited for") {
            Some(status) => break status,
            None if begin.elapsed() > GUARD => {
                let _ = child.kill();
                let _ = child.wait();
                return None;
            }
            None => thread::sleep(Duration::from_millis(10)),
        }
    };
    let said = said.join().unwrap_or_default();
    let lines = said.lines().map(|line| line.split("; finished in").next().unwrap_or(line));
    // The number of the thread differs from run to run.
    let lines = lines.map(|line| if line.starts_with("thread '") { "" } else { line });
    Some(format!("{}\n{:?}", lines.collect::<Vec<_>>().join("\n"), status.code()))
}

fn rustc(libraries: &Libraries, folder: &Path, name: &str, root: &str, args: &[&str]) -> Vec<Message> {
    let source = folder.join("src").join(root);
    let mut command = libraries.rustc(folder, name);
    if root == "main.rs" {
        command.env("CARGO_BIN_NAME", name);
    }
    let out = folder.join(root).with_extension("rmeta");
    command.current_dir(folder).args(["--emit=metadata", "--error-format=json", "-o"]).arg(out).args(args);
    let output = command.arg(&source).output().expect("rustc runs");
    let said = String::from_utf8_lossy(&output.stderr);
    let lines = said.lines().filter_map(|line| serde_json::from_str::<Value>(line).ok());
    let messages: Vec<Message> = lines.filter_map(|value| message(&value, &source)).collect();
    assert!(output.status.success() || !messages.is_empty(), "rustc says nothing of an error:\n{said}");
    messages
}

/// An error in the output of rustc for a crate with this root file.
fn message(message: &Value, source: &Path) -> Option<Message> {
    let text = |value: &Value| value.as_str().unwrap_or_default().to_owned();
    if message["level"] != "error" || text(&message["message"]).starts_with("aborting due to") {
        return None;
    }
    let lines = fs::read_to_string(source).unwrap_or_default();
    let call = lines.lines().position(|l| l.contains("::apex_macros::graph!")).map_or(usize::MAX, |l| l + 1);
    let children = message["children"].as_array().into_iter().flatten().flat_map(|c| c["spans"].as_array());
    let spans: Vec<&Value> = message["spans"].as_array().into_iter().chain(children).flatten().collect();
    let start = |span: &Value| span["line_start"].as_u64().unwrap_or(0) as usize;
    let here = |span: &&Value| source.ends_with(text(&span["file_name"])) && start(span) >= call;
    let in_text =
        |span: &&Value| span["is_primary"] == true && span["line_start"] == span["line_end"] && start(span) > call;
    Some(Message {
        code: text(&message["code"]["code"]),
        text: text(&message["message"]),
        rendered: text(&message["rendered"]),
        in_graph: spans.iter().any(here),
        in_text: spans.iter().any(in_text),
    })
}
