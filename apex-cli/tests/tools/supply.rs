//! Crates of others: bills of materials, notices, and the rules for them.

use crate::{
    TARGET, builds,
    common::{Folder, apex, package, stderr},
};
use serde_json::Value;
use std::{
    collections::BTreeSet,
    env, fs,
    path::{Path, PathBuf},
    process::Command,
};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..").canonicalize().unwrap()
}

/// Output of `apex sbom` with these arguments.
fn sbom(arguments: &[&str]) -> String {
    let output = apex().arg("sbom").args(arguments).output().unwrap();
    assert!(output.status.success(), "{}", stderr(&output));
    String::from_utf8(output.stdout).unwrap()
}

/// All crates of the workspace, as cargo describes them.
fn packages() -> Vec<Value> {
    let mut command = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    let output = command.args(["metadata", "--format-version", "1", "--locked"]).current_dir(root()).output().unwrap();
    let metadata: Value = serde_json::from_slice(&output.stdout).unwrap();
    metadata["packages"].as_array().unwrap().clone()
}

#[test]
fn the_notices_are_those_of_the_crates() {
    let (file, now) = (root().join("NOTICES"), sbom(&[root().to_str().unwrap(), "--notices"]));
    if env::var_os("APEX_UPDATE_EXPECTATIONS").is_some() {
        fs::write(&file, &now).unwrap();
    }
    let written = fs::read_to_string(&file).unwrap_or_default();
    assert!(written == now, "`NOTICES` is out of date: `apex sbom --notices -o NOTICES`");
    for part in ["serde ", "\n    Copyright (c)", "UNICODE LICENSE V3", "Redistributions in binary form"] {
        assert!(now.contains(part), "{part}");
    }
    assert!(!now.contains("apex-rt "), "it is our own");
}

#[test]
fn a_bill_of_materials_is_complete_and_always_the_same() {
    let folder = Folder::new("sbom");
    let file = folder.0.join("rover.cdx.json");
    let package = root().join("robots/rover");
    sbom(&[package.to_str().unwrap(), "-o", file.to_str().unwrap()]);
    let text = fs::read_to_string(&file).unwrap();
    assert_eq!(text, sbom(&[package.to_str().unwrap()]));
    let bill: Value = serde_json::from_str(&text).unwrap();
    assert_eq!((&bill["bomFormat"], &bill["metadata"]["component"]["name"]), (&"CycloneDX".into(), &"rover".into()));
    let components = bill["components"].as_array().unwrap();
    let known: BTreeSet<&str> = components.iter().filter_map(|one| one["bom-ref"].as_str()).collect();
    assert!(known.len() == components.len() && known.iter().any(|one| one.starts_with("pkg:cargo/apex-rt@")));
    // Whatever is needed is there, and what comes from elsewhere has a checksum.
    for one in bill["dependencies"].as_array().unwrap() {
        assert!(one["dependsOn"].as_array().unwrap().iter().all(|of| known.contains(of.as_str().unwrap())), "{one}");
    }
    let own = packages().iter().filter(|p| p["source"].is_null()).map(|p| p["name"].clone()).collect::<Vec<_>>();
    for one in components.iter().filter(|one| !own.contains(&one["name"])) {
        assert!(one["hashes"][0]["content"].as_str().is_some_and(|hash| hash.len() == 64), "{one}");
        assert!(one["licenses"][0]["expression"].as_str().is_some_and(|licence| !licence.contains('/')), "{one}");
    }
    assert!(!known.iter().any(|one| one.starts_with("pkg:cargo/trybuild@")), "only tests need it");
}

const NODES: &str = "use apex_rt::prelude::*;

