use crate::disk::{Stamp, stamp, write_whole};
use apex_dsl::catalog::{Conditions, CrateSpec, Crates, Site};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::{
    collections::{BTreeMap, BTreeSet},
    env,
    ffi::OsStr,
    fs,
    hash::{DefaultHasher, Hash as _, Hasher as _},
    io::{self, ErrorKind},
    path::{Path, PathBuf},
    process::Command,
};

/// The crates that every program needs: the runtime, and the macro `graph!`.
const APEX: [&str; 2] = ["apex-rt", "apex-macros"];

/// Place from which a graph is seen; decides the meaning of `crate`.
pub enum Seen<'a> {
    /// A crate that is being compiled: its name, and `true` if it is a binary or an example.
    Crate(&'a str, bool),
    /// The outside: all targets of the package count.
    Package,
}

/// The relevant packages of a dependency graph.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Workspace {
    /// The root folder of the workspace.
    pub root: PathBuf,
    /// The folder in which cargo builds.
    pub target: PathBuf,
    /// The manifests of those of `APEX` that a package of the workspace depends on.
    apex: BTreeMap<String, PathBuf>,
    packages: Vec<Package>,
    here: usize,
    /// Conditions (`cfg`) of a compilation for this machine, from rustc.
    conditions: Conditions,
    /// Stamps of the files and folders on which all of this depends.
    stamps: Vec<(PathBuf, Stamp)>,
}

#[derive(Debug, Clone, Serialize, Deserialize)]
struct Package {
    name: String,
    manifest: PathBuf,
    features: BTreeSet<String>,
    targets: Vec<Target>,
    /// Index of each package by its name in code; `None` if it is not scanned.
    dependencies: BTreeMap<String, Option<usize>>,
}

#[derive(Debug, Clone, Serialize, Deserialize)]
struct Target {
    name: String,
    kind: String,
    root: PathBuf,
}

#[derive(Serialize, Deserialize)]
struct Cached {
    manifest: PathBuf,
    workspace: Workspace,
}

impl Workspace {
    /// Returns the workspace of the package in `folder`. Runs cargo, unless nothing has changed since the last time.
    ///
    /// # Errors
    /// Cargo reports an error, or cannot be run.
    pub fn load(folder: &Path) -> Result<Self, String> {
        let manifest = folder.join("Cargo.toml");
        let lock = folder.ancestors().map(|a| a.join("Cargo.lock")).find(|p| p.is_file());
        let cache = lock.as_ref().and_then(|l| l.parent()).map(|root| cache_file(root, &manifest));
        let cached = cache
            .as_ref()
            .and_then(|c| fs::read(c).ok())
            .and_then(|bytes| serde_json::from_slice::<Cached>(&bytes).ok());
        if let Some(Cached { manifest: of, workspace }) = cached
            && of == manifest
            && workspace.is_current()
            && workspace.stamps.iter().any(|(path, _)| Some(path) == lock.as_ref())
        {
            return Ok(workspace);
        }
        let mut workspace = Self::from_metadata(&metadata(&manifest)?, &manifest)?;
        let manifests = workspace.packages.iter().map(|p| p.manifest.clone());
        // A new file in one of these folders may be a new target.
        let folders = ["src", "src/bin", "examples", "tests", "benches"].map(|name| folder.join(name));
        let watched = manifests.chain(lock).chain([workspace.root.join("Cargo.toml")]).chain(folders);
        workspace.stamps = watched.map(|path| (path.clone(), stamp(&path))).collect();
        if let Some(cache) = cache {
            // An error is ignored: cargo is run again the next time.
            let _ = write_whole(&cache, &Cached { manifest, workspace: workspace.clone() });
        }
        Ok(workspace)
    }

    /// Returns `true` if nothing has changed since cargo was run.
    pub(crate) fn is_current(&self) -> bool {
        self.stamps.iter().all(|(path, old)| stamp(path) == *old)
    }

    /// Returns the folder for caches.
    pub fn cache_folder(&self) -> PathBuf {
        self.target.join("apex")
    }

