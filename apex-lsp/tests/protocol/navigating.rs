//! Definitions and references.

use crate::client::{Client, range, repository, unsaved, uri};
use serde_json::{Value, json};

const TEXT: &str = "use apex_nodes::scan::{JumpDistance, Scan, Segments};
graph Find(gap: f32[m] = 15cm) {
    in  scan: Scan;
    out segments: Segments;
    node jump = JumpDistance(gap = gap);
    scan -> jump.scan;
    jump -> segments;
}
graph Twice {
    in  input: Scan;
    node one = Find();
    node two = Find(gap = 1m);
    input -> [one, two.scan];
}
";

/// `TEXT` with a bar before the `n`th `word`.
fn marked(word: &str, n: usize) -> String {
    let at = TEXT.match_indices(word).nth(n).unwrap().0;
    format!("{}|{}", &TEXT[..at], &TEXT[at..])
}

fn starts(found: &Value) -> Vec<(u64, u64)> {
    let start = |l: &Value| {
        let start = &l["range"]["start"];
        (start["line"].as_u64().unwrap(), start["character"].as_u64().unwrap())
    };
    let mut found: Vec<_> = found.as_array().unwrap().iter().map(start).collect();
    found.sort_unstable();
    found
}

#[test]
fn definitions() {
    let mut client = Client::start();
    let path = unsaved("navigating.afg");
    let here = |part: &str| json!({ "uri": uri(&path), "range": range(TEXT, part) });
    let narrow = |whole: &str, name: &str| {
        let mut place = here(whole);
        let start = place["range"]["start"].clone();
        let end = start["character"].as_u64().unwrap() + name.len() as u64;
        place["range"]["end"] = json!({ "line": start["line"], "character": end });
        place
    };
    for (word, n, target) in [
        ("Find", 1, narrow("Find(gap: ", "Find")),
        ("gap", 2, narrow("gap: f32", "gap")),
        ("gap", 3, narrow("gap: f32", "gap")),
        ("jump", 1, narrow("jump = J", "jump")),
        ("segments", 1, narrow("segments: S", "segments")),
        ("one,", 0, narrow("one = F", "one")),
    ] {
        assert_eq!(client.at(&path, &marked(word, n), "definition").unwrap(), target, "{word} {n}");
    }
    // A parameter and a port of a Rust node lead to the field and the argument.
    let file = repository().join("nodes/src/scan/segment.rs");
    let text = std::fs::read_to_string(&file).unwrap();
    for (word, n, before) in [("gap", 1, "    "), ("scan;", 0, "    fn process(&mut self, ")] {
        let found = client.at(&path, &marked(word, n), "definition").unwrap();
        assert_eq!(found["uri"], uri(&file));
        let (start, end) = (&found["range"]["start"], &found["range"]["end"]);
        let line = text.lines().nth(start["line"].as_u64().unwrap() as usize).unwrap();
        let [start, end] = [start, end].map(|at| at["character"].as_u64().unwrap() as usize);
        let name = word.trim_end_matches(';');
        assert_eq!((&line[..start], &line[start..end]), (before, name));
    }
    assert_eq!(client.at(&path, &marked("in  input", 0), "definition").unwrap(), Value::Null);
    assert!(client.stop());
}

#[test]
fn definitions_in_rust_and_in_other_texts() {
    let mut client = Client::start();
    let path = unsaved("navigating.afg");
    for (word, n, file, declaration) in [
        ("JumpDistance", 1, "nodes/src/scan/segment.rs", "pub struct JumpDistance"),
        ("JumpDistance", 0, "nodes/src/scan/segment.rs", "pub struct JumpDistance"),
        ("Segments;", 0, "nodes/src/scan/segment.rs", "pub type Segments"),
    ] {
        let found = client.at(&path, &marked(word, n), "definition").unwrap();
        let file = repository().join(file);
        assert_eq!(found["uri"], uri(&file));
        let start = &found["range"]["start"];
        let text = std::fs::read_to_string(&file).unwrap();
        let line = text.lines().nth(start["line"].as_u64().unwrap() as usize).unwrap();
        assert!(line.starts_with(declaration), "{line}");
        let name = declaration.rsplit(' ').next().unwrap();
        assert!(line[start["character"].as_u64().unwrap() as usize..].starts_with(name));
    }
    let import = "use find_container::Find|Container;\ngraph A { }\n";
    let found = client.at(&path, import, "definition").unwrap();
    assert_eq!(found["uri"], uri(&unsaved("find_container.afg")));
    assert_eq!(found["range"]["start"]["character"], 6);
    let found = client.at(&path, &import.replace("Find|", "Find").replace("find_", "find|_"), "definition").unwrap();
    assert_eq!(found["range"]["start"], json!({ "line": 0, "character": 0 }));
    assert!(client.stop());
}

