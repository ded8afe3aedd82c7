//! An editor for tests that communicates with a server in the same process.

use lsp_server::{Connection, Message, Notification, Request, RequestId, Response};
use serde_json::{Value, json};
use std::{
    path::{Path, PathBuf},
    thread::JoinHandle,
    time::Duration,
};

/// Longer than any check takes, also in a debug build on a busy machine.
const PATIENCE: Duration = Duration::from_secs(600);

/// An editor with its server.
pub struct Client {
    connection: Option<Connection>,
    server: Option<JoinHandle<bool>>,
    next: i32,
    version: i32,
    /// Notifications of the server.
    pub said: Vec<Notification>,
}

/// A source file in the folder of PATSY, which can use the library. It exists in the editor only.
pub fn unsaved(name: &str) -> PathBuf {
    repository().join("robots/patsy").join(name)
}

/// Root of the repository.
pub fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap().to_owned()
}

/// Address of a file.
pub fn uri(path: &Path) -> String {
    format!("file://{}", path.display())
}

impl Client {
    /// Starts a server for an editor with the usual capabilities.
    pub fn start() -> Self {
        Self::with(json!({
            "textDocument": { "completion": { "completionItem": { "snippetSupport": true } } },
        }))
        .0
    }

    /// Starts a server for an editor with `capabilities`; also returns the capabilities of the server.
    pub fn with(capabilities: Value) -> (Self, Value) {
        let (server, connection) = Connection::memory();
        let server = std::thread::spawn(move || apex_lsp::serve(&server, PATIENCE));
        let mut client = Self { connection: Some(connection), server: Some(server), next: 0, version: 0, said: vec![] };
        let answer = client.ask("initialize", json!({ "capabilities": capabilities })).unwrap();
        client.tell("initialized", json!({}));
        (client, answer["capabilities"].clone())
    }

    fn connection(&self) -> &Connection {
        self.connection.as_ref().unwrap()
    }

    /// Sends a notification.
    pub fn tell(&self, method: &str, params: Value) {
        let message = Notification { method: method.to_owned(), params };
        self.connection().sender.send(message.into()).unwrap();
    }

    /// Sends a request and waits for the answer: the result, or the error message.
    pub fn ask(&mut self, method: &str, params: Value) -> Result<Value, String> {
        self.next += 1;
        let id = RequestId::from(self.next);
        let request = Request { id: id.clone(), method: method.to_owned(), params };
        self.connection().sender.send(request.into()).unwrap();
        loop {
            match self.connection().receiver.recv().expect("the server went away") {
                Message::Response(Response { id: of, response_result }) if of == id => {
                    if let Err(error) = &response_result {
                        assert_ne!(error.code, -32603, "the server failed");
                    }
                    return response_result.map_err(|e| e.message);
                }
                Message::Response(_) => panic!("an answer to nothing"),
                Message::Notification(notification) => self.said.push(notification),
                Message::Request(_) => {}
            }
        }
    }

    /// Opens a source file.
    pub fn open(&mut self, path: &Path, text: &str) {
        self.version += 1;
        let document = json!({ "uri": uri(path), "languageId": "afg", "version": self.version, "text": text });
        self.tell("textDocument/didOpen", json!({ "textDocument": document }));
    }

    /// Replaces a part of a source file, or all of it without a range.
    pub fn change(&mut self, path: &Path, range: Option<Value>, text: &str) {
        self.version += 1;
        let mut change = json!({ "text": text });
        if let Some(range) = range {
            change["range"] = range;
        }
        let document = json!({ "uri": uri(path), "version": self.version });
        self.tell("textDocument/didChange", json!({ "textDocument": document, "contentChanges": [change] }));
    }

    /// Diagnostics of the current version of a source file.
    pub fn diagnostics(&mut self, path: &Path) -> Vec<Value> {
        let (uri, version) = (uri(path), self.version);
        loop {
            let found = self.said.iter().rev().find(|n| {
                n.method == "textDocument/publishDiagnostics"
                    && n.params["uri"] == uri.as_str()
                    && n.params["version"] == version
            });
            if let Some(found) = found {
                return found.params["diagnostics"].as_array().unwrap().clone();
            }
            match self.connection().receiver.recv().expect("the server went away") {
                Message::Notification(notification) => self.said.push(notification),
                other => assert!(matches!(other, Message::Request(_)), "{other:?}"),
            }
        }
    }

    /// Sends a request about the position of `|` in `marked`. Opens the text without that character.
    pub fn at(&mut self, path: &Path, marked: &str, method: &str) -> Result<Value, String> {
        let (before, after) = marked.split_once('|').unwrap();
        self.open(path, &format!("{before}{after}"));
        self.ask_at(path, position(before), method, json!({}))
    }

    /// Sends a request about a position.
    pub fn ask_at(&mut self, path: &Path, position: Value, method: &str, more: Value) -> Result<Value, String> {
        let mut params = json!({ "textDocument": { "uri": uri(path) }, "position": position });
        for (key, value) in more.as_object().unwrap() {
            params[key] = value.clone();
        }
        self.ask(&format!("textDocument/{method}"), params)
    }

    /// Labels of the completions at `|`.
    pub fn completions(&mut self, path: &Path, marked: &str) -> Vec<String> {
        let found = self.at(path, marked, "completion").unwrap();
        found.as_array().unwrap().iter().map(|item| item["label"].as_str().unwrap().to_owned()).collect()
    }

    /// Shuts the server down. Returns `true` if it ended according to the protocol.
    pub fn stop(mut self) -> bool {
        self.ask("shutdown", Value::Null).unwrap();
        self.tell("exit", Value::Null);
        self.server.take().unwrap().join().unwrap()
    }

    /// Closes the connection without a shutdown.
    pub fn leave(mut self) -> bool {
        self.connection = None;
        self.server.take().unwrap().join().unwrap()
    }
}

/// Position after a text, in lines and UTF-16 columns.
pub fn position(before: &str) -> Value {
    let before = before.replace("\r\n", "\n").replace('\r', "\n");
    let line = before.matches('\n').count();
    let column = before.rsplit('\n').next().unwrap_or_default().encode_utf16().count();
    json!({ "line": line, "character": column })
}

/// Range of the only `part` in `text`.
pub fn range(text: &str, part: &str) -> Value {
    assert_eq!(text.matches(part).count(), 1, "{part}");
    let start = text.find(part).unwrap();
    json!({ "start": position(&text[..start]), "end": position(&text[..start + part.len()]) })
}