    fn from_metadata(metadata: &Value, manifest: &Path) -> Result<Self, String> {
        let text = |v: &Value| v.as_str().unwrap_or_default().to_owned();
        let list = |v: &Value| v.as_array().cloned().unwrap_or_default();
        let nodes = list(&metadata["resolve"]["nodes"]);
        let packages = list(&metadata["packages"]);
        let runtime: BTreeSet<String> =
            packages.iter().filter(|p| p["name"] == "apex-rt").map(|p| text(&p["id"])).collect();
        let uses_runtime =
            |node: &&Value| list(&node["deps"]).iter().any(|d| runtime.contains(d["pkg"].as_str().unwrap_or_default()));
        let same = |p: &Value| fs::canonicalize(text(&p["manifest_path"])).ok() == fs::canonicalize(manifest).ok();
        let own = packages
            .iter()
            .find(|p| same(p))
            .map(|p| text(&p["id"]))
            .ok_or("this folder is not a package of its workspace")?;
        let needed = needed(&nodes, &own);
        let is_scanned = |n: &&Value| n["id"] == own.as_str() || uses_runtime(n) && needed.contains(&text(&n["id"]));
        let scanned: Vec<&Value> = nodes.iter().filter(is_scanned).collect();
        let index: BTreeMap<String, usize> = scanned.iter().enumerate().map(|(i, n)| (text(&n["id"]), i)).collect();
        let package = |node: &&Value| {
            let package = packages.iter().find(|p| p["id"] == node["id"])?;
            let targets = list(&package["targets"])
                .iter()
                .map(|t| Target {
                    name: text(&t["name"]),
                    kind: text(&t["kind"][0]),
                    root: text(&t["src_path"]).into(),
                })
                .collect();
            Some(Package {
                name: text(&package["name"]),
                manifest: text(&package["manifest_path"]).into(),
                features: list(&node["features"]).iter().map(text).collect(),
                targets,
                dependencies: list(&node["deps"])
                    .iter()
                    .map(|d| (text(&d["name"]), index.get(&text(&d["pkg"])).copied()))
                    .collect(),
            })
        };
        let is_apex = |p: &&Value| APEX.iter().any(|name| p["name"] == *name);
        let apex =
            packages.iter().filter(is_apex).map(|p| (text(&p["name"]), text(&p["manifest_path"]).into())).collect();
        let packages = scanned
            .iter()
            .map(package)
            .collect::<Option<Vec<_>>>()
            .ok_or("cargo named a package that it does not describe")?;
        Ok(Self {
            root: text(&metadata["workspace_root"]).into(),
            target: text(&metadata["target_directory"]).into(),
            packages,
            apex,
            here: index[&own],
            conditions: conditions(),
            stamps: vec![],
        })
    }

    /// Returns the crates to scan for the source file `file`. `crate` in it means the package to which it belongs, even
    /// if another package compiles it.
    pub fn crates_for(&self, seen: &Seen<'_>, file: &Path) -> Crates {
        let mut crates = self.crates(seen);
        let folder = |package: &Package| {
            package.manifest.parent().map_or(0, |f| if file.starts_with(f) { f.components().count() } else { 0 })
        };
        let owner = (0..self.packages.len())
            .max_by_key(|p| folder(&self.packages[*p]))
            .filter(|p| folder(&self.packages[*p]) > 0);
        if let Some(owner) = owner.filter(|p| *p != self.here)
            && let Some(target) = self.packages[owner].targets.iter().find(|t| is_library(&t.kind))
            && let Some(library) = crates.all.iter().position(|c| c.root == target.root)
        {
            crates.own.insert(0, library);
        }
        crates
    }

