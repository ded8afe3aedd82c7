//! `apex sbom`: the crates of which a program consists, as a bill of materials (CycloneDX) or as the notices that their
//! licences ask for.

use crate::{project, replace};
use apex_host::{cargo, no_cargo};
use serde_json::{Value, json};
use std::{
    collections::{BTreeMap, BTreeSet},
    fmt::Write as _,
    fs,
    path::Path,
    process::{ExitCode, Stdio},
};

/// Version of CycloneDX.
const SPECIFICATION: &str = "1.6";

/// Writes the list for the package or workspace in `folder`, to a file or to standard output.
pub fn run(folder: &Path, notices: bool, output: Option<&Path>) -> Result<ExitCode, String> {
    let crates = Crates::of(folder)?;
    let text = if notices { crates.notices() } else { crates.bill()? };
    match output {
        Some(path) => replace::write(path, &text)?,
        None => project::write(&text)?,
    }
    Ok(ExitCode::SUCCESS)
}

/// A crate, as cargo describes it.
struct Crate<'a> {
    name: &'a str,
    version: &'a str,
    /// Licences as an expression of SPDX.
    licence: String,
    /// `true` if it comes from a registry.
    is_foreign: bool,
    manifest: &'a Path,
    repository: Option<&'a str>,
    /// Crates that it is built from or runs with.
    needs: BTreeSet<&'a str>,
}

/// The crates of a package or a workspace, without those for its tests.
struct Crates {
    metadata: Value,
    /// SHA-256 of the archive of each crate of a registry, by name and version.
    hashes: BTreeMap<(String, String), String>,
}

impl Crates {
    fn of(folder: &Path) -> Result<Self, String> {
        let mut command = cargo();
        command.args(["metadata", "--format-version", "1", "--locked"]).current_dir(folder);
        let output = command.stderr(Stdio::inherit()).output().map_err(|error| no_cargo(&error))?;
        if !output.status.success() {
            return Err(format!("cargo cannot list the crates of `{}`", folder.display()));
        }
        let metadata: Value = serde_json::from_slice(&output.stdout).map_err(|error| format!("cargo: {error}"))?;
        let root = metadata["workspace_root"].as_str().unwrap_or_default();
        let lock = fs::read_to_string(Path::new(root).join("Cargo.lock")).unwrap_or_default();
        let lock: toml::Table = lock.parse().map_err(|error| format!("`{root}/Cargo.lock`: {error}"))?;
        let packages = lock.get("package").and_then(toml::Value::as_array).cloned().unwrap_or_default();
        let hash = |package: toml::Value| {
            let text = |name: &str| package.get(name).and_then(toml::Value::as_str).map(str::to_owned);
            Some(((text("name")?, text("version")?), text("checksum")?))
        };
        Ok(Self { metadata, hashes: packages.into_iter().filter_map(hash).collect() })
    }

