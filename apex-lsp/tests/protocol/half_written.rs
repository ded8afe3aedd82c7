//! Incomplete and broken source files, for which the server answers every request.

use crate::client::{Client, position, repository, unsaved, uri};
use serde_json::{Value, json};
use std::fs;

/// Source files that use all features of the language.
const TEXTS: [&str; 4] = [
    "robots/patsy/mission.afg",
    "tests/behaviour/machines.afg",
    "tests/errors/texts/layout/unicode.afg",
    "tests/behaviour/scripts.afg",
];

/// Sends all kinds of requests about a position; the client fails if the server does.
fn ask_all(client: &mut Client, text: &str, before: &str) {
    let path = unsaved("half_written.afg");
    let document = json!({ "uri": uri(&path) });
    let at = position(before);
    for method in ["completion", "hover", "definition", "documentHighlight"] {
        client.ask_at(&path, at.clone(), method, json!({})).unwrap();
    }
    client.ask_at(&path, at.clone(), "references", json!({ "context": { "includeDeclaration": true } })).unwrap();
    let _ = client.ask_at(&path, at, "rename", json!({ "newName": "other" }));
    client.ask("textDocument/documentSymbol", json!({ "textDocument": document })).unwrap();
    let range = json!({ "start": position(""), "end": position(text) });
    client.ask("textDocument/inlayHint", json!({ "textDocument": document, "range": range })).unwrap();
    let params = json!({ "textDocument": document, "range": range, "context": { "diagnostics": [] } });
    client.ask("textDocument/codeAction", params).unwrap();
}

/// Offsets to be tested: all of a short text, fewer of a long one.
fn places(text: &str) -> Vec<usize> {
    let step = text.len() / 400 + 1;
    (0..=text.len()).filter(|i| text.is_char_boundary(*i)).step_by(step).collect()
}

#[test]
fn every_beginning() {
    let mut client = Client::start();
    let path = unsaved("half_written.afg");
    client.open(&path, "");
    for file in TEXTS {
        let text = fs::read_to_string(repository().join(file)).unwrap();
        for place in places(&text) {
            let written = &text[..place];
            client.change(&path, None, written);
            ask_all(&mut client, written, written);
        }
        client.diagnostics(&path);
    }
    assert!(client.stop());
}

#[test]
fn pieces_left_out() {
    let mut client = Client::start();
    let path = unsaved("half_written.afg");
    client.open(&path, "");
    let mut dice = 7_u64;
    let mut roll = |below: usize| {
        dice = dice.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (dice >> 33) as usize % below.max(1)
    };
    for file in TEXTS {
        let whole = fs::read_to_string(repository().join(file)).unwrap();
        let places: Vec<usize> = (0..=whole.len()).filter(|i| whole.is_char_boundary(*i)).collect();
        for _ in 0..150 {
            let first = roll(places.len());
            let last = (first + 1 + roll(30)).min(places.len() - 1);
            let (start, end) = (places[first], places[last.max(first)]);
            client.change(&path, None, &whole);
            let range = json!({ "start": position(&whole[..start]), "end": position(&whole[..end]) });
            client.change(&path, Some(range), "");
            let left = format!("{}{}", &whole[..start], &whole[end..]);
            ask_all(&mut client, &left, &whole[..start]);
        }
    }
    assert!(client.stop());
}

/// The rest of the source file is known while a statement is incomplete.
#[test]
fn the_rest_is_known() {
    let mut client = Client::start();
    let path = unsaved("rest.afg");
    let text = |statement: &str| {
        format!(
            "graph A {{\n    in x: u8;\n    out y: u8;\n    {statement}\n    node last = Inner();\n}}\ngraph Inner {{ in z: u8; }}\n"
        )
    };
    for statement in [
        "x -> ",
        "node n = ",
        "node n = Inner(",
        "x -> [y, ",
        "y.",
        "node n = Inner(a = \"",
        "/* x",
        "claim exclusive(",
        "ü",
        "in q: Vec<",
        "}",
    ] {
        client.open(&path, &text(statement));
        let found =
            client.ask("textDocument/documentSymbol", json!({ "textDocument": { "uri": uri(&path) } })).unwrap();
        let names: Vec<&str> = found.as_array().unwrap().iter().map(|s| s["name"].as_str().unwrap()).collect();
        assert_eq!(names, ["A", "Inner"], "{statement}");
        let inside: Vec<&Value> = found[0]["children"].as_array().unwrap().iter().map(|c| &c["name"]).collect();
        assert!(inside.contains(&&json!("x")) && inside.contains(&&json!("y")), "{statement}: {inside:?}");
    }
    assert!(client.stop());
}

/// Missing closing brackets are added after a comment at the end of the text, not in it.
#[test]
fn a_comment_at_the_end() {
    let mut client = Client::start();
    let path = unsaved("comment.afg");
    for end in ["// x", "/// x", "/* { // x", "/* { // x\n//", "y -> /* // */ // \"", "//"] {
        client.open(&path, &format!("graph A {{\n    in x: u8;\n    {end}"));
        let params = json!({ "textDocument": { "uri": uri(&path) } });
        let found = client.ask("textDocument/documentSymbol", params).unwrap();
        assert_eq!((&found[0]["name"], &found[0]["children"][0]["name"]), (&json!("A"), &json!("x")), "{end}: {found}");
    }
    assert!(client.stop());
}

/// Diagnostics refer to the text that was checked: the repaired text may have more imports.
#[test]
fn errors_in_imports_of_a_half_written_text() {
    let mut client = Client::start();
    let (inner, outer) = (unsaved("wrong.afg"), unsaved("half.afg"));
    client.open(&inner, "graph Inner { nonsense }\n");
    for text in [
        "use wrong::Inner;\ngraph A { /* {\n// x",
        "/* {\nuse wrong::Inner;\n// x",
        "graph A { }\n/* use wrong::Inner;\ngraph B { // x",
        "use wrong::Inner;\ngraph A { } /* } use other::B; {",
        "use wrong::{Inner, \"\ngraph A { node a = Inner(",
    ] {
        client.open(&outer, text);
        let found = client.diagnostics(&outer);
        let codes: Vec<&str> = found.iter().map(|d| d["code"].as_str().unwrap_or("the server failed")).collect();
        assert!(codes.contains(&"unclosed"), "{text}: {codes:?}");
        assert!(!codes.contains(&"the server failed"), "{text}");
        client.ask_at(&outer, position(text), "completion", json!({})).unwrap();
    }
    assert!(client.stop());
}

/// Very deep nesting, and source files that are too large.
#[test]
fn too_much() {
    let mut client = Client::start();
    let path = unsaved("half_written.afg");
    for text in [
        "(".repeat(20_000),
        "graph A { ".repeat(5000),
        "a::".repeat(20_000),
        "x".repeat(5 << 20),
        "/*".repeat(5000),
        "\"".repeat(5001),
    ] {
        client.open(&path, &text);
        client.ask_at(&path, position(&text), "completion", json!({})).unwrap();
        client.ask_at(&path, position(""), "hover", json!({})).unwrap();
        assert!(!client.diagnostics(&path).is_empty());
    }
    assert!(client.stop());
}
