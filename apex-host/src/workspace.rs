use crate::disk::{stamp, write_whole};
use apex_dsl::catalog::{CrateSpec, Crates};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::{
    collections::{BTreeMap, BTreeSet},
    env, fs,
    io::{self, ErrorKind},
    path::{Path, PathBuf},
    process::Command,
};

/// From where a graph is seen: decides what `crate` means.
pub enum Seen<'a> {
    /// From a crate that is being compiled: its name, and whether it is a binary or an example.
    Crate(&'a str, bool),
    /// From outside: all targets of the package count.
    Package,
}

/// The packages of a dependency graph, as far as they matter.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Workspace {
    /// The root folder of the workspace.
    pub root: PathBuf,
    /// Where cargo builds.
    pub target: PathBuf,
    /// The manifest of `apex-rt`.
    runtime: Option<PathBuf>,
    packages: Vec<Package>,
    here: usize,
}

#[derive(Debug, Clone, Serialize, Deserialize)]
struct Package {
    name: String,
    manifest: PathBuf,
    features: BTreeSet<String>,
    targets: Vec<Target>,
    /// Name in code → index of the package, or nothing if it is not scanned.
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
    stamps: Vec<(PathBuf, Option<(u128, u64)>)>,
    workspace: Workspace,
}

impl Workspace {
    /// The workspace of the package in `folder`. Asks cargo, unless nothing changed since it was asked last.
    ///
    /// # Errors
    /// Says what cargo says, or why it could not be asked.
    pub fn load(folder: &Path) -> Result<Self, String> {
        let manifest = folder.join("Cargo.toml");
        let lock = folder.ancestors().map(|a| a.join("Cargo.lock")).find(|p| p.is_file());
        let cache =
            lock.as_ref().and_then(|l| l.parent()).map(|root| root.join("target/apex").join(cache_name(&manifest)));
        let cached = cache
            .as_ref()
            .and_then(|c| fs::read(c).ok())
            .and_then(|bytes| serde_json::from_slice::<Cached>(&bytes).ok());
        if let Some(cached) = cached
            && cached.stamps.iter().all(|(path, old)| stamp(path) == *old)
            && cached.stamps.iter().any(|(path, _)| Some(path) == lock.as_ref())
        {
            return Ok(cached.workspace);
        }
        let workspace = Self::from_metadata(&metadata(&manifest)?, &manifest)?;
        if let Some(cache) = cache {
            let manifests = workspace.packages.iter().map(|p| p.manifest.clone());
            // A new file in one of these folders may be a new target.
            let folders = ["src", "src/bin", "examples", "tests", "benches"].map(|name| folder.join(name));
            let watched = manifests.chain(lock).chain([workspace.root.join("Cargo.toml")]).chain(folders);
            let stamps = watched.map(|path| (path.clone(), stamp(&path))).collect();
            // Only a cache: where it cannot be written, cargo is asked again.
            let _ = write_whole(&cache, &Cached { stamps, workspace: workspace.clone() });
        }
        Ok(workspace)
    }

    /// The folder for caches.
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
        let runtime_package = packages.iter().find(|p| p["name"] == "apex-rt");
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
        let packages = scanned
            .iter()
            .map(package)
            .collect::<Option<Vec<_>>>()
            .ok_or("cargo named a package that it does not describe")?;
        Ok(Self {
            root: text(&metadata["workspace_root"]).into(),
            target: text(&metadata["target_directory"]).into(),
            packages,
            runtime: runtime_package.map(|p| text(&p["manifest_path"]).into()),
            here: index[&own],
        })
    }

    /// The crates to scan for a text that stands in `file`. `crate` in it means the package that it belongs to, even if
    /// another one compiles it.
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

    /// The crates to scan.
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
            // Binaries and tests see the library of their package.
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
                Crates { root, all, here, own: if own.len() == 2 && own[0] == own[1] { vec![here] } else { own } }
            }
            Seen::Package => {
                let own: Vec<usize> = lib.into_iter().chain(own).collect();
                Crates { root, all, here: own.first().copied().unwrap_or(0), own }
            }
        }
    }

    /// The name of the package and of the binary that it has, if it has one.
    pub fn binary(&self) -> (&str, Option<&str>) {
        let package = &self.packages[self.here];
        (&package.name, package.targets.iter().find(|t| t.kind == "bin").map(|t| t.name.as_str()))
    }

    /// The crates that a program outside of the package would need for a graph in it: name and folder.
    pub fn libraries(&self) -> Vec<(&str, &Path)> {
        let libraries = self.packages.iter().filter(|p| p.targets.iter().any(|t| is_library(&t.kind)));
        let runtime = self.runtime.iter().map(|manifest| ("apex-rt", manifest));
        let all = runtime.chain(libraries.map(|p| (p.name.as_str(), &p.manifest)));
        all.map(|(name, manifest)| (name, manifest.parent().unwrap_or(Path::new(".")))).collect()
    }
}

/// The packages that `package` needs, itself included: the metadata speaks of the whole workspace.
fn needed(nodes: &[Value], package: &str) -> BTreeSet<String> {
    let id = |v: &Value| v.as_str().unwrap_or_default().to_owned();
    let needs: BTreeMap<String, Vec<String>> = nodes
        .iter()
        .map(|node| (id(&node["id"]), node["deps"].as_array().into_iter().flatten().map(|d| id(&d["pkg"])).collect()))
        .collect();
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

fn cache_name(manifest: &Path) -> String {
    let name: String =
        manifest.display().to_string().chars().map(|c| if c.is_alphanumeric() { c } else { '-' }).collect();
    format!("crates{name}.json")
}

/// `cargo metadata`, without network if that is possible: a build of one package downloads only what that package
/// needs, but the metadata speaks of the whole workspace. `--locked` is left out if there is no lock file yet.
fn metadata(manifest: &Path) -> Result<Value, String> {
    // Without the filter cargo wants crates of platforms that were never downloaded.
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

/// The cargo that started this, or the one that is found.
pub fn cargo() -> Command {
    Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
}

/// Says why cargo could not be run.
pub fn no_cargo(reason: &io::Error) -> String {
    match reason.kind() {
        ErrorKind::NotFound => {
            "there is no `cargo`: install Rust from https://rustup.rs, or put it on the PATH".to_owned()
        }
        _ => format!("cannot run `cargo`: {reason}"),
    }
}

fn host_triple() -> Option<String> {
    let rustc = env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let output = Command::new(rustc).arg("-vV").output().ok()?;
    let text = String::from_utf8(output.stdout).ok()?;
    text.lines().find_map(|line| line.strip_prefix("host: ")).map(str::to_owned)
}