/// Prints the path of the program.
#[node]
pub fn path() -> u8 {
    println!(\"{}\", std::env::current_exe().unwrap().display());
    1
}
";

#[test]
fn a_program_has_no_paths_of_the_machine_if_they_are_left_out() {
    let _guard = builds();
    let folder = Folder::new("trimmed");
    package(&folder, NODES);
    // A program of its own: one that `apex run` makes names the source file by its whole path.
    let main = "apex_macros::graph!(\"robot.afg\");\n\nfn main() {\n    apex_rt::run(Trimmed::new(), apex_rt::WallClock::new());\n}\n";
    folder.file("src/main.rs", main);
    let file = folder
        .file("robot.afg", "use trimmed::path;\n\nrobot Trimmed {\n    node path = path();\n    path -> exit;\n}\n");
    let program = |more: &[&str]| {
        let mut command = apex();
        let output = command.arg("run").args(more).arg(&file).env("CARGO_TARGET_DIR", TARGET).output().unwrap();
        assert_eq!((output.status.code(), stderr(&output).as_str()), (Some(0), ""));
        fs::read(String::from_utf8(output.stdout).unwrap().trim()).unwrap()
    };
    let own = folder.0.canonicalize().unwrap();
    let has = |program: &[u8], folder: &Path| {
        let name = folder.to_str().unwrap().as_bytes();
        program.windows(name.len()).any(|part| part == name)
    };
    assert!(has(&program(&[]), &root()), "otherwise it has them");
    let trimmed = program(&["--trim-paths"]);
    for path in [own, root(), PathBuf::from(TARGET).canonicalize().unwrap(), env::home_dir().unwrap().join(".cargo")] {
        assert!(!has(&trimmed, &path), "{}", path.display());
    }
}

/// Names of the crates that a package needs in programs, with these features. Those of macros are left out.
fn needs(package: &str, features: &str) -> BTreeSet<String> {
    let mut command = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    command.args(["tree", "--locked", "--offline", "--prefix", "none", "--edges", "normal,no-proc-macro"]);
    command.args(["--no-default-features", "--package", package, "--features", features]);
    let output = command.current_dir(root()).output().unwrap();
    assert!(output.status.success(), "{}", stderr(&output));
    let lines = String::from_utf8(output.stdout).unwrap();
    lines.lines().filter_map(|line| line.split(' ').next()).map(str::to_owned).collect()
}

#[test]
fn programs_that_record_nothing_need_no_crate_for_it() {
    let set = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect::<BTreeSet<_>>();
    let of_runtime = ["apex-rt", "byteorder", "hash32", "heapless", "stable_deref_trait"];
    assert_eq!(needs("apex-rt", ""), set(&of_runtime));
    let of_nodes = [&of_runtime[..], &["apex-nodes", "apex-optim", "libm", "num-traits"]].concat();
    assert_eq!(needs("apex-nodes", "std"), set(&of_nodes));
    let recording = needs("apex-rt", "record");
    let of_bags = set(&["apex-bag", "apex-messages", "bzip2-rs", "crc32fast", "lz4_flex", "ruzstd", "tinyvec"]);
    assert!(recording.is_superset(&of_bags), "{recording:?}");
    assert_eq!(needs("apex-messages", ""), set(&["apex-messages"]));
    // Nothing in C.
    assert!(!recording.iter().any(|name| name.ends_with("-sys")), "{recording:?}");
}

/// `true` if an expression of licences can be met with those that are allowed.
fn is_allowed(expression: &str, allowed: &[String]) -> bool {
    let expression = expression.replace(['(', ')'], "").replace(" / ", "/").replace('/', " OR ");
    // `A OR B AND C` does not occur without parentheses around the choice.
    expression.split(" AND ").all(|part| part.split(" OR ").any(|one| allowed.iter().any(|known| known == one.trim())))
}

#[test]
fn crates_of_others_have_licences_and_sources_that_are_allowed_and_ours_are_not_published() {
    let rules: toml::Table = fs::read_to_string(root().join("deny.toml")).unwrap().parse().unwrap();
    let list = |table: &str, name: &str| -> Vec<String> {
        let values = rules[table][name].as_array().unwrap().iter();
        values.map(|value| value.as_str().unwrap().to_owned()).collect()
    };
    let (allowed, sources) = (list("licenses", "allow"), list("sources", "allow-registry"));
    assert!(is_allowed("(MIT OR GPL-3.0) AND Zlib", &allowed) && !is_allowed("MIT AND GPL-3.0", &allowed));
    for package in packages() {
        let Some(source) = package["source"].as_str() else {
            // They depend on each other by their paths, so that nobody could use them from a registry.
            assert_eq!(package["publish"], Value::Array(vec![]), "{}: `publish = false`", package["name"]);
            continue;
        };
        let licence = package["license"].as_str().unwrap_or_default();
        assert!(is_allowed(licence, &allowed), "{}: {licence}", package["name"]);
        assert!(sources.iter().any(|known| source == format!("registry+{known}")), "{}: {source}", package["name"]);
    }
}
