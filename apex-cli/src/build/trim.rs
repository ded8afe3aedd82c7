//! Programs without the paths of the machine that has built them, for those that are handed on.

use super::wanted::Wanted;
use crate::project::print_error;
use apex_host::cargo;
use serde_json::Value;
use std::{
    env, fs,
    path::{Path, PathBuf},
    process::Command,
};

/// Folders whose names are replaced in a program, with what is written instead of them. Later ones are inside earlier
/// ones.
pub struct Trimmed(Vec<(PathBuf, String)>);

impl Trimmed {
    /// The folders from which a program is built.
    pub fn of(wanted: &Wanted) -> Self {
        let home = env::var_os("CARGO_HOME").map(PathBuf::from);
        let home = home.or_else(|| Some(env::home_dir()?.join(".cargo")));
        let mut all: Vec<(PathBuf, String)> = home.into_iter().map(|home| (home, "/cargo".to_owned())).collect();
        all.extend([(wanted.root.clone(), "/src".to_owned()), (wanted.target.clone(), "/target".to_owned())]);
        all.extend(packages(&wanted.root));
        all.push((wanted.package.clone(), "/package".to_owned()));
        let mut absolute: Vec<(PathBuf, String)> =
            all.into_iter().filter_map(|(folder, name)| Some((fs::canonicalize(folder).ok()?, name))).collect();
        absolute.sort_by_key(|(folder, _)| folder.components().count());
        Self(absolute)
    }

    /// Lets a command of cargo replace them. Flags for rustc that the user has given hold, too.
    pub fn apply(&self, command: &mut Command) {
        let flags = self.0.iter().map(|(folder, name)| format!("--remap-path-prefix={}={name}", folder.display()));
        let given = env::var("CARGO_ENCODED_RUSTFLAGS").ok();
        let given =
            given.or_else(|| env::var("RUSTFLAGS").ok().map(|flags| flags.split(' ').collect::<Vec<_>>().join("\x1f")));
        match given.filter(|given| !given.is_empty()) {
            Some(given) => {
                let all: Vec<String> = [given].into_iter().chain(flags).collect();
                command.env("CARGO_ENCODED_RUSTFLAGS", all.join("\x1f"));
            }
            None => {
                let flags: Vec<String> = flags.map(|flag| toml::Value::String(flag).to_string()).collect();
                command.arg("--config").arg(format!("build.rustflags=[{}]", flags.join(",")));
            }
        }
    }

    /// Warns if a program has some of them nevertheless.
    pub fn check(&self, program: &Path) {
        let bytes = fs::read(program).unwrap_or_default();
        let is_in = |folder: &&(PathBuf, String)| {
            let name = folder.0.as_os_str().as_encoded_bytes();
            name.len() > 1 && bytes.windows(name.len()).any(|part| part == name)
        };
        if let Some((folder, _)) = self.0.iter().find(is_in) {
            print_error(&format!(
                "warning: the program still has the path `{}`: flags for rustc in a configuration file (`target.….rustflags`) take the place of those of `--trim-paths`, or the program contains the path itself",
                folder.display()
            ));
        }
    }
}

/// Folders of the packages that do not come from a registry, with their names.
fn packages(root: &Path) -> Vec<(PathBuf, String)> {
    let output = cargo().args(["metadata", "--format-version", "1"]).current_dir(root).output();
    let metadata: Value = output.ok().and_then(|out| serde_json::from_slice(&out.stdout).ok()).unwrap_or_default();
    let own = metadata["packages"].as_array().into_iter().flatten().filter(|package| package["source"].is_null());
    let folder = |package: &Value| {
        let manifest = Path::new(package["manifest_path"].as_str()?).parent()?;
        Some((manifest.to_owned(), format!("/{}", package["name"].as_str()?)))
    };
    own.filter_map(folder).collect()
}
