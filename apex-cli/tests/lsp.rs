//! The language server as an editor starts it, with arbitrary input.

#[allow(dead_code, reason = "other tests use the rest")]
mod common;

use common::{Folder, apex};
use serde_json::{Value, json};
use std::{
    io::{BufRead as _, BufReader, Read as _, Write as _},
    process::{Child, ChildStdin, ChildStdout, Stdio},
};

/// A server with an open source file.
struct Server {
    child: Child,
    input: Option<ChildStdin>,
    output: BufReader<ChildStdout>,
    next: i64,
    /// Messages since the last request, without its answer.
    came: Vec<Value>,
    text: String,
}

impl Server {
    fn start(folder: &Folder) -> Self {
        let mut child = apex().arg("lsp").stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap();
        let (input, output) = (child.stdin.take(), BufReader::new(child.stdout.take().unwrap()));
        let text = format!("file://{}", folder.0.join("open.afg").display());
        let mut server = Self { child, input, output, next: 0, came: vec![], text };
        server.ask("initialize", json!({ "capabilities": {} }));
        let document = json!({ "uri": server.text, "languageId": "afg", "version": 1, "text": "graph A { }\n" });
        server.tell("textDocument/didOpen", &json!({ "textDocument": document }));
        server
    }

    fn write(&mut self, bytes: &[u8]) {
        let input = self.input.as_mut().unwrap();
        input.write_all(bytes).unwrap();
        input.flush().unwrap();
    }

    fn send(&mut self, body: &[u8]) {
        self.write(format!("Content-Length: {}\r\n\r\n", body.len()).as_bytes());
        self.write(body);
    }

    fn tell(&mut self, method: &str, params: &Value) {
        self.send(json!({ "jsonrpc": "2.0", "method": method, "params": params }).to_string().as_bytes());
    }

    /// Sends a request and waits for its answer.
    fn ask(&mut self, method: &str, params: Value) -> Value {
        self.next += 1;
        let id = self.next;
        self.came.clear();
        self.send(json!({ "jsonrpc": "2.0", "id": id, "method": method, "params": params }).to_string().as_bytes());
        loop {
            let message = self.read();
            if message["id"] == id {
                return message;
            }
            self.came.push(message);
        }
    }

    fn read(&mut self) -> Value {
        let mut length = 0;
        loop {
            let mut line = String::new();
            assert!(self.output.read_line(&mut line).unwrap() > 0, "the server went away");
            match line.trim_end() {
                "" => break,
                header => length = header.strip_prefix("Content-Length: ").unwrap().parse().unwrap(),
            }
        }
        let mut body = vec![0; length];
        self.output.read_exact(&mut body).unwrap();
        serde_json::from_slice(&body).unwrap()
    }

    /// Names in the outline of the open source file.
    fn outline(&mut self) -> Vec<String> {
        let params = json!({ "textDocument": { "uri": self.text } });
        let answer = self.ask("textDocument/documentSymbol", params);
        answer["result"].as_array().unwrap().iter().map(|s| s["name"].as_str().unwrap().to_owned()).collect()
    }

    /// Shuts the server down. Returns the exit code.
    fn stop(mut self) -> Option<i32> {
        assert_eq!(self.ask("shutdown", Value::Null)["result"], Value::Null);
        self.tell("exit", &Value::Null);
        drop(self.input.take());
        self.child.wait().unwrap().code()
    }
}

