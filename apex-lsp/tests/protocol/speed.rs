//! How long an editor waits. Run with
//! `cargo test --release -p apex-lsp --test protocol -- --ignored --nocapture speed`.

use crate::client::{Client, position, repository, uri};
use serde_json::json;
use std::{
    fs,
    time::{Duration, Instant},
};

/// Keystrokes that are measured.
const KEYS: usize = 100;

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
        // Somebody writes, and takes it back.
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
