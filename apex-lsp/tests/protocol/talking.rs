//! Communication between server and editor.

use crate::{
    client::{Client, range, unsaved, uri},
    package::Package,
};
use lsp_server::Message;
use serde_json::{Value, json};
use std::{fs, time::Duration};

#[test]
fn comes_and_goes() {
    let (client, capabilities) = Client::with(json!({}));
    assert_eq!(capabilities["positionEncoding"], "utf-16");
    assert_eq!(capabilities["hoverProvider"], true);
    assert!(client.stop());
    assert!(Client::start().leave());
}

#[test]
fn a_client_that_only_says_exit_was_impolite() {
    let (server, client) = lsp_server::Connection::memory();
    let server = std::thread::spawn(move || apex_lsp::serve(&server, apex_lsp::PATIENCE));
    let send = |text: Value| client.sender.send(serde_json::from_value(text).unwrap()).unwrap();
    send(json!({ "id": 1, "method": "textDocument/hover", "params": {} }));
    let early: Value = serde_json::to_value(client.receiver.recv().unwrap()).unwrap();
    assert_eq!(early["error"]["code"], -32002);
    send(json!({ "id": 2, "method": "initialize", "params": { "capabilities": {} } }));
    client.receiver.recv().unwrap();
    send(json!({ "method": "exit" }));
    assert!(!server.join().unwrap());
}

#[test]
fn what_it_does_not_know_is_an_error_of_the_protocol() {
    let mut client = Client::start();
    assert_eq!(
        client.ask("textDocument/nothing", json!({})),
        Err("`textDocument/nothing` is not supported".to_owned())
    );
    assert!(client.ask("textDocument/hover", json!({ "position": 3 })).unwrap_err().contains("Position"));
    client.tell("textDocument/didChange", json!("nonsense"));
    // Requests about a source file that is not open have no result.
    let nowhere =
        json!({ "textDocument": { "uri": "file:///nowhere.afg" }, "position": { "line": 0, "character": 0 } });
    assert_eq!(client.ask("textDocument/hover", nowhere), Ok(Value::Null));
    assert!(client.stop());
}

/// Every request has exactly one answer: from the worker, or as stale, cancelled or late.
#[test]
fn every_request_has_one_answer() {
    for patience in [0, 5, 600_000].map(Duration::from_millis) {
        let (server, client) = lsp_server::Connection::memory();
        let server = std::thread::spawn(move || apex_lsp::serve(&server, patience));
        let send = |text: Value| client.sender.send(serde_json::from_value(text).unwrap()).unwrap();
        send(json!({ "id": 0, "method": "initialize", "params": { "capabilities": {} } }));
        let text = uri(&std::env::temp_dir().join("one_answer.afg"));
        let item = json!({ "uri": text, "languageId": "afg", "version": 0, "text": "graph A { }\n" });
        send(json!({ "method": "textDocument/didOpen", "params": { "textDocument": item } }));
        for id in 1..=300 {
            let at = json!({ "textDocument": { "uri": text }, "position": { "line": 0, "character": 0 } });
            send(json!({ "id": id, "method": "textDocument/hover", "params": at }));
            let document = json!({ "uri": text, "version": id });
            let changes = json!([{ "text": "graph B { in x: u8; }\n".repeat(id % 40) }]);
            let change = json!({ "textDocument": document, "contentChanges": changes });
            match id % 7 {
                0 => send(json!({ "method": "$/cancelRequest", "params": { "id": id - 1 } })),
                3 => send(json!({ "method": "textDocument/didChange", "params": change })),
                _ => {}
            }
        }
        // Requests in the queue are answered after the editor has disconnected.
        drop(client.sender);
        let mut answers = vec![0; 301];
        for message in client.receiver {
            if let Message::Response(response) = message {
                let id: usize = response.id.to_string().parse().unwrap();
                answers[id] += 1;
                if let Err(error) = response.response_result {
                    assert!([-32800, -32801, -32802].contains(&error.code), "{error:?}");
                }
            }
        }
        assert!(server.join().unwrap());
        assert!(answers.iter().all(|n| *n == 1), "{patience:?}: {answers:?}");
    }
}

#[test]
fn errors_while_typing() {
    let mut client = Client::start();
    let path = unsaved("typing.afg");
    let text = "graph A {\n    in x: f64;\n    out y: f64;\n    x -> y;\n}\n";
    client.open(&path, text);
    assert_eq!(client.diagnostics(&path), Vec::<Value>::new());

    client.change(&path, Some(range(text, "x -> y")), "x -> z");
    let found = client.diagnostics(&path);
    let codes: Vec<&str> = found.iter().map(|d| d["code"].as_str().unwrap()).collect();
    assert_eq!(codes, ["unknown-node"]);
    assert!(
        found[0]["message"].as_str().unwrap().starts_with("there is no node or port `z` in this graph\ndeclare it")
    );
    assert_eq!(found[0]["range"]["start"], json!({ "line": 3, "character": 9 }));

    client.change(&path, Some(range(&text.replace("x -> y", "x -> z"), "x -> z;\n}\n")), "x -> ");
    let found = client.diagnostics(&path);
    assert_eq!(found.len(), 1, "{found:?}");
    assert_eq!((found[0]["code"].as_str(), found[0]["severity"].as_i64()), (Some("unclosed"), Some(1)));

    client.change(&path, None, text);
    assert_eq!(client.diagnostics(&path), Vec::<Value>::new());
    assert!(client.stop());
}