    /// All crates by their identification, and those with which the search has begun.
    fn all<'a>(&'a self) -> (BTreeMap<&'a str, Crate<'a>>, Vec<&'a str>) {
        let needs = self.needs();
        let roots: Vec<&str> = match self.metadata["resolve"]["root"].as_str() {
            Some(root) => vec![root],
            None => texts(&self.metadata["workspace_members"]),
        };
        let (mut open, mut found) = (roots.clone(), BTreeSet::new());
        while let Some(id) = open.pop() {
            if found.insert(id) {
                open.extend(needs.get(id).into_iter().flatten());
            }
        }
        let packages = self.metadata["packages"].as_array().into_iter().flatten();
        let of = |package: &'a Value| {
            let id = package["id"].as_str().filter(|id| found.contains(id))?;
            let licence = package["license"].as_str().unwrap_or("NOASSERTION").replace(" / ", "/").replace('/', " OR ");
            let manifest = Path::new(package["manifest_path"].as_str()?);
            let name = package["name"].as_str()?;
            Some((
                id,
                Crate {
                    name,
                    version: package["version"].as_str()?,
                    licence,
                    is_foreign: package["source"].is_string(),
                    manifest,
                    repository: package["repository"].as_str(),
                    needs: needs.get(id).cloned().unwrap_or_default(),
                },
            ))
        };
        (packages.filter_map(of).collect(), roots)
    }

    /// The crates that each crate is built from or runs with.
    fn needs(&self) -> BTreeMap<&str, BTreeSet<&str>> {
        let nodes = self.metadata["resolve"]["nodes"].as_array().into_iter().flatten();
        nodes
            .filter_map(|node| {
                let is_needed =
                    |dep: &&Value| dep["dep_kinds"].as_array().is_none_or(|k| k.iter().any(|k| k["kind"] != "dev"));
                let deps = node["deps"].as_array().into_iter().flatten().filter(is_needed);
                Some((node["id"].as_str()?, deps.filter_map(|dep| dep["pkg"].as_str()).collect()))
            })
            .collect()
    }

    /// The bill of materials in JSON. It is the same for the same `Cargo.lock`.
    fn bill(&self) -> Result<String, String> {
        let (all, roots) = self.all();
        let reference = |one: &Crate<'_>| format!("pkg:cargo/{}@{}", one.name, one.version);
        let component = |one: &Crate<'_>| {
            let mut component = json!({
                "type": "library",
                "bom-ref": reference(one),
                "name": one.name,
                "version": one.version,
                "purl": reference(one),
                "licenses": [{ "expression": one.licence }],
            });
            if let Some(hash) = self.hashes.get(&(one.name.to_owned(), one.version.to_owned())) {
                component["hashes"] = json!([{ "alg": "SHA-256", "content": hash }]);
            }
            if let Some(repository) = one.repository {
                component["externalReferences"] = json!([{ "type": "vcs", "url": repository }]);
            }
            component
        };
        let mut sorted: Vec<&Crate<'_>> = all.values().collect();
        sorted.sort_by_key(|one| (one.name, one.version));
        let needs = |one: &Crate<'_>| {
            let mut needs: Vec<String> = one.needs.iter().filter_map(|id| all.get(id)).map(reference).collect();
            needs.sort();
            json!({ "ref": reference(one), "dependsOn": needs })
        };
        let mut metadata = json!({
            "tools": { "components": [{ "type": "application", "name": "apex", "version": env!("CARGO_PKG_VERSION") }] },
        });
        if let [root] = roots[..] {
            metadata["component"] = all.get(root).map(component).unwrap_or_default();
        }
        let bill = json!({
            "bomFormat": "CycloneDX",
            "specVersion": SPECIFICATION,
            "version": 1,
            "metadata": metadata,
            "components": sorted.iter().map(|one| component(one)).collect::<Vec<_>>(),
            "dependencies": sorted.iter().map(|one| needs(one)).collect::<Vec<_>>(),
        });
        serde_json::to_string_pretty(&bill).map(|text| text + "\n").map_err(|error| error.to_string())
    }

    /// The crates of others with their licences, their copyright, and the texts that have to be handed on.
    fn notices(&self) -> String {
        let (all, _) = self.all();
        let mut foreign: Vec<&Crate<'_>> = all.values().filter(|one| one.is_foreign).collect();
        foreign.sort_by_key(|one| (one.name, one.version));
        let mut text =
            "Crates of others that are part of programs built here: licence, and copyright as their files state it.\n\
                        Written by `apex sbom --notices`.\n\n"
                .to_owned();
        let mut texts: BTreeMap<String, Vec<String>> = BTreeMap::new();
        for one in foreign {
            let _ = writeln!(text, "{} {}: {}", one.name, one.version, one.licence);
            let mut holders = BTreeSet::new();
            for licence in licences(one) {
                let (holder, rest): (Vec<&str>, Vec<&str>) = licence.lines().partition(|line| is_copyright(line));
                holders.extend(holder.into_iter().map(|line| line.trim().to_owned()));
                let rest = rest.join("\n").split_whitespace().collect::<Vec<_>>().join(" ");
                texts.entry(rest).or_default().push(format!("{} {}", one.name, one.version));
            }
            for holder in holders {
                let _ = writeln!(text, "    {holder}");
            }
        }
        for (licence, of) in texts.iter().filter(|(licence, _)| !licence.is_empty()) {
            let _ = write!(text, "\n----\nFor {}:\n\n{}", wrapped(&of.join(", ")), wrapped(licence));
        }
        text
    }
}

/// The texts in a list.
fn texts(list: &Value) -> Vec<&str> {
    list.as_array().into_iter().flatten().filter_map(Value::as_str).collect()
}

/// `true` for a line that names who has the copyright.
fn is_copyright(line: &str) -> bool {
    let line = line.trim().to_ascii_lowercase();
    line.starts_with("copyright (c)")
        || line.starts_with("copyright ©")
        || (line.starts_with("copyright 2") && line.len() < 100)
}

/// Texts of the licences under which a crate is used. Where there is a choice, that is MIT, and Apache-2.0 otherwise.
fn licences(one: &Crate<'_>) -> Vec<String> {
    let folder = one.manifest.parent().unwrap_or(Path::new("."));
    let mut files: Vec<(String, std::path::PathBuf)> = fs::read_dir(folder)
        .into_iter()
        .flatten()
        .flatten()
        .map(|entry| (entry.file_name().to_string_lossy().to_ascii_uppercase(), entry.path()))
        .filter(|(name, path)| {
            path.is_file() && ["LICEN", "COPYING", "UNLICENSE", "NOTICE"].iter().any(|word| name.starts_with(word))
        })
        .collect();
    files.sort();
    let has = |files: &[(String, std::path::PathBuf)], word: &str| files.iter().any(|(name, _)| name.contains(word));
    let others = ["APACHE", "ZLIB", "0BSD", "UNLICENSE", "BOOST", "LGPL"];
    if one.licence.contains("MIT") && has(&files, "MIT") {
        files.retain(|(name, _)| !others.iter().any(|other| name.contains(other)));
    }
    files.iter().filter_map(|(_, path)| fs::read_to_string(path).ok()).collect()
}

/// A text in lines of at most 100 columns.
fn wrapped(text: &str) -> String {
    let (mut lines, mut line) = (String::new(), String::new());
    for word in text.split_whitespace() {
        if !line.is_empty() && line.chars().count() + 1 + word.chars().count() > 100 {
            lines += &line;
            lines.push('\n');
            line.clear();
        }
        if !line.is_empty() {
            line.push(' ');
        }
        line += word;
    }
    lines + &line + "\n"
}
