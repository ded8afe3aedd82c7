//! Hover, hints, fixes.

use crate::client::{Client, position, unsaved, uri};
use serde_json::{Value, json};

const TEXT: &str = "use apex_nodes::{flow::{Counter, Edge}, math::above, scan::JumpDistance};
/// Says when it rises.
graph Watch(
    /// From here on it is fast.
    level: f64 = 1,
) {
    in    speed: f64;
    event fast;
    event times: u64;

    /// Up or down.
    node edge  = Edge();
    node count = Counter();
    speed -> above(level = level) -> edge;
    edge.rose => [fast, count.put];
    count -> times;
    edge.fell -> exit;
}
graph Cut { node j = JumpDistance(gap = 1m) timeout 5s; }
";

/// Hover text before the `n`th `word`.
fn hover(client: &mut Client, word: &str, n: usize) -> String {
    let path = unsaved("showing.afg");
    client.open(&path, TEXT);
    let at = TEXT.match_indices(word).nth(n).unwrap().0;
    let found = client.ask_at(&path, position(&TEXT[..at]), "hover", json!({})).unwrap();
    found["contents"]["value"].as_str().unwrap_or_default().to_owned()
}

#[test]
fn what_a_name_means() {
    let mut client = Client::start();
    let node = hover(&mut client, "JumpDistance", 1);
    assert!(node.starts_with("```afg\nnode JumpDistance(\n    gap: f32[m] = 0.15 in 0..=2,\n"), "{node}");
    assert!(node.contains("\n    in    scan: Scan\n    out   segments: Segments\n```\n\nSplits a scan"), "{node}");
    let graph = hover(&mut client, "Watch", 0);
    assert_eq!(
        graph,
        "```afg\ngraph Watch(level: f64 = 1)\n    in    speed: f64\n    event fast: ()\n    event times: u64\n```\n\nSays when it rises."
    );
    let instance = hover(&mut client, "edge", 1);
    assert!(instance.starts_with("```afg\nnode edge\nnode Edge\n") && instance.ends_with("Up or down."), "{instance}");
    let param = hover(&mut client, "gap", 0);
    assert!(
        param.starts_with("```afg\ngap: f32[m] = 0.15 in 0..=2\n```\n\n")
            && param.ends_with("Parameter of `JumpDistance`."),
        "{param}"
    );
    let param = hover(&mut client, "level)", 0);
    assert_eq!(param, "```afg\nlevel: f64 = 1\n```\n\nFrom here on it is fast.\n\nParameter of `Watch`.");
    assert_eq!(hover(&mut client, "rose", 0), "```afg\nevent rose: ()\n```\n\nEvent of `Edge`.");
    assert_eq!(hover(&mut client, "speed", 0), "```afg\nin    speed: f64\n```\n\nInput of `Watch`.");
    assert!(hover(&mut client, "exit", 0).contains("ends the program"));
    assert!(hover(&mut client, "timeout", 0).contains("active for this time"));
    assert_eq!(hover(&mut client, "1m", 0), "");
    assert!(client.stop());
}

/// A unit is shown if it is declared; a time may have any unit.
#[test]
fn no_unit_is_invented() {
    let mut client = Client::start();
    let path = unsaved("units.afg");
    let text = "graph A(wait: Duration = 20ms, far: f64[m] = 1m) { }\ngraph B { node a = A(wait = 2, far = 3); }\n";
    for (word, declaration) in [("wait", "wait: Duration = 20ms"), ("far", "far: f64[m] = 1m")] {
        client.open(&path, text);
        let at = text.find(word).unwrap();
        let found = client.ask_at(&path, position(&text[..at]), "hover", json!({})).unwrap();
        let shown = found["contents"]["value"].as_str().unwrap();
        assert!(shown.starts_with(&format!("```afg\n{declaration}\n```")), "{shown}");
    }
    let marked = text.replace("wait = 2,", "wait = 2|,");
    let units = client.completions(&path, &marked);
    assert!(units.iter().any(|u| u == "ms") && !units.iter().any(|u| u == "m"), "{units:?}");
    assert!(client.stop());
}

#[test]
fn what_an_arrow_does() {
    let mut client = Client::start();
    assert_eq!(
        hover(&mut client, "->", 0),
        "```afg\nspeed -> above.x\n```\n\nsynchronous: one token per iteration, a value or ⊥\n\n`f64` → `T`"
    );
    let several = hover(&mut client, "=>", 0);
    assert!(several.contains("edge.rose => fast") && several.contains("edge.rose => count.put"), "{several}");
    assert!(several.contains(
        "asynchronous: one call for each token, in the order in which the tokens were sent; lets activity pass"
    ));
    assert!(client.stop());
}

#[test]
fn the_kinds_of_connections() {
    let mut client = Client::start();
    let path = unsaved("showing.afg");
    client.open(&path, TEXT);
    let mut hints = |from: u32, to: u32| -> Vec<(u64, u64, String)> {
        let range = json!({ "start": { "line": from, "character": 0 }, "end": { "line": to, "character": 0 } });
        let found = client
            .ask("textDocument/inlayHint", json!({ "textDocument": { "uri": uri(&path) }, "range": range }))
            .unwrap();
        let hint = |h: &Value| {
            let at = &h["position"];
            (at["line"].as_u64().unwrap(), at["character"].as_u64().unwrap(), h["label"].as_str().unwrap().to_owned())
        };
        found.as_array().unwrap().iter().map(hint).collect()
    };
    let named = |line, column, word: &str| (line, column, word.to_owned());
    assert_eq!(hints(13, 14), [named(13, 12, "sync"), named(13, 36, "sync")]);
    assert_eq!(hints(14, 17), [named(14, 16, "event"), named(15, 12, "event"), named(16, 16, "event")]);
    assert!(client.stop());
}

