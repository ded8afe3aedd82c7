//! Programs that tests generate are compiled by rustc directly, with the libraries that cargo has compiled for the
//! tests.

use serde_json::Value;
use std::{
    env,
    path::{Path, PathBuf},
    process::Command,
};

/// Crates that these programs use.
const USED: [&str; 5] = ["apex_interpret", "apex_macros", "apex_nodes", "apex_rt", "apex_tests"];

/// Compiled libraries. In a package made for a test, cargo would compile all of them again, including the compiler.
pub struct Libraries {
    files: Vec<(String, PathBuf)>,
    /// Folder of their dependencies.
    folder: PathBuf,
}

impl Libraries {
    /// Gets the libraries from cargo, which has compiled them for the tests already. `temporary` is
    /// `env!("CARGO_TARGET_TMPDIR")`, which is in the target folder.
    ///
    /// # Panics
    /// Panics if they cannot be compiled.
    pub fn ask(temporary: &Path) -> Self {
        let mut cargo = apex_host::cargo();
        cargo.args(["build", "--package", "apex-tests", "--lib", "--offline", "--message-format=json", "--target-dir"]);
        cargo.arg(temporary.parent().unwrap_or(temporary)).current_dir(root());
        let output = cargo.output().expect("cargo runs");
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let said = String::from_utf8_lossy(&output.stdout);
        let messages = said.lines().filter_map(|line| serde_json::from_str::<Value>(line).ok());
        let files: Vec<(String, PathBuf)> = messages
            .filter_map(|message| {
                let name = message["target"]["name"].as_str().filter(|name| USED.contains(name))?;
                let mut files = message["filenames"].as_array()?.iter().filter_map(Value::as_str);
                Some((name.to_owned(), files.find(|file| !file.ends_with(".rmeta"))?.into()))
            })
            .collect();
        assert_eq!(files.len(), USED.len(), "cargo has not compiled all of {USED:?}: {files:?}");
        // The requested library is copied to another folder; the runtime is in the same folder as all others.
        let runtime = files.iter().find(|(name, _)| name == "apex_rt");
        let folder = runtime.and_then(|(_, file)| file.parent()).expect("a file lies in a folder").to_owned();
        Self { files, folder }
    }

    /// rustc command for a crate of the package in `package`, with the environment that `graph!` expects from cargo.
    pub fn rustc(&self, package: &Path, name: &str) -> Command {
        let mut command = Command::new(env::var_os("RUSTC").unwrap_or_else(|| "rustc".into()));
        command.env("CARGO_MANIFEST_DIR", package).env("CARGO_CRATE_NAME", name);
        command.args(["--edition=2024", "--crate-name", name]);
        for (name, file) in &self.files {
            command.arg("--extern").arg(format!("{name}={}", file.display()));
        }
        command.arg("-L").arg(format!("dependency={}", self.folder.display()));
        command
    }
}

/// Root of the repository.
pub fn root() -> &'static Path {
    let package = Path::new(env!("CARGO_MANIFEST_DIR"));
    package.parent().unwrap_or(package)
}
