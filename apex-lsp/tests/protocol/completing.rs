//! Completion.

use crate::client::{Client, unsaved};
use serde_json::{Value, json};

const HEAD: &str =
    "use apex_nodes::{math::{above, add}, scan::{JumpDistance, RangeFilter, Scan, SegmentFilter, Segments}};
graph Find(gap: f32[m] = 15cm) {
    in  scan: Scan;
    out segments: Segments;
    slot go;
    node clean = RangeFilter();
    node jump = JumpDistance(gap = gap);
    node sum = add();
    ";

/// Completions at `|` in a graph that continues after it.
fn in_graph(client: &mut Client, statement: &str) -> Vec<String> {
    let marked = format!("{HEAD}{statement}\n    scan -> clean;\n}}\n");
    client.completions(&unsaved("completing.afg"), &marked)
}

fn has(found: &[String], wanted: &[&str]) {
    for name in wanted {
        assert!(found.iter().any(|f| f == name), "`{name}` is not in {found:?}");
    }
}

fn lacks(found: &[String], unwanted: &[&str]) {
    for name in unwanted {
        assert!(!found.iter().any(|f| f == name), "`{name}` is in {found:?}");
    }
}

#[test]
fn items_and_imports() {
    let mut client = Client::start();
    let path = unsaved("items.afg");
    assert_eq!(client.completions(&path, "gr|"), ["use", "pub", "graph", "robot", "fsm", "test", "tune"]);
    let crates = client.completions(&path, "use |");
    has(&crates, &["apex_nodes", "crate", "find_container"]);
    has(&client.completions(&path, "use apex_nodes::{scan::|"), &["JumpDistance", "Scan", "Segments"]);
    has(&client.completions(&path, "use apex_nodes::{scan::{Scan, |}};\ngraph A { }"), &["JumpDistance"]);
    assert_eq!(client.completions(&path, "use find_container::|;\ngraph A { }"), ["FindContainer"]);
    assert!(client.stop());
}

#[test]
fn statements_and_node_types() {
    let mut client = Client::start();
    let found = in_graph(&mut client, "|");
    has(&found, &["node", "in", "claim", "scan", "clean", "start", "RangeFilter"]);
    lacks(&found, &["segments", "exit", "fsm"]);
    let found = in_graph(&mut client, "node x = |");
    has(&found, &["JumpDistance", "add", "ContainerSearch"]);
    lacks(&found, &["Scan", "Find", "clean"]);
    has(&in_graph(&mut client, "in x: |"), &["Scan", "Segments", "f64"]);
    has(&in_graph(&mut client, "node x = apex_nodes::|"), &["scan", "flow"]);
    assert!(client.stop());
}

#[test]
fn only_ports_that_fit() {
    let mut client = Client::start();
    let path = unsaved("fitting.afg");
    let mut at = |statement: &str| {
        let rest = "graph Inner { in a: f64; in b: u8; in c: f64; out d: u8; }\ngraph One { in x: f64; }\n";
        let head = "in speed: f64; out fast: f64; out flag: bool; slot go: f64; event stop: f64; node inner = Inner(); node one = One();";
        client.completions(&path, &format!("graph A {{\n    {head}\n    {statement}\n}}\n{rest}"))
    };
    for statement in ["speed -> |", "go => |;", "[speed, go] -> [fast, |", "speed -> fast;\n speed -> |"] {
        let found = at(statement);
        has(&found, &["fast", "stop", "one", "inner.a", "inner.c", "exit", "One"]);
        lacks(&found, &["flag", "inner", "inner.b", "inner.d", "speed", "go", "start", "Inner.a"]);
        // Certain completions come first.
        assert_eq!(found[0], "fast");
    }
    assert_eq!(at("speed -> inner.|"), ["a", "c", "cancel", "resume"]);
    assert_eq!(at("inner.|"), ["d", "failed", "cancelled", "*"]);
    // By name.
    assert_eq!(at("in.|"), ["*"]);
    assert_eq!(at("in.* -> inner.|"), ["*"]);
    assert_eq!(at("in.* -> [one.*, inner.|"), ["*"]);
    assert_eq!(at("inner.d -> inner.|"), ["b", "cancel", "resume"]);
    // Only one of its ports fits, so its name is enough.
    has(&at("inner -> |"), &["inner"]);
    lacks(&at("inner -> |"), &["fast", "inner.a", "inner.b", "one"]);
    assert!(client.stop());
}

#[test]
fn arguments_and_units() {
    let mut client = Client::start();
    assert_eq!(in_graph(&mut client, "scan -> JumpDistance(|)"), ["gap", "max_gap_beams"]);
    has(&in_graph(&mut client, "node r = RangeFilter(min = 5cm, |)"), &["max"]);
    lacks(&in_graph(&mut client, "node r = RangeFilter(min = 5cm, |)"), &["min"]);
    has(&in_graph(&mut client, "scan -> JumpDistance(gap = |)"), &["gap"]);
    // A value in place of tokens.
    has(&in_graph(&mut client, "scan -> jump.gap(|)"), &["gap"]);
    let units = in_graph(&mut client, "scan -> JumpDistance(gap = 15|)");
    has(&units, &["m", "cm", "mm"]);
    lacks(&units, &["s", "kg"]);
    let units = in_graph(&mut client, "node j = JumpDistance() every 20|");
    has(&units, &["ms", "s"]);
    lacks(&units, &["m"]);
    has(&in_graph(&mut client, "node j = JumpDistance() |"), &["every", "timeout", "restart"]);
    assert!(client.stop());
}

/// A connection may name a parameter, to set it or to read it.
#[test]
fn parameters_as_ports() {
    let mut client = Client::start();
    let found = in_graph(&mut client, "gap -> jump.|");
    has(&found, &["scan", "gap", "max_gap_beams"]);
    has(&in_graph(&mut client, "jump.|"), &["segments", "gap", "failed"]);
    let path = unsaved("parameters.afg");
    let graph = |statement: &str| {
        let head = "use apex_nodes::scan::{RangeFilter, Scan};\ngraph A { in near: f32; in scan: Scan;";
        format!("{head} node cut = RangeFilter();\n{statement}\n}}\n")
    };
    let found = client.completions(&path, &graph("near -> |"));
    has(&found, &["cut.min", "cut.max"]);
    // Parameters are proposed only if the types are known to agree.
    let found = client.completions(&path, &graph("scan -> |"));
    has(&found, &["cut"]);
    lacks(&found, &["cut.min", "cut.scan"]);
    assert!(client.stop());
}

/// A graph cannot contain itself, at any depth.
#[test]
fn no_recursion() {
    let mut client = Client::start();
    let path = unsaved("recursion.afg");
    let text = |inner: &str| {
        format!(
            "graph Outer {{ in x: u8; node m = Middle(); x -> m; }}\ngraph Middle {{ in x: u8; x -> [Inner()]; }}\ngraph Inner {{ in x: u8; {inner} }}\ngraph Other {{ in x: u8; }}\n"
        )
    };
    for statement in ["node n = |", "x -> |"] {
        let found = client.completions(&path, &text(statement));
        has(&found, &["Other"]);
        lacks(&found, &["Outer", "Middle", "Inner"]);
    }
    assert!(client.stop());
}

#[test]
fn what_is_written() {
    let mut client = Client::start();
    let marked = format!("{HEAD}scan -> cle|\n}}\n");
    let found = client.at(&unsaved("written.afg"), &marked, "completion").unwrap();
    let item = |name: &str| -> Value { found.as_array().unwrap().iter().find(|i| i["label"] == name).unwrap().clone() };
    // The existing word is replaced.
    let edit = item("clean")["textEdit"].clone();
    assert_eq!(edit["newText"], "clean");
    assert_eq!(
        edit["range"],
        json!({ "start": { "line": 8, "character": 12 }, "end": { "line": 8, "character": 15 } })
    );
    assert_eq!(item("JumpDistance")["textEdit"]["newText"], "JumpDistance()$0");
    assert_eq!(item("JumpDistance")["insertTextFormat"], 2);
    assert!(item("JumpDistance")["documentation"]["value"].as_str().unwrap().contains("gap: f32[m] = 0.15"));
    // A completion that is not imported adds its import.
    let far = item("MedianFilter");
    assert_eq!(far["additionalTextEdits"][0]["newText"], "use apex_nodes::scan::MedianFilter;\n");
    assert_eq!(far["additionalTextEdits"][0]["range"]["start"], json!({ "line": 0, "character": 0 }));
    assert!(client.stop());

    // Without placeholders only the name is inserted.
    let (mut client, _) = Client::with(json!({}));
    let found = client.at(&unsaved("written.afg"), &marked, "completion").unwrap();
    let jump = found.as_array().unwrap().iter().find(|i| i["label"] == "JumpDistance").unwrap();
    assert_eq!(jump["textEdit"]["newText"], "JumpDistance");
    assert!(client.stop());
}

#[test]
fn machines_and_tests() {
    let mut client = Client::start();
    let path = unsaved("machine.afg");
    let machine = |statement: &str| {
        format!(
            "fsm Door {{\n slot go: u8;\n event ring: u8;\n state shut {{\n {statement}\n }}\n state open {{ on go => shut; }}\n}}\n"
        )
    };
    assert_eq!(client.completions(&path, &machine("on |")), ["go"]);
    assert_eq!(client.completions(&path, &machine("on go => |")), ["shut", "open"]);
    assert_eq!(client.completions(&path, &machine("on go -> |")), ["ring"]);
    has(&client.completions(&path, &machine("|")), &["on", "entry", "exit", "state"]);
    let test = |step: &str| format!("{HEAD}scan -> clean;\n}}\ntest finds: Find {{\n    {step}\n    wait 1s;\n}}\n");
    has(&client.completions(&path, &test("|")), &["feed", "wait", "expect", "never", "replace"]);
    assert_eq!(client.completions(&path, &test("feed |;")), ["scan", "go"]);
    has(&client.completions(&path, &test("expect |;")), &["segments", "clean", "active"]);
    has(&client.completions(&path, &test("expect active(|);")), &["clean", "jump"]);
    has(&client.completions(&path, &test("never clean.|;")), &["filtered"]);
    let tune = |step: &str| {
        format!("{HEAD}scan -> clean;\n}}\ntest ends: Find {{ }}\ntune best: Find {{\n    {step}\n    wait 1s;\n}}\n")
    };
    has(&client.completions(&path, &tune("|")), &["vary", "minimise", "seeds", "feed", "wait"]);
    has(&client.completions(&path, &tune("vary |;")), &["clean", "jump"]);
    has(&client.completions(&path, &tune("vary jump.|;")), &["gap"]);
    has(&client.completions(&path, &tune("minimise clean.|;")), &["filtered"]);
    assert_eq!(client.completions(&path, &tune("require |;")), ["ends", "never"]);
    assert!(client.stop());
}