    /// Returns the crates to scan.
    pub fn crates(&self, seen: &Seen<'_>) -> Crates {
        let root = self.root.clone();
        let mut all: Vec<CrateSpec> = vec![];
        let mut library: BTreeMap<usize, usize> = BTreeMap::new();
        for (index, package) in self.packages.iter().enumerate() {
            if let Some(target) = package.targets.iter().find(|t| is_library(&t.kind)) {
                library.insert(index, all.len());
                all.push(spec(package, target));
            }
        }
        let own_package = &self.packages[self.here];
        let mut own = vec![];
        for target in own_package.targets.iter().filter(|t| !is_library(&t.kind) && t.kind != "custom-build") {
            own.push(all.len());
            all.push(spec(own_package, target));
        }
        let count = all.len();
        for (index, krate) in all.iter_mut().enumerate() {
            let package = library.iter().find(|(_, k)| **k == index).map_or(self.here, |(p, _)| *p);
            for (name, dependency) in &self.packages[package].dependencies {
                match dependency.and_then(|d| library.get(&d)) {
                    Some(&other) => krate.dependencies.insert(name.clone(), other).map(|_| ()),
                    None => krate.externs.insert(name.clone()).then_some(()),
                };
            }
            // Binaries and tests can use the library of their package.
            if let Some(&lib) =
                library.get(&self.here).filter(|lib| index >= library.len() && index < count && **lib != index)
            {
                let name = own_package.targets.iter().find(|t| is_library(&t.kind)).map(|t| t.name.replace('-', "_"));
                name.map(|name| krate.dependencies.insert(name, lib));
            }
        }
        let lib = library.get(&self.here).copied();
        match seen {
            Seen::Crate(name, binary) => {
                let targets = own_package.targets.iter().filter(|t| !is_library(&t.kind) && t.kind != "custom-build");
                let matches =
                    |t: &Target| t.name.replace('-', "_") == *name && matches!(&*t.kind, "bin" | "example") == *binary;
                let position = targets.zip(&own).find(|(t, _)| matches(t)).map(|(_, k)| *k);
                let here = position.or(lib).unwrap_or(0);
                let own = [Some(here), lib].into_iter().flatten().collect::<Vec<_>>();
                let own = if own.len() == 2 && own[0] == own[1] { vec![here] } else { own };
                let conditions = told(&self.conditions);
                Crates { root, all, here, own, site: Site::Crate, conditions }
            }
            Seen::Package => {
                let own: Vec<usize> = lib.into_iter().chain(own).collect();
                let (here, conditions) = (own.first().copied().unwrap_or(0), self.conditions.clone());
                Crates { root, all, here, own, site: Site::Text, conditions }
            }
        }
    }

    /// Returns the name of the package and of its binary, if there is one.
    pub fn binary(&self) -> (&str, Option<&str>) {
        let package = &self.packages[self.here];
        (&package.name, package.targets.iter().find(|t| t.kind == "bin").map(|t| t.name.as_str()))
    }

    /// Returns the targets of the package: kind, name and root file.
    pub fn targets(&self) -> impl Iterator<Item = (&str, &str, &Path)> {
        self.packages[self.here].targets.iter().map(|t| (t.kind.as_str(), t.name.as_str(), t.root.as_path()))
    }

    /// Returns the manifest of the package.
    pub fn manifest(&self) -> &Path {
        &self.packages[self.here].manifest
    }

    /// Returns the crates with nodes or graphs that a program outside of the package needs for a graph in it, and those
    /// that every program needs: name and folder.
    pub fn libraries(&self) -> Vec<(&str, &Path)> {
        let libraries = self.packages.iter().filter(|p| p.targets.iter().any(|t| is_library(&t.kind)));
        let apex = self.apex.iter().map(|(name, manifest)| (name.as_str(), manifest));
        let all = apex.chain(libraries.map(|p| (p.name.as_str(), &p.manifest)));
        all.map(|(name, manifest)| (name, manifest.parent().unwrap_or(Path::new(".")))).collect()
    }
}

