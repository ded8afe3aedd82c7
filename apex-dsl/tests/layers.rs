//! The modules of the compiler form layers: each module uses only the modules before it in [`LAYERS`].
#![allow(clippy::disallowed_methods, reason = "it reads the sources of the compiler")]

use std::{
    collections::BTreeSet,
    fs,
    path::{Path, PathBuf},
};

/// All modules, lowest layer first.
const LAYERS: [&str; 18] = [
    "index", "source", "report", "syntax", "catalog", "graph", "machine", "script", "resolve", "analyse", "check",
    "claims", "threads", "checked", "program", "codegen", "passes", "lib",
];

/// Finds all Rust files in a folder and in the folders below it.
fn files(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).expect("the sources are there") {
        let path = entry.expect("the folder can be read").path();
        match path.is_dir() {
            true => files(&path, found),
            false if path.extension().is_some_and(|e| e == "rs") => found.push(path),
            false => {}
        }
    }
}

/// Modules that Rust code names after `crate::`, also in lists: `crate::{a::B, c}`.
fn used(text: &str) -> BTreeSet<String> {
    let code: String = text.lines().filter(|line| !line.trim_start().starts_with("//")).collect::<Vec<_>>().join("\n");
    let name = |rest: &str| -> String { rest.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect() };
    let mut found = BTreeSet::new();
    for (at, _) in code.match_indices("crate::") {
        let rest = &code[at + "crate::".len()..];
        let Some(list) = rest.strip_prefix('{') else {
            found.insert(name(rest));
            continue;
        };
        let (mut depth, mut begins) = (0, true);
        for (at, c) in list.char_indices() {
            match c {
                '{' => depth += 1,
                '}' if depth == 0 => break,
                '}' => depth -= 1,
                ',' if depth == 0 => begins = true,
                c if begins && c.is_alphabetic() => {
                    found.insert(name(&list[at..]));
                    begins = false;
                }
                _ => {}
            }
        }
    }
    found
}

#[test]
fn modules_use_only_what_lies_below() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut all = vec![];
    files(&root, &mut all);
    let layer = |name: &str| LAYERS.iter().position(|known| *known == name);
    let mut wrong = vec![];
    for file in all {
        let below = file.strip_prefix(&root).expect("it is a source");
        let module = below.components().next().expect("a name").as_os_str().to_string_lossy().into_owned();
        let module = module.trim_end_matches(".rs").to_owned();
        let Some(own) = layer(&module) else {
            wrong.push(format!("`{module}` has no layer"));
            continue;
        };
        let text = fs::read_to_string(&file).expect("it can be read");
        for other in used(&text).iter().filter(|other| **other != module) {
            if layer(other).is_some_and(|other| other > own) {
                wrong.push(format!("{}: `{module}` uses `{other}`, which lies above it", below.display()));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Only the code generator writes Rust, and the catalog reads it.
#[test]
fn rust_is_written_in_one_place() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut all = vec![];
    files(&root, &mut all);
    let writes = |file: &PathBuf| {
        let below = file.strip_prefix(&root).expect("it is a source").to_string_lossy().into_owned();
        let text = fs::read_to_string(file).expect("it can be read");
        let is_meant = !["codegen", "catalog", "passes.rs"].iter().any(|module| below.starts_with(module));
        (is_meant && (text.contains("quote") && text.contains("quote!") || text.contains("proc_macro2")))
            .then_some(below)
    };
    let wrong: Vec<String> = all.iter().filter_map(writes).collect();
    assert!(wrong.is_empty(), "only `codegen` and `catalog` use tokens of Rust: {}", wrong.join(", "));
}
