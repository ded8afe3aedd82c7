//! The language server in this process, asked on behalf of one page.

use apex_lsp::{PATIENCE, serve};
use lsp_server::{Connection, Message, Notification, Request, RequestId, Response};
use serde_json::{Value, json};
use std::{collections::BTreeMap, io, thread};

/// A place in a file: its number, and line and column from 0 in UTF-16 code units.
pub type Place = (usize, u32, u32);

/// A running language server.
pub struct Language {
    connection: Connection,
    /// Requests without an answer.
    asked: BTreeMap<RequestId, (What, Place)>,
    /// Addresses of the open files, by number, each with the version of its text.
    open: BTreeMap<usize, (String, i32)>,
    count: i32,
}

/// Kind of a request.
#[derive(Clone, Copy)]
enum What {
    Hover,
    Complete,
}

/// Message of the language server.
pub enum Said {
    /// Diagnostics of a file, as the protocol has them.
    Diagnostics(usize, Vec<Value>),
    /// Description of what is at a place, in Markdown; empty for nothing.
    Hover(Place, String),
    /// Completions at a place, as the protocol has them.
    Completions(Place, Vec<Value>),
}

impl Language {
    /// Starts a language server. It ends with its connection.
    pub fn start() -> io::Result<Self> {
        let (server, connection) = Connection::memory();
        let thread = thread::Builder::new().name("language".to_owned());
        thread.spawn(move || serve(&server, PATIENCE))?;
        let mut language = Self { connection, asked: BTreeMap::new(), open: BTreeMap::new(), count: 0 };
        language.ask("initialize", json!({ "capabilities": {} }));
        language.note("initialized", json!({}));
        Ok(language)
    }

    /// Takes note of a text of a file at an address.
    pub fn text(&mut self, file: usize, uri: &str, text: &str) {
        let (_, version) = self.open.entry(file).or_insert_with(|| (uri.to_owned(), 0));
        *version += 1;
        if *version == 1 {
            let document = json!({ "uri": uri, "languageId": "afg", "version": 1, "text": text });
            self.note("textDocument/didOpen", json!({ "textDocument": document }));
        } else {
            let document = json!({ "uri": uri, "version": *version });
            let change = json!({ "textDocument": document, "contentChanges": [{ "text": text }] });
            self.note("textDocument/didChange", change);
        }
    }

    /// Takes note that a file was saved: others may read it.
    pub fn saved(&mut self, file: usize) {
        if let Some((uri, _)) = self.open.get(&file) {
            let saved = json!({ "textDocument": { "uri": uri } });
            self.note("textDocument/didSave", saved);
        }
    }

    /// Asks for a description of what is at a place.
    pub fn hover(&mut self, place: Place) {
        self.ask_at("textDocument/hover", What::Hover, place);
    }

    /// Asks for completions at a place.
    pub fn complete(&mut self, place: Place) {
        self.ask_at("textDocument/completion", What::Complete, place);
    }

    /// Messages since the last call.
    pub fn said(&mut self) -> Vec<Said> {
        let mut said = vec![];
        while let Ok(message) = self.connection.receiver.try_recv() {
            match message {
                Message::Notification(note) if note.method == "textDocument/publishDiagnostics" => {
                    said.extend(self.diagnostics(note.params));
                }
                Message::Response(response) => said.extend(self.answer(response)),
                _ => {}
            }
        }
        said
    }

    fn diagnostics(&self, mut params: Value) -> Option<Said> {
        let (file, (_, version)) = self.open.iter().find(|(_, (uri, _))| params["uri"] == uri.as_str())?;
        // Others are of an earlier text.
        let is_new = params["version"].is_null() || params["version"] == *version;
        let found = serde_json::from_value(params["diagnostics"].take()).unwrap_or_default();
        is_new.then_some(Said::Diagnostics(*file, found))
    }

    fn answer(&mut self, response: Response) -> Option<Said> {
        let (what, place) = self.asked.remove(&response.id)?;
        // A stale request has no result; the page asks again.
        let mut result = response.response_result.unwrap_or_default();
        Some(match what {
            What::Hover => Said::Hover(place, result["contents"]["value"].as_str().unwrap_or_default().to_owned()),
            What::Complete => Said::Completions(place, serde_json::from_value(result.take()).unwrap_or_default()),
        })
    }

    fn ask_at(&mut self, method: &str, what: What, place: Place) {
        let (file, line, character) = place;
        let Some((uri, _)) = self.open.get(&file) else { return };
        let position = json!({ "line": line, "character": character });
        let params = json!({ "textDocument": { "uri": uri }, "position": position });
        let id = self.ask(method, params);
        self.asked.insert(id, (what, place));
    }

    fn ask(&mut self, method: &str, params: Value) -> RequestId {
        self.count += 1;
        let id = RequestId::from(self.count);
        self.send(Request { id: id.clone(), method: method.to_owned(), params }.into());
        id
    }

    fn note(&self, method: &str, params: Value) {
        self.send(Notification { method: method.to_owned(), params }.into());
    }

    fn send(&self, message: Message) {
        // A server that has ended answers nothing; the text can still be edited and saved.
        let _ = self.connection.sender.send(message);
    }
}
