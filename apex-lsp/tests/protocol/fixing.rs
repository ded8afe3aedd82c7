//! Preferred fixes remove an error: checked with all source files of the tests of errors.

use crate::{
    client::{Client, repository, uri},
    package::Package,
};
use serde_json::{Value, json};
use std::{
    fs,
    path::{Path, PathBuf},
};

/// Minimum number of preferred fixes in all source files; fewer mean that fixes are not tried.
const MANY: usize = 40;

/// A package with the nodes and the source files of the tests of errors.
fn package() -> (Package, Vec<PathBuf>) {
    let package = Package::new("fixing", "");
    let errors = repository().join("tests/errors");
    let manifest = |name: &str, more: &str| {
        let runtime = repository().join("apex-rt");
        let library = errors.join(format!("{name}.rs"));
        format!(
            "[package]\nname = {name:?}\nversion = \"0.0.0\"\nedition = \"2024\"\n[lib]\npath = {library:?}\n{more}\n\
             [dependencies]\napex-rt = {{ path = {runtime:?} }}\n"
        )
    };
    fs::create_dir_all(package.0.join("library")).unwrap();
    fs::write(package.0.join("library/Cargo.toml"), manifest("library", "")).unwrap();
    let dependency = "library = { path = \"library\" }\n";
    fs::write(package.0.join("Cargo.toml"), manifest("nodes", "[workspace]\n") + dependency).unwrap();
    let texts = texts(&errors.join("texts"), &package.0.join("texts"));
    (package, texts)
}

/// Copies all source files in a folder and below. Returns the paths of the copies.
fn texts(from: &Path, to: &Path) -> Vec<PathBuf> {
    fs::create_dir_all(to).unwrap();
    let mut copies = vec![];
    for entry in fs::read_dir(from).unwrap() {
        let entry = entry.unwrap();
        let copy = to.join(entry.file_name());
        if entry.path().is_dir() {
            copies.extend(texts(&entry.path(), &copy));
        } else {
            fs::copy(entry.path(), &copy).unwrap();
            copies.push(copy);
        }
    }
    copies.sort();
    copies
}

/// Removes the expectations of a test from a source file.
fn strip(text: &str) -> String {
    let is_expectation = |line: &&str| {
        let Some(rest) = line.strip_prefix("//").map(str::trim_start) else { return false };
        let marks = rest.trim_start_matches(['<', '^', '\'', '~']);
        let says = marks.len() < rest.len() && [" error[", " warning["].iter().any(|w| marks.starts_with(w));
        says || rest.starts_with("| ") || rest.starts_with("elsewhere ")
    };
    text.split_inclusive('\n').filter(|line| !is_expectation(line)).collect()
}

/// Byte offset of a position of the protocol.
fn offset(text: &str, position: &Value) -> usize {
    let line = position["line"].as_u64().unwrap() as usize;
    let start: usize = text.split_inclusive('\n').take(line).map(str::len).sum();
    let mut column = position["character"].as_u64().unwrap() as usize;
    for (at, c) in text[start..].char_indices() {
        if column == 0 {
            return start + at;
        }
        column -= c.len_utf16();
    }
    text.len()
}

fn errors(diagnostics: &[Value]) -> usize {
    diagnostics.iter().filter(|d| d["severity"] == 1).count()
}

fn said(diagnostics: &[Value], message: &Value) -> usize {
    diagnostics.iter().filter(|d| d["message"] == *message).count()
}

#[test]
fn what_is_preferred_mends() {
    let (_package, texts) = package();
    let mut client = Client::start();
    let (mut offered, mut preferred) = (0, 0);
    for path in texts {
        let Ok(text) = fs::read_to_string(&path).map(|text| strip(&text)) else { continue };
        client.open(&path, &text);
        let before = client.diagnostics(&path);
        let all = json!({ "start": { "line": 0, "character": 0 }, "end": { "line": 1_000_000, "character": 0 } });
        let params = json!({ "textDocument": { "uri": uri(&path) }, "range": all, "context": { "diagnostics": [] } });
        let actions = client.ask("textDocument/codeAction", params).unwrap().as_array().unwrap().clone();
        offered += actions.len();
        for action in actions.iter().filter(|a| a["isPreferred"] == true) {
            preferred += 1;
            let edit = &action["edit"]["changes"][uri(&path)][0];
            let (start, end) = (offset(&text, &edit["range"]["start"]), offset(&text, &edit["range"]["end"]));
            let changed = format!("{}{}{}", &text[..start], edit["newText"].as_str().unwrap(), &text[end..]);
            client.change(&path, None, &changed);
            let after = client.diagnostics(&path);
            let message = &action["diagnostics"][0]["message"];
            let mends = errors(&after) < errors(&before)
                || errors(&after) == errors(&before) && said(&after, message) < said(&before, message);
            assert!(mends, "{}: `{}` for {message}:\n{changed}\n{after:#?}", path.display(), action["title"]);
        }
        client.tell("textDocument/didClose", json!({ "textDocument": { "uri": uri(&path) } }));
        client.said.clear();
    }
    println!("{preferred} of {offered} changes are preferred");
    assert!(preferred > MANY && preferred < offered, "{preferred} of {offered}");
    assert!(client.stop());
}