/// Returns the packages on which `package` depends, including itself. The metadata describe the whole workspace: what
/// only the tests of another package need does not count.
fn needed(nodes: &[Value], package: &str) -> BTreeSet<String> {
    let id = |v: &Value| v.as_str().unwrap_or_default().to_owned();
    let is_for_tests = |dep: &Value| dep["dep_kinds"].as_array().is_some_and(|k| k.iter().all(|k| k["kind"] == "dev"));
    let deps = |node: &Value| {
        let deps = node["deps"].as_array().into_iter().flatten();
        deps.filter(|dep| node["id"] == package || !is_for_tests(dep)).map(|dep| id(&dep["pkg"])).collect()
    };
    let needs: BTreeMap<String, Vec<String>> = nodes.iter().map(|node| (id(&node["id"]), deps(node))).collect();
    let (mut needed, mut open) = (BTreeSet::new(), vec![package.to_owned()]);
    while let Some(id) = open.pop() {
        if needed.insert(id.clone()) {
            open.extend(needs.get(&id).into_iter().flatten().cloned());
        }
    }
    needed
}

fn is_library(kind: &str) -> bool {
    matches!(kind, "lib" | "rlib" | "dylib" | "staticlib" | "cdylib")
}

fn spec(package: &Package, target: &Target) -> CrateSpec {
    CrateSpec {
        name: target.name.replace('-', "_"),
        root: target.root.clone(),
        features: package.features.clone(),
        externs: BTreeSet::new(),
        dependencies: BTreeMap::new(),
    }
}

/// Returns the cache file for one package. The configuration of cargo may set another target folder, but reading it
/// would need a run of cargo, which the cache avoids.
fn cache_file(root: &Path, manifest: &Path) -> PathBuf {
    let target = env::var_os("CARGO_TARGET_DIR").map(PathBuf::from).filter(|folder| folder.is_absolute());
    target.unwrap_or_else(|| root.join("target")).join("apex").join(cache_name(manifest))
}

fn cache_name(manifest: &Path) -> String {
    let package = manifest.parent().and_then(Path::file_name).unwrap_or_default();
    format!("{}.json", name_of(&format!("crates {}", package.to_string_lossy()), &[manifest.as_os_str()]))
}

/// Returns a name for a file or a package that is unique to `what`: a readable part of `shown`, and a hash of `what`.
/// It has small letters, digits and `-`, and is short enough for any file system.
pub fn name_of(shown: &str, what: &[&OsStr]) -> String {
    const MOST: usize = 48;
    let mut name = String::new();
    for c in shown.chars().filter_map(|c| if c.is_alphanumeric() { c.is_ascii().then_some(c) } else { Some('-') }) {
        if name.len() < MOST && (c != '-' || !name.ends_with('-')) {
            name.push(c.to_ascii_lowercase());
        }
    }
    let number = |salt: u64| {
        let mut hasher = DefaultHasher::new();
        (salt, what).hash(&mut hasher);
        hasher.finish()
    };
    format!("{}-{:016x}{:016x}", name.trim_end_matches('-'), number(0), number(1))
}

/// Runs `cargo metadata`, without network access if possible: a build of one package downloads only the dependencies of
/// that package, but the metadata describe the whole workspace. `--locked` is left out if there is no lock file yet.
fn metadata(manifest: &Path) -> Result<Value, String> {
    // Without the filter cargo needs crates for platforms that were never downloaded.
    let host = host_triple();
    let filter = host.iter().flat_map(|h| ["--filter-platform", h]);
    let mut reason = String::new();
    for extra in [&["--locked", "--offline"][..], &["--locked"], &[]] {
        let mut command = cargo();
        command
            .args(["metadata", "--quiet", "--format-version", "1", "--manifest-path"])
            .arg(manifest)
            .args(filter.clone())
            .args(extra);
        let output = command.output().map_err(|e| no_cargo(&e))?;
        if output.status.success() {
            return serde_json::from_slice(&output.stdout).map_err(|e| format!("cargo's answer cannot be read: {e}"));
        }
        reason = String::from_utf8_lossy(&output.stderr).trim().to_owned();
    }
    Err(format!("cargo does not know the package: {reason}"))
}

/// Returns a command that runs the cargo which started this process, or else `cargo`.
pub fn cargo() -> Command {
    Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
}

