//! Measurement of the response times. Run with
//! `cargo test --release -p apex-lsp --test protocol -- --ignored --nocapture speed`.

use crate::client::{Client, position, repository, uri};
use serde_json::json;
use std::{
    fs,
    time::{Duration, Instant},
};

/// Number of measured keystrokes.
const KEYS: usize = 100;

/// Repeated content of a source file, number of repetitions, and function that returns a text with that number.
type Shape<'a> = (&'a str, usize, &'a dyn Fn(usize) -> String);

/// Large source files of many shapes, each in two sizes. The time should at most double with the size.
#[test]
#[ignore = "a measurement: it prints, and decides nothing"]
fn large_texts() {
    let many = |n: usize, of: &dyn Fn(usize) -> String| (0..n).map(of).collect::<String>();
    let shapes: [Shape<'_>; 14] = [
        ("graphs", 50_000, &|n| many(n, &|i| format!("graph G{i} {{ in x: u8; }}\n"))),
        ("graphs in one line", 50_000, &|n| many(n, &|i| format!("graph G{i} {{ in x: u8; }} "))),
        ("graphs with ü", 50_000, &|n| many(n, &|i| format!("graph G{i} {{ /* ü */ }} "))),
        ("half-written graphs", 50_000, &|n| many(n, &|i| format!("graph G{i} {{ in x: u8;\n"))),
        ("machines", 20_000, &|n| many(n, &|i| format!("fsm M{i} {{ slot a: u8; state s {{ on a => s; }} }}\n"))),
        ("states", 10_000, &|n| {
            let states = many(n, &|i| format!("state s{i} {{ on a => s{}; }}\n", (i + 1) % n));
            format!("fsm M {{ slot a: u8;\n{states}}}\n")
        }),
        ("ports", 10_000, &|n| {
            let ports = many(n, &|i| format!("in x{i}: u8; out y{i}: u8; x{i} -> y{i};\n"));
            let uses = many(n, &|i| format!("in x{i}: u8; x{i} -> n.x{i};\n"));
            format!("graph Inner {{ {ports} }}\ngraph Outer {{ node n = Inner(); {uses} }}\n")
        }),
        ("parameters", 20_000, &|n| format!("graph A({}) {{ }}\n", many(n, &|i| format!("p{i}: u8 = 1, ")))),
        ("unknown nodes", 20_000, &|n| format!("graph A {{ {} }}\n", many(n, &|i| format!("node a{i} = B{i}();\n")))),
        ("broken statements", 50_000, &|n| format!("graph A {{ {} }}\n", many(n, &|_| "-> ->;\n".to_owned()))),
        ("tests", 20_000, &|n| format!("graph A {{ }}\n{}", many(n, &|i| format!("test t{i}: A {{ wait 1s; }}\n")))),
        ("imports", 20_000, &|n| many(n, &|i| format!("use a{i}::B;\n"))),
        ("strings in one line", 200_000, &|n| format!("graph A {{ ( {} ", "\"\"".repeat(n))),
        ("an open comment", 200_000, &|n| format!("graph A {{ /* {} ", "x ü -> y; { ".repeat(n / 10))),
    ];
    for (name, size, shape) in shapes {
        for size in [size / 2, size] {
            let text = shape(size);
            let mut client = Client::start();
            let path = std::env::temp_dir().join("large.afg");
            let start = Instant::now();
            client.open(&path, &text);
            client.diagnostics(&path);
            let checked = start.elapsed();
            let start = Instant::now();
            let document = json!({ "textDocument": { "uri": uri(&path) } });
            client.ask("textDocument/documentSymbol", document).unwrap();
            let outline = start.elapsed();
            let start = Instant::now();
            let half = (text.len() / 2..).find(|i| text.is_char_boundary(*i)).unwrap();
            client.ask_at(&path, position(&text[..half]), "completion", json!({})).unwrap();
            let completion = start.elapsed();
            let size = format!("{size} ({} KiB)", text.len() >> 10);
            println!(
                "{name:20} {size:20} checked {checked:8.2?}  outline {outline:8.2?}  completion {completion:8.2?}"
            );
            assert!(client.stop());
        }
    }
}

#[test]
#[ignore = "a measurement: it prints, and decides nothing"]
fn a_thousand_nodes() {
    let path = repository().join("benches/graphs/mixed1000.afg");
    let text = fs::read_to_string(&path).unwrap();
    let at = text.len() / 2;
    let at = at + text[at..].find('\n').unwrap() + 1;
    let here = position(&text[..at]);
    let mut client = Client::start();
    let opening = Instant::now();
    client.open(&path, &text);
    assert!(client.diagnostics(&path).iter().all(|d| d["severity"] != 1), "no errors");
    println!("{} lines; opened in {:.1?}", text.lines().count(), opening.elapsed());

    let mut times: [(&str, Vec<Duration>); 4] = ["diagnostics", "completion", "hints", "hover"].map(|n| (n, vec![]));
    for key in 0..KEYS {
        // Type a character, then remove it.
        let end = json!({ "line": here["line"], "character": 1 });
        let empty = json!({ "start": here, "end": here });
        let (range, typed) = if key % 2 == 0 { (empty, "x") } else { (json!({ "start": here, "end": end }), "") };
        let start = Instant::now();
        client.change(&path, Some(range), typed);
        client.diagnostics(&path);
        times[0].1.push(start.elapsed());
        client.said.clear();
        let start = Instant::now();
        client.ask_at(&path, here.clone(), "completion", json!({})).unwrap();
        times[1].1.push(start.elapsed());
        let line = here["line"].as_u64().unwrap();
        let window = json!({ "start": here, "end": { "line": line + 60, "character": 0 } });
        let start = Instant::now();
        client
            .ask("textDocument/inlayHint", json!({ "textDocument": { "uri": uri(&path) }, "range": window }))
            .unwrap();
        times[2].1.push(start.elapsed());
        let start = Instant::now();
        client.ask_at(&path, here.clone(), "hover", json!({})).unwrap();
        times[3].1.push(start.elapsed());
    }
    for (name, mut times) in times {
        times.sort_unstable();
        println!("{name:12} median {:6.2?}  longest {:6.2?}", times[KEYS / 2], times[KEYS - 1]);
    }
    assert!(client.stop());
}