#[test]
fn no_message_ends_the_server() {
    let folder = Folder::new("lsp");
    let mut server = Server::start(&folder);
    assert_eq!(server.outline(), ["A"]);
    let body = |body: &str| format!("Content-Length: {}\r\n\r\n{body}", body.len());
    // Each is answered with an error, and the next message is understood.
    for (damage, code) in [
        (body("{nope"), -32700),
        (body(""), -32700),
        (body(&"[".repeat(100_000)), -32700),
        (body("7"), -32600),
        (body("[]"), -32600),
        (body(r#"{"jsonrpc":"2.0"}"#), -32600),
        (body(r#"{"jsonrpc":"2.0","method":7}"#), -32600),
        ("nonsense".to_owned(), -32600),
        ("nonsense\r\n\r\n".to_owned(), -32600),
        ("Content-Length: many\r\n\r\n".to_owned(), -32600),
        ("Content-Length: 18446744073709551615\r\n\r\n".to_owned(), -32600),
        ("Content-Length: 99999999999999999999999999\r\n\r\n{}".to_owned(), -32600),
        (format!("Content-Length: {}\r\n\r\n{{", 1u64 << 40), -32600),
        ("x".repeat(100_000), -32600),
    ] {
        server.write(damage.as_bytes());
        let shown: String = damage.chars().take(60).collect();
        assert_eq!(server.outline(), ["A"], "{shown}");
        let errors: Vec<&Value> = server.came.iter().filter(|m| m["id"].is_null() && m["error"].is_object()).collect();
        assert_eq!(errors.len(), 1, "{shown}: {errors:?}");
        assert_eq!(errors[0]["error"]["code"], code, "{shown}: {errors:?}");
    }
    // Parameters of the wrong type.
    for params in [json!(null), json!([1]), json!({ "textDocument": 3 })] {
        assert_eq!(server.ask("textDocument/hover", params.clone())["error"]["code"], -32602, "{params}");
        server.tell("textDocument/didChange", &params);
        server.tell("$/cancelRequest", &params);
    }
    assert_eq!(server.outline(), ["A"]);
    assert_eq!(server.stop(), Some(0));
}

/// Invalid characters are replaced, so that the text stays the same as in the editor.
#[test]
fn characters_that_are_none() {
    let folder = Folder::new("lsp-characters");
    let mut server = Server::start(&folder);
    for (version, escaped) in [(2, r"\ud800"), (3, r"\udc00\ud800"), (4, "\u{fffd}")] {
        let text = format!(r"graph B {{ }} // {escaped}\ngraph C {{ }}\n");
        let params = format!(
            r#"{{"textDocument":{{"uri":"{}","version":{version}}},"contentChanges":[{{"text":"{text}"}}]}}"#,
            server.text
        );
        let body = format!(r#"{{"jsonrpc":"2.0","method":"textDocument/didChange","params":{params}}}"#);
        // The last one stands for bytes that are not UTF-8.
        let pieces: Vec<&[u8]> = body.split('\u{fffd}').map(str::as_bytes).collect();
        server.send(&pieces.join(&b"\xff\xfe"[..]));
        assert_eq!(server.outline(), ["B", "C"], "{escaped}");
    }
    assert_eq!(server.stop(), Some(0));
}

/// Number of times that threads of the server have begun to wait. It grows whenever a thread wakes up.
#[cfg(target_os = "linux")]
fn waits(server: &Server) -> u64 {
    let tasks = std::fs::read_dir(format!("/proc/{}/task", server.child.id())).unwrap();
    let count = |task: std::io::Result<std::fs::DirEntry>| {
        let status = std::fs::read_to_string(task.unwrap().path().join("status")).unwrap();
        let line = status.lines().find_map(|line| line.strip_prefix("voluntary_ctxt_switches:"));
        line.unwrap().trim().parse::<u64>().unwrap()
    };
    tasks.map(count).sum()
}

/// An idle server sleeps, without polling.
#[cfg(target_os = "linux")]
#[test]
fn nothing_happens_while_nothing_happens() {
    use std::{thread::sleep, time::Duration};
    let folder = Folder::new("lsp-idle");
    let mut server = Server::start(&folder);
    server.outline();
    let is_still = |server: &Server| {
        let before = waits(server);
        sleep(Duration::from_secs(1));
        waits(server) == before
    };
    // An earlier request may still be in progress.
    assert!((0..30).any(|_| is_still(&server)));
    assert_eq!(server.stop(), Some(0));
}
