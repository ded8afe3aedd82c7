//! Libraries are compiled once for macros, commands and tests. Cargo compiles a library once if settings and features
//! of all its dependencies are the same for all users.

use serde_json::Value;
use std::{collections::BTreeMap, path::Path};

/// Returns the libraries that cargo would compile for `arguments`: settings and features by package id.
fn libraries(arguments: &[&str]) -> BTreeMap<String, Vec<String>> {
    // The unit graph needs no compilation, but is an unstable feature.
    let output = apex_host::cargo()
        .args(arguments)
        .args(["--unit-graph", "-Zunstable-options", "--offline"])
        .env("RUSTC_BOOTSTRAP", "1")
        .current_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join(".."))
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let graph: Value = serde_json::from_slice(&output.stdout).unwrap();
    let mut libraries: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for unit in graph["units"].as_array().unwrap() {
        if unit["mode"] == "build" && unit["target"]["kind"][0] == "lib" {
            // The name of a profile alone does not cause another compilation.
            let mut profile = unit["profile"].clone();
            profile.as_object_mut().map(|profile| profile.remove("name"));
            let settings = format!("{profile} with features {}", unit["features"]);
            libraries.entry(unit["pkg_id"].as_str().unwrap().to_owned()).or_default().push(settings);
        }
    }
    libraries
}

#[test]
fn the_compiler_is_compiled_once() {
    for arguments in [&["build"][..], &["test", "--no-run"]] {
        let libraries = libraries(arguments);
        let (_, compiler) = libraries.iter().find(|(id, _)| id.contains("apex-dsl")).unwrap();
        let twice: Vec<_> = libraries.iter().filter(|(_, units)| units.len() > 1).collect();
        assert_eq!(compiler.len(), 1, "because one of these differs that it needs:\n{twice:#?}");
    }
}

/// Tests that run rustc link libraries with which the tests themselves were built.
#[test]
fn the_libraries_of_the_tests_are_compiled_once() {
    let used = libraries(&["build", "--package", "apex-tests", "--lib"]);
    for arguments in [&["test", "--no-run"][..], &["test", "--no-run", "--workspace"]] {
        let all = libraries(arguments);
        let again = used.iter().filter(|(id, units)| units.iter().any(|unit| !all[*id].contains(unit)));
        let again: Vec<String> = again.map(|(id, units)| format!("{id}\n  {units:?}\n  {:?}", all[id])).collect();
        let how = "`tests/Cargo.toml` must ask for the features for which others ask";
        assert!(again.is_empty(), "{how}; compiled again would be\n{}", again.join("\n"));
    }
}