/// Columns are UTF-16 code units unless the client offers bytes. Windows line ends are supported.
#[test]
fn columns() {
    let text = "/// 😀ü\r\ngraph A {\r\n    /* 😀 */ node a = Nothing();\r\n}\r\n";
    for (offered, column) in [(json!(["utf-16"]), 22), (json!(["utf-32", "utf-8"]), 24)] {
        let (mut client, capabilities) = Client::with(json!({ "general": { "positionEncodings": offered } }));
        let path = unsaved("columns.afg");
        client.open(&path, text);
        let found = client.diagnostics(&path);
        assert_eq!(found[0]["range"]["start"], json!({ "line": 2, "character": column }), "{capabilities}");
        // A change after characters that are wider than one column.
        let end = json!({ "line": 2, "character": column + 7 });
        client.change(&path, Some(json!({ "start": { "line": 2, "character": column }, "end": end })), "B");
        let found = client.diagnostics(&path);
        assert!(found[0]["message"].as_str().unwrap().starts_with("there is no node or graph `B`"), "{found:?}");
        assert!(client.stop());
    }
}

const RAMP: &str = "use apex_rt::prelude::*;\n/// Up.\n#[node]\npub fn ramp() -> u64 { 1 }\n";

#[test]
fn nodes_that_change_are_read_again() {
    let package = Package::new("nodes", RAMP);
    let path = package.0.join("robot.afg");
    let text = "graph A {\n    ramp() -> show();\n}\n";
    let more = format!("{RAMP}#[node]\npub fn show(x: &u64) {{}}\n");

    // A client that watches files.
    let (mut client, _) =
        Client::with(json!({ "workspace": { "didChangeWatchedFiles": { "dynamicRegistration": true } } }));
    client.open(&path, text);
    assert_eq!(client.diagnostics(&path)[0]["code"], "unknown-node");
    let source = package.0.join("src/lib.rs");
    fs::write(&source, &more).unwrap();
    client.tell("workspace/didChangeWatchedFiles", json!({ "changes": [{ "uri": uri(&source), "type": 2 }] }));
    client.said.clear();
    assert_eq!(client.diagnostics(&path), Vec::<Value>::new());
    assert!(client.stop());

    // A client that does not: the nodes are read when a source file is saved.
    let mut client = Client::start();
    client.open(&path, text);
    assert_eq!(client.diagnostics(&path), Vec::<Value>::new());
    fs::write(&source, RAMP).unwrap();
    client.said.clear();
    client.tell("textDocument/didSave", json!({ "textDocument": { "uri": uri(&path) } }));
    assert_eq!(client.diagnostics(&path)[0]["code"], "unknown-node");
    assert!(client.stop());
}

#[test]
fn a_package_that_cargo_cannot_read() {
    let package = Package::new("broken", RAMP);
    fs::write(package.0.join("Cargo.toml"), "[package\n").unwrap();
    let path = package.0.join("robot.afg");
    let mut client = Client::start();
    client.open(&path, "graph A { }\n");
    let found = client.diagnostics(&path);
    assert!(
        found[0]["message"].as_str().unwrap().starts_with("cannot read the nodes of the package: cargo"),
        "{found:?}"
    );
    assert!(client.stop());
}

/// The text in the editor has precedence over the disk. Errors in an imported source file are shown at the import.
#[test]
fn texts_that_import_each_other() {
    let mut client = Client::start();
    let (inner, outer) = (unsaved("inner.afg"), unsaved("outer.afg"));
    client.open(&inner, "graph Inner { in x: u8; out y: u8; x -> y; }\n");
    client.open(&outer, "use inner::Inner;\ngraph Outer { in x: u8; out y: u8; x -> Inner() -> y; }\n");
    assert_eq!(client.diagnostics(&outer), Vec::<Value>::new());

    client.change(&inner, None, "graph Inner { in x: u8; out y: u16; x -> y; }\n");
    let version = client.diagnostics(&inner);
    assert_eq!(version[0]["code"], "type-mismatch");
    client.tell("textDocument/didClose", json!({ "textDocument": { "uri": uri(&inner) } }));
    client.change(&outer, None, "use inner::Inner;\ngraph Outer { }\n");
    let found = client.diagnostics(&outer);
    assert_eq!(found[0]["code"], "unknown-import", "{found:?}");
    assert!(client.stop());
}