#[test]
fn connections_by_name() {
    let mut client = Client::start();
    let path = unsaved("by_name.afg");
    let text = "graph Inner { in a: f64; slot b; in k: f64; out d: f64; a -> d; }
graph A {
    in a: f64;
    slot b;
    in k: f64;
    out d: f64;
    node one = Inner();
    node two = Inner();
    in.* -> [one.*, two.*];
    k -> two.a;
    one.* -> out.*;
}
";
    client.open(&path, text);
    let line =
        |line: u32| json!({ "start": { "line": line, "character": 4 }, "end": { "line": line, "character": 40 } });
    let params = json!({ "textDocument": { "uri": uri(&path) }, "range": line(8) });
    let hints = client.ask("textDocument/inlayHint", params).unwrap();
    assert_eq!(hints[0]["label"], "sync/event/sync/event/sync: a, b, k");
    let hover = client.ask_at(&path, json!({ "line": 8, "character": 10 }), "hover", json!({})).unwrap();
    let shown = hover["contents"]["value"].as_str().unwrap();
    assert!(shown.starts_with("```afg\na -> one.a\n") && shown.contains("\nb -> two.b\n"), "{shown}");
    let node = client.ask_at(&path, json!({ "line": 8, "character": 14 }), "hover", json!({})).unwrap();
    assert!(node["contents"]["value"].as_str().unwrap().starts_with("```afg\nnode one\n"), "{node}");
    let mut written = |at: u32| {
        let params =
            json!({ "textDocument": { "uri": uri(&path) }, "range": line(at), "context": { "diagnostics": [] } });
        let found = client.ask("textDocument/codeAction", params).unwrap();
        let action = found.as_array().unwrap().iter().find(|action| action["kind"] == "refactor.rewrite").cloned();
        action.map(|action| action["edit"]["changes"][uri(&path)][0]["newText"].as_str().unwrap().to_owned())
    };
    let all = "a -> one.a;\n    b -> [one.b, two.b];\n    k -> [one.k, two.k]";
    assert_eq!(written(8).as_deref(), Some(all));
    assert_eq!(written(9), None);
    assert_eq!(written(10).as_deref(), Some("one.d -> d"));
    assert!(client.stop());
}

#[test]
fn fixes() {
    let mut client = Client::start();
    let path = unsaved("fixing.afg");
    let text = "graph A {\n    in x: u8;\n    out y: u8;\n    x -> z\n    x -> yy;\n}\n";
    client.open(&path, text);
    let mut fixes = |line: u32| -> Vec<Value> {
        let range = json!({ "start": { "line": line, "character": 4 }, "end": { "line": line, "character": 10 } });
        let params = json!({ "textDocument": { "uri": uri(&path) }, "range": range, "context": { "diagnostics": [] } });
        client.ask("textDocument/codeAction", params).unwrap().as_array().unwrap().clone()
    };
    assert_eq!(fixes(1), Vec::<Value>::new());
    let found = fixes(3);
    assert_eq!(found[0]["title"], "end the statement");
    assert_eq!(found[0]["kind"], "quickfix");
    assert_eq!(found[0]["diagnostics"][0]["code"], "syntax");
    let edit = &found[0]["edit"]["changes"][uri(&path)][0];
    assert_eq!(
        (edit["newText"].as_str(), &edit["range"]["start"]),
        (Some(";"), &json!({ "line": 3, "character": 10 }))
    );
    client.change(&path, None, &text.replace("z\n", "y;\n"));
    let range = json!({ "start": { "line": 4, "character": 9 }, "end": { "line": 4, "character": 9 } });
    let params = json!({ "textDocument": { "uri": uri(&path) }, "range": range, "context": { "diagnostics": [] } });
    let found = client.ask("textDocument/codeAction", params).unwrap();
    assert_eq!(found[0]["edit"]["changes"][uri(&path)][0]["newText"], "y", "{found}");
    assert!(client.stop());
}

#[test]
fn the_style_of_the_language() {
    let mut client = Client::start();
    let path = unsaved("style.afg");
    let mut format = |text: &str| {
        client.open(&path, text);
        let params =
            json!({ "textDocument": { "uri": uri(&path) }, "options": { "tabSize": 4, "insertSpaces": true } });
        client.ask("textDocument/formatting", params).unwrap()
    };
    // Only the missing blanks are inserted.
    let edit = &format("// ü\ngraph A {\n  in x: u64;\n}\n")[0];
    assert_eq!(
        (edit["newText"].as_str(), &edit["range"]["start"]["line"], &edit["range"]["end"]["line"]),
        (Some("  "), &json!(2), &json!(2))
    );
    for text in ["graph A {\n    in x: u64;\n}\n", "graph A {\n  in x u64;\n}\n", "graph A {"] {
        assert_eq!(format(text), json!([]), "{text}");
    }
    assert!(client.stop());
}