/// Returns the message if cargo could not be run.
pub fn no_cargo(reason: &io::Error) -> String {
    match reason.kind() {
        ErrorKind::NotFound => {
            "there is no `cargo`: install Rust from https://rustup.rs, or put it on the PATH".to_owned()
        }
        _ => format!("cannot run `cargo`: {reason}"),
    }
}

/// Returns the conditions (`cfg`) of the current compilation, inside of rustc: those of this machine, `host`, changed
/// by rustc's arguments. For another target none are known.
fn told(host: &Conditions) -> Conditions {
    let args: Vec<String> = env::args().collect();
    if args.iter().any(|arg| arg == "--target") {
        return Conditions::default();
    }
    let mut set = host.0.clone();
    let values = |name: &'static str| args.windows(2).filter(move |pair| pair[0] == name).map(|pair| pair[1].clone());
    set.extend(values("--cfg"));
    if args.iter().any(|arg| arg == "--test") {
        set.insert("test".to_owned());
    }
    let flags: Vec<String> = values("-C").collect();
    let flag = |name: &str| flags.iter().rev().find_map(|f| f.strip_prefix(name)?.strip_prefix('='));
    let checks = match flag("debug-assertions") {
        Some(value) => matches!(value, "on" | "yes" | "y" | "true"),
        None => flag("opt-level").is_none_or(|level| level == "0"),
    };
    if !checks {
        set.remove("debug_assertions");
    }
    Conditions(set)
}

/// Returns the conditions (`cfg`) of a compilation for this machine; none if rustc cannot be run.
fn conditions() -> Conditions {
    Conditions(rustc(&["--print", "cfg"]).unwrap_or_default().lines().map(str::to_owned).collect())
}

fn rustc(args: &[&str]) -> Option<String> {
    let rustc = env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    String::from_utf8(Command::new(rustc).args(args).output().ok()?.stdout).ok()
}

fn host_triple() -> Option<String> {
    rustc(&["-vV"])?.lines().find_map(|line| line.strip_prefix("host: ")).map(str::to_owned)
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn what_the_tests_of_a_dependency_need_is_not_needed() {
        let nodes = [
            json!({ "id": "robot", "deps": [{ "pkg": "runtime", "dep_kinds": [{ "kind": null }] }] }),
            json!({ "id": "runtime", "deps": [
                { "pkg": "nodes", "dep_kinds": [{ "kind": "dev" }] },
                { "pkg": "bag", "dep_kinds": [{ "kind": "dev" }, { "kind": null }] },
            ] }),
            json!({ "id": "nodes", "deps": [{ "pkg": "runtime", "dep_kinds": [{ "kind": null }] }] }),
            json!({ "id": "bag", "deps": [] }),
        ];
        let needed = |package| needed(&nodes, package).into_iter().collect::<Vec<_>>();
        assert_eq!(needed("robot"), ["bag", "robot", "runtime"]);
        assert_eq!(needed("runtime"), ["bag", "nodes", "runtime"]);
    }

    /// Paths that differ in one character, in characters that a file system may not distinguish, or only in length.
    #[test]
    fn what_differs_has_another_name() {
        let long = "x".repeat(4000);
        let paths = [
            "/foo-bar",
            "/foo_bar",
            "/foo/bar",
            "/foo bar",
            "/foo'bar",
            "/Foo-bar",
            "/fo\u{f6}",
            "/foo\u{308}",
            "/",
            "",
            &long,
            &long[1..],
        ];
        let mut names: Vec<String> = paths.iter().map(|path| cache_name(&Path::new(path).join("Cargo.toml"))).collect();
        names.extend([["a", "bc"], ["ab", "c"], ["a", "b c"]].map(|parts| name_of("a", &parts.map(OsStr::new))));
        let plain = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || ['-', '.'].contains(&c);
        assert!(names.iter().all(|name| name.len() < 100 && name.chars().all(plain)), "{names:?}");
        assert!(names[0].starts_with("crates-foo-bar-"), "{}", names[0]);
        let different: BTreeSet<&String> = names.iter().collect();
        assert_eq!(different.len(), names.len(), "{names:?}");
    }
}
