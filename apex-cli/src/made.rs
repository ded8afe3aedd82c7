//! Packages for source files whose own package has no program for them. They are in the target folder of the workspace
//! and are built like the workspace: from the same crates, with the same profiles.

use crate::build::{Wanted, write_if_other};
use apex_host::{Workspace, cargo, name_of};
use std::{
    collections::BTreeSet,
    ffi::OsString,
    fmt::Display,
    fs,
    path::{Path, PathBuf},
    process::Stdio,
};
use toml::{Table, Value};

/// Library whose types are messages in recordings if the runtime can record.
const NODES: &str = "apex-nodes";
/// Runtime.
const RUNTIME: &str = "apex-rt";
/// Feature of programs that can be recorded.
pub const RECORD: &str = "record";

/// A package to be made.
pub struct Made<'a> {
    pub workspace: &'a Workspace,
    /// Purpose: `run`, `test`, …
    pub what: &'a str,
    /// Source file, as an absolute path.
    pub text: &'a Path,
    /// Program in the source file, or an empty string.
    pub program: &'a str,
    /// Features of the runtime.
    pub features: &'a [&'a str],
    /// Crates beside the runtime that the code uses, too.
    pub tools: &'a [&'a str],
    /// Path of its only code file in the package.
    pub file: &'a str,
    pub code: &'a str,
}

impl Made<'_> {
    /// The folder of a crate beside the runtime, if it is there.
    pub fn tool(workspace: &Workspace, name: &str) -> Option<PathBuf> {
        let libraries = workspace.libraries();
        let (_, runtime) = libraries.iter().find(|(library, _)| *library == RUNTIME)?;
        Some(runtime.parent()?.join(name)).filter(|folder| folder.join("Cargo.toml").is_file())
    }

    /// A unique name. Cargo and the target folder identify programs by name, and some file systems do not distinguish
    /// upper and lower case.
    pub fn name(&self) -> String {
        let stem = self.text.file_stem().unwrap_or_default();
        let shown = format!("{} {}", stem.to_string_lossy(), self.program);
        let what = [self.what, self.program, &self.features.join(",")].join("\n");
        name_of(&format!("apex-{} {}", self.what, shown.trim_end()), &[what.as_ref(), self.text.as_os_str()])
    }

    /// Folder of the package.
    pub fn folder(&self) -> PathBuf {
        self.workspace.cache_folder().join("made").join(self.name())
    }

    /// Writes the files of the package.
    pub fn make(&self) -> Result<Wanted, String> {
        let folder = self.folder();
        let manifest = folder.join("Cargo.toml");
        write_if_other(&folder.join(self.file), self.code)?;
        let versions = self.lock(&folder)?;
        write_if_other(&manifest, &self.manifest(versions.as_ref())?)?;
        Ok(Wanted {
            select: vec!["--manifest-path".into(), manifest.into()],
            package: folder,
            root: self.workspace.root.clone(),
            target: self.workspace.target.clone(),
            hushed: None,
        })
    }

    /// Manifest of the package. It depends on all crates that a source file or the code made of it can name, and is a
    /// workspace of its own with the settings of the original one. `crates` are the crates that it needs, if they are
    /// known.
    fn manifest(&self, crates: Option<&BTreeSet<String>>) -> Result<String, String> {
        let mut package = Table::new();
        for (key, value) in [("name", self.name().as_str()), ("version", "0.0.0"), ("edition", "2024")] {
            package.insert(key.to_owned(), value.into());
        }
        let (own, _) = self.workspace.binary();
        let libraries = self.workspace.libraries();
        // The library of the source file's package selects the features of the others, if it has one.
        let has_own = libraries.iter().any(|(name, _)| *name == own);
        let mut dependencies = self.declared()?;
        // Cargo refuses a crate under two names.
        let is_library = |package: &Value| libraries.iter().any(|(name, _)| package.as_str() == Some(name));
        dependencies.retain(|_, declared| !declared.get("package").is_some_and(is_library));
        for (name, path) in libraries {
            let declared = dependencies.remove(name);
            let mut dependency = Table::from_iter([("path".to_owned(), Value::from(utf8(path)?))]);
            let mut features: Vec<&str> = match name {
                RUNTIME => self.features.to_vec(),
                NODES if self.features.contains(&RECORD) => vec![RECORD],
                _ => vec![],
            };
            if has_own && name != own {
                dependency.insert("default-features".to_owned(), false.into());
                features.extend((name == RUNTIME).then_some("std"));
            }
            dependency.insert("features".to_owned(), features.into());
            if let Some(Value::Table(mut declared)) = declared.filter(|_| !has_own) {
                add_features(&mut dependency, declared.remove("features"));
            }
            dependencies.insert(name.to_owned(), dependency.into());
        }
        for name in self.tools {
            if let Some(folder) = Self::tool(self.workspace, name) {
                let dependency = Table::from_iter([("path".to_owned(), Value::from(utf8(&folder)?))]);
                dependencies.insert((*name).to_owned(), dependency.into());
            }
        }
        let mut manifest = Table::from_iter([
            ("package".to_owned(), package.into()),
            ("dependencies".to_owned(), dependencies.into()),
            ("workspace".to_owned(), Table::new().into()),
        ]);
        self.inherit(&mut manifest, crates)?;
        toml::to_string(&manifest).map_err(|e| format!("the manifest of `{}` cannot be written: {e}", self.name()))
    }

    /// Returns the dependencies of the source file's package, with absolute paths: the types of tokens may be of any of
    /// these crates, as the pixels of images are of `image`. Optional ones are left out.
    fn declared(&self) -> Result<Table, String> {
        let (own, root) = (self.workspace.manifest(), &self.workspace.root);
        let all = table(read_table(own)?.remove("dependencies"));
        let mut workspace = table(read_table(&root.join("Cargo.toml"))?.remove("workspace"));
        let shared = table(workspace.remove("dependencies"));
        let folder = own.parent().unwrap_or(root);
        let mut declared = Table::new();
        for (name, value) in all {
            let mut value = with_table(value);
            if value.remove("optional").is_some_and(|optional| optional == Value::Boolean(true)) {
                continue;
            }
            let base = if value.remove("workspace").is_some() {
                let more = value.remove("features");
                value = with_table(shared.get(&name).cloned().unwrap_or("*".into()));
                add_features(&mut value, more);
                root
            } else {
                folder
            };
            let mut value = Value::Table(value);
            make_absolute(&mut value, base);
            declared.insert(name, value);
        }
        Ok(declared)
    }

    /// Copies from the workspace all settings that affect the builds of its crates. With other profiles, cargo would
    /// build the crates again.
    fn inherit(&self, manifest: &mut Table, crates: Option<&BTreeSet<String>>) -> Result<(), String> {
        let root = self.workspace.root.join("Cargo.toml");
        let mut theirs = read_table(&root)?;
        if let Some(mut patch) = theirs.remove("patch") {
            make_absolute(&mut patch, &self.workspace.root);
            manifest.insert("patch".to_owned(), patch);
        }
        if let (Some(mut profiles), Some(crates)) = (theirs.remove("profile"), crates) {
            for (_, profile) in profiles.as_table_mut().into_iter().flatten() {
                let packages = profile.get_mut("package").and_then(Value::as_table_mut);
                // Cargo warns of profiles for unknown packages.
                packages.into_iter().for_each(|packages| packages.retain(|spec, _| is_of(spec, crates)));
            }
            manifest.insert("profile".to_owned(), profiles);
        }
        if let Some(resolver) = theirs.get("workspace").and_then(|workspace| workspace.get("resolver")) {
            manifest
                .insert("workspace".to_owned(), Table::from_iter([("resolver".to_owned(), resolver.clone())]).into());
        }
        Ok(())
    }

    /// Copies the versions of all crates from the workspace, and returns the names of the needed crates. Cargo adds the
    /// package itself to the list quietly.
    fn lock(&self, folder: &Path) -> Result<Option<BTreeSet<String>>, String> {
        let lock = folder.join("Cargo.lock");
        let Ok(theirs) = fs::read_to_string(self.workspace.root.join("Cargo.lock")) else { return Ok(None) };
        let is_new = write_if_other(&folder.join("Cargo.lock.workspace"), &theirs)?;
        if is_new || !lock.exists() {
            write_if_other(&lock, &theirs)?;
            let manifest = folder.join("Cargo.toml");
            write_if_other(&manifest, &self.manifest(None)?)?;
            let mut command = cargo();
            command.args(["update", "--workspace", "--quiet", "--offline", "--manifest-path"]).arg(manifest);
            // An error here occurs again in the build, which reports it.
            let _ = command.current_dir(&self.workspace.root).stdout(Stdio::null()).stderr(Stdio::null()).status();
        }
        let lock = read_table(&lock)?;
        let packages = lock.get("package").and_then(Value::as_array).into_iter().flatten();
        Ok(Some(packages.filter_map(|package| Some(package.get("name")?.as_str()?.to_owned())).collect()))
    }
}

