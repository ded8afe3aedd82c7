//! The built command, and folders for it to work in.

use serde_json::Value;
use std::{
    ffi::OsStr,
    fs,
    path::{Path, PathBuf},
    process::{Command, Output},
};

/// A folder outside of any package, which is removed at the end.
pub struct Folder(pub PathBuf);

impl Folder {
    /// An empty folder. The name must be unique in the process.
    pub fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("apex-cli-{}-{name}", std::process::id()));
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    /// The name that it was given.
    pub fn name(&self) -> &str {
        let name = self.0.file_name().and_then(OsStr::to_str).unwrap();
        name.splitn(4, '-').last().unwrap()
    }

    /// Writes a file in it.
    pub fn file(&self, name: &str, text: impl AsRef<[u8]>) -> PathBuf {
        let path = self.0.join(name);
        fs::write(&path, text).unwrap();
        path
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// Settings of all builds in tests, whatever their manifests contain. With equal settings cargo builds the compiler
/// only once, and short runs are not worth optimising.
pub const SETTINGS: [(&str, &str); 4] = [
    ("CARGO_INCREMENTAL", "0"),
    ("CARGO_PROFILE_DEV_DEBUG", "0"),
    ("CARGO_PROFILE_DEV_BUILD_OVERRIDE_OPT_LEVEL", "0"),
    ("CARGO_PROFILE_RELEASE_BUILD_OVERRIDE_OPT_LEVEL", "0"),
];

/// The command, without messages about builds.
pub fn apex() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_apex"));
    command.env("CARGO_TERM_QUIET", "true").envs(SETTINGS);
    command
}

/// Standard error of a command.
pub fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

/// Answer of a command to `--format json`, in the form of docs/json.md.
pub fn answer(output: &Output, command: &str) -> Value {
    let answer: Value = serde_json::from_slice(&output.stdout).expect("there is one JSON value");
    let fields: Vec<&str> = answer.as_object().unwrap().keys().map(String::as_str).collect();
    assert_eq!(fields, ["apex", "command", "error", "form", "messages", "result"]);
    assert_eq!((&answer["form"], &answer["command"]), (&Value::from(1), &Value::from(command)));
    assert_eq!(answer["error"].is_null(), output.status.code() != Some(2));
    answer
}

/// Makes a package with nodes and no program of its own. It has the name of the folder: cargo takes packages of one
/// name that are workspaces of their own for the same if they share a target folder.
pub fn package(folder: &Folder, nodes: &str) {
    let name = folder.name();
    let checkout = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let (macros, runtime) = (checkout.join("apex-macros"), checkout.join("apex-rt"));
    let manifest = format!(
        "[package]\nname = {name:?}\nversion = \"0.0.0\"\nedition = \"2024\"\n[workspace]\n[dependencies]\n\
         apex-macros = {{ path = {macros:?} }}\napex-rt = {{ path = {runtime:?} }}\n"
    );
    folder.file("Cargo.toml", manifest);
    fs::create_dir_all(folder.0.join("src")).unwrap();
    folder.file("src/lib.rs", nodes);
    lock(&folder.0);
}

/// Gives a package the versions of the workspace: the same for all tests, so that they are built once, and downloaded.
pub fn lock(package: &Path) {
    fs::copy(Path::new(env!("CARGO_MANIFEST_DIR")).join("../Cargo.lock"), package.join("Cargo.lock")).unwrap();
}
