//! Random edits of the source files of the repository. The server answers every request, and every place in an answer
//! exists in the text. `APEX_EDITS=50000` sets the number of edits.

use crate::client::{Client, position, repository, unsaved, uri};
use serde_json::{Value, json};
use std::{env, fs, ops::Range, path::Path};

const EDITS: usize = 3000;
/// Number of edits of one source file before the next one is opened.
const PER_TEXT: usize = 25;
/// Maximum size of a source file in bytes; larger ones only take longer.
const MAX_BYTES: u64 = 6000;

/// Pieces of text to insert.
const PIECES: [&str; 40] = [
    "/*",
    "*/",
    "//",
    "// x",
    "///",
    "\"",
    "\\",
    "{",
    "}",
    "(",
    ")",
    "[",
    "]",
    "<",
    ">",
    ";",
    ":",
    "::",
    ",",
    ".",
    "->",
    "=>",
    "=",
    "\n",
    "\r\n",
    "\r",
    "\t",
    "ü",
    "😀",
    "\u{feff}",
    "graph A { ",
    "fsm F { state s { ",
    "use broken::Inner;\n",
    "test t: A { ",
    "node n = Inner();",
    "x -> y;",
    "in x: Vec<",
    "1e999",
    "every 20",
    "\0",
];

/// A small random number generator (xorshift64*).
struct Dice(u64);

impl Dice {
    fn below(&mut self, n: usize) -> usize {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        ((self.0.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 33) % n.max(1) as u64) as usize
    }

    /// Random offset between two characters.
    fn place(&mut self, text: &str) -> usize {
        let at = self.below(text.len() + 1);
        (at..=text.len()).find(|i| text.is_char_boundary(*i)).unwrap()
    }

    /// Random range and its replacement.
    fn edit(&mut self, text: &str) -> (Range<usize>, String) {
        let start = self.place(text);
        let length = self.below(30);
        let end = (start + length..=text.len()).find(|i| text.is_char_boundary(*i)).unwrap_or(text.len());
        match self.below(4) {
            0 => (start..end, String::new()),
            1 => (start..start, text[start..end].to_owned()),
            2 => (start..end, PIECES[self.below(PIECES.len())].to_owned()),
            _ => (start..start, PIECES[self.below(PIECES.len())].to_owned()),
        }
    }
}

/// Adds all source files in a folder and below.
fn texts(folder: &Path, found: &mut Vec<String>) {
    let mut entries: Vec<_> = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    entries.sort();
    for path in entries {
        let is_text = path.extension().is_some_and(|e| e == "afg");
        if path.is_dir() && path.file_name().is_some_and(|name| name != "target") {
            texts(&path, found);
        } else if is_text && fs::metadata(&path).unwrap().len() <= MAX_BYTES {
            found.extend(fs::read_to_string(&path));
        }
    }
}

/// Number of columns of each line.
fn columns(text: &str) -> Vec<usize> {
    let text = text.replace("\r\n", "\n").replace('\r', "\n");
    text.split('\n').map(|line| line.encode_utf16().count()).collect()
}

/// Checks all positions in an answer that refer to the source file at `uri`.
fn look(answer: &Value, uri: &str, columns: &[usize]) {
    match answer {
        Value::Array(items) => items.iter().for_each(|item| look(item, uri, columns)),
        Value::Object(fields) if fields.get("uri").is_some_and(|other| other != uri) => {}
        Value::Object(fields) => {
            if let (Some(line), Some(column)) = (fields.get("line"), fields.get("character")) {
                let (line, column) = (line.as_u64().unwrap() as usize, column.as_u64().unwrap() as usize);
                let width = columns.get(line);
                assert!(width.is_some_and(|w| column <= *w), "{line}:{column} is not in the text");
            }
            fields
                .iter()
                .filter(|(key, _)| !key.contains("://") || *key == uri)
                .for_each(|(_, v)| look(v, uri, columns));
        }
        Value::String(text) => assert_ne!(text, "the server failed; please report this"),
        _ => {}
    }
}

/// Sends all kinds of requests about a source file after an edit at `at`.
fn ask_all(client: &mut Client, path: &Path, text: &str, at: usize, other: usize) {
    let (uri, columns) = (uri(path), columns(text));
    let look = |answer: Value| look(&answer, &uri, &columns);
    look(Value::Array(client.diagnostics(path)));
    client.said.clear();
    let (at, other) = (position(&text[..at]), position(&text[..other]));
    for (method, at) in [("completion", &at), ("hover", &at), ("hover", &other), ("definition", &other)] {
        look(client.ask_at(path, at.clone(), method, json!({})).unwrap());
    }
    let document = json!({ "uri": uri });
    let all = json!({ "start": position(""), "end": position(text) });
    for (method, more) in [
        ("documentSymbol", json!({})),
        ("inlayHint", json!({ "range": all })),
        ("formatting", json!({ "options": { "tabSize": 4, "insertSpaces": true } })),
        ("codeAction", json!({ "range": { "start": at, "end": at }, "context": { "diagnostics": [] } })),
    ] {
        let mut params = more;
        params["textDocument"] = document.clone();
        look(client.ask(&format!("textDocument/{method}"), params).unwrap());
    }
}

#[test]
fn random_edits() {
    let edits = env::var("APEX_EDITS").ok().and_then(|n| n.parse().ok()).unwrap_or(EDITS);
    let mut whole = vec![];
    ["robots", "tests", "docs"].iter().for_each(|folder| texts(&repository().join(folder), &mut whole));
    assert!(whole.len() > 100, "{} texts", whole.len());
    std::thread::scope(|scope| {
        for seed in [14, 15] {
            let whole = &whole;
            scope.spawn(move || edit_texts(whole, edits / 2, seed));
        }
    });
}

/// Edits some of these source files, each in steps that are asked about, in an editor of its own.
fn edit_texts(whole: &[String], edits: usize, seed: u64) {
    let mut client = Client::start();
    let path = unsaved("edits.afg");
    client.open(&unsaved("broken.afg"), "use edits::A;\ngraph Inner { in x: u8; out y: u8; nonsense; x -> z; }\n");
    let mut dice = Dice(seed);
    for round in 0..edits.div_ceil(PER_TEXT) {
        let mut text = whole[dice.below(whole.len())].clone();
        client.open(&path, &text);
        for edit in 0..PER_TEXT {
            let (range, piece) = dice.edit(&text);
            let change = json!({ "start": position(&text[..range.start]), "end": position(&text[..range.end]) });
            let had_return = text.contains('\r');
            text.replace_range(range.clone(), &piece);
            // An edit that separates or joins `\r` and `
            // ` changes the numbers of lines.
            if had_return || text.contains('\r') {
                client.change(&path, None, &text);
            } else {
                client.change(&path, Some(change), &piece);
            }
            let other = dice.place(&text);
            let asked = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| {
                ask_all(&mut client, &path, &text, range.start, other);
            }));
            assert!(asked.is_ok(), "round {round}, edit {edit}:\n{text:?}");
        }
    }
    assert!(client.stop());
}