fn read_table(path: &Path) -> Result<Table, String> {
    let wrong = |e: &dyn Display| format!("cannot read `{}`: {e}", path.display());
    let text = fs::read_to_string(path).map_err(|e| wrong(&e))?;
    text.parse().map_err(|e: toml::de::Error| wrong(&e.message()))
}

/// The table `value`; an empty one for another value.
fn table(value: Option<Value>) -> Table {
    value.and_then(|value| value.try_into().ok()).unwrap_or_default()
}

/// A dependency as a table: it may be a version alone.
fn with_table(dependency: Value) -> Table {
    match dependency {
        Value::Table(table) => table,
        version => Table::from_iter([("version".to_owned(), version)]),
    }
}

/// Adds the features in the list `more` to a dependency.
fn add_features(dependency: &mut Table, more: Option<Value>) {
    let features = dependency.entry("features").or_insert_with(|| Value::Array(vec![]));
    if let (Some(features), Some(Value::Array(more))) = (features.as_array_mut(), more) {
        features.extend(more);
    }
}

/// `true` if the entry `spec` of a profile (`*`, `name` or `name@version`) applies to one of these crates.
fn is_of(spec: &str, crates: &BTreeSet<String>) -> bool {
    spec == "*" || spec.split(['@', ':']).next().is_some_and(|name| crates.contains(name))
}

/// Cargo arguments that build a package of the workspace with these features of the runtime.
pub fn select_features(workspace: &Workspace, features: &[&str]) -> Vec<OsString> {
    let mut select: Vec<OsString> = vec![];
    for feature in features {
        select.extend(["--features".into(), format!("{RUNTIME}/{feature}").into()]);
        if *feature == RECORD && workspace.libraries().iter().any(|(name, _)| *name == NODES) {
            select.extend(["--features".into(), format!("{NODES}/{feature}").into()]);
        }
    }
    select
}

/// A path as text for TOML and Rust.
pub fn utf8(path: &Path) -> Result<&str, String> {
    path.to_str()
        .ok_or_else(|| format!("the path `{}` is not UTF-8: cargo cannot build packages there", path.display()))
}

/// Makes the relative paths in a table absolute; they are relative to `root`.
fn make_absolute(value: &mut Value, root: &Path) {
    let Value::Table(table) = value else { return };
    for (key, value) in table {
        match value {
            Value::String(path) if key == "path" => *path = root.join(&*path).to_string_lossy().into_owned(),
            value => make_absolute(value, root),
        }
    }
}