#[test]
fn all_uses() {
    let mut client = Client::start();
    let path = unsaved("navigating.afg");
    let mut uses = |word: &str, n: usize, declaration: bool| {
        let marked = marked(word, n);
        let (before, after) = marked.split_once('|').unwrap();
        client.open(&path, &format!("{before}{after}"));
        let more = json!({ "context": { "includeDeclaration": declaration } });
        let found = client.ask_at(&path, crate::client::position(before), "references", more).unwrap();
        let here = found.as_array().unwrap().iter().filter(|l| l["uri"] == uri(&path)).cloned().collect();
        starts(&Value::Array(here))
    };
    assert_eq!(uses("Find", 0, true), [(1, 6), (10, 15), (11, 15)]);
    assert_eq!(uses("Find", 1, false), [(10, 15), (11, 15)]);
    // The parameter of the graph: its declaration, its use inside, and the argument outside.
    assert_eq!(uses("gap", 0, true), [(1, 11), (4, 35), (11, 20)]);
    // The port of the graph, not that of the node inside.
    assert_eq!(uses("scan: Scan", 0, true), [(2, 8), (5, 4), (12, 23)]);
    assert_eq!(uses("JumpDistance", 0, true), [(0, 23), (4, 16)]);
    let found = client.at(&path, &marked("jump", 0), "documentHighlight").unwrap();
    assert_eq!(starts(&found), [(4, 9), (5, 12), (6, 4)]);
    assert!(client.stop());
}

/// A graph is also used by other source files in its folder, whether they are open or not.
#[test]
fn uses_in_other_texts() {
    let mut client = Client::start();
    let (inner, outer) = (unsaved("used_inner.afg"), unsaved("used_outer.afg"));
    client.open(&outer, "use used_inner::Inner;\ngraph Outer { in x: u8; x -> Inner(); }\n");
    let marked = "graph Inn|er { in x: u8; }\n";
    let (before, after) = marked.split_once('|').unwrap();
    client.open(&inner, &format!("{before}{after}"));
    let more = json!({ "context": { "includeDeclaration": true } });
    let found = client.ask_at(&inner, crate::client::position(before), "references", more).unwrap();
    let files: Vec<&str> = found.as_array().unwrap().iter().map(|l| l["uri"].as_str().unwrap()).collect();
    assert_eq!(files, [uri(&inner), uri(&outer), uri(&outer)]);

    let text = std::fs::read_to_string(unsaved("find_container.afg")).unwrap();
    let at = text.find("graph FindContainer").unwrap() + 6;
    client.open(&unsaved("find_container.afg"), &text);
    let more = json!({ "context": { "includeDeclaration": false } });
    let position = crate::client::position(&text[..at]);
    let found = client.ask_at(&unsaved("find_container.afg"), position, "references", more).unwrap();
    assert!(found.as_array().unwrap().iter().any(|l| l["uri"] == uri(&unsaved("patsy.afg"))), "{found}");
    assert!(client.stop());
}

#[test]
fn the_outline() {
    let mut client = Client::start();
    let path = unsaved("outline.afg");
    let text = "/// Docs.\ngraph A(n: u8 = 1) {\n    in x: u8;\n    node a = B();\n}\nfsm B { slot x: u8; state s { state t { } } }\ntest works: A { }\n";
    client.open(&path, text);
    let found = client.ask("textDocument/documentSymbol", json!({ "textDocument": { "uri": uri(&path) } })).unwrap();
    let names = |of: &Value| -> Vec<String> {
        of.as_array()
            .unwrap()
            .iter()
            .map(|s| format!("{} {}", s["name"].as_str().unwrap(), s["detail"].as_str().unwrap_or("-")))
            .collect()
    };
    assert_eq!(names(&found), ["A graph", "B fsm", "works A"]);
    assert_eq!(names(&found[0]["children"]), ["n u8", "x input u8", "a B"]);
    assert_eq!(names(&found[1]["children"][1]["children"]), ["t -"]);
    assert_eq!(
        found[0]["range"],
        json!({ "start": { "line": 0, "character": 0 }, "end": { "line": 4, "character": 1 } })
    );
    assert!(client.stop());
}
