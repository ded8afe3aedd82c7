//! The formatter: one style, and nothing of a text is lost.
//!
//! `layout` says where lines may end, by the rules of the grammar, and writes every token with its comments; `print`
//! finds the lines; what comes out is read again and compared with what went in.

mod columns;
mod doc;
mod layout;
mod lists;
mod print;

use crate::{
    report::{Diagnostic, Diagnostics},
    source::{FileId, Span},
    syntax::{
        self, MAX_BYTES,
        concrete::{Text, closes},
    },
};
use layout::Layout;

/// `text` in the style of the language. Line ends stay what the first one is.
///
/// # Errors
/// What is wrong with a text that cannot be read, with spans in the first file of the sources.
pub fn format(text: &str) -> Result<String, Diagnostics> {
    let mut diagnostics = Diagnostics::default();
    let Some(read) = syntax::read(FileId(0), text, &mut diagnostics) else { return Err(diagnostics) };
    settled(&read, newline(text)).map_err(|error| {
        diagnostics.push(*error);
        diagnostics
    })
}

/// A comment may come to stand where it belongs to another token; then the second time differs from the first.
const MOST_ROUNDS: usize = 8;

/// The formatted text, formatted until nothing changes any more.
fn settled(text: &Text<'_>, newline: &str) -> Result<String, Box<Diagnostic>> {
    let error = |code, message: String| Diagnostic::error(code, Span::new(FileId(0), 0, 0), message);
    let write = |text: &Text<'_>| print::print(&Layout::new(&text.tokens).file(&text.root), newline);
    let mut formatted = write(text);
    for _ in 0..MOST_ROUNDS {
        if formatted.len() > MAX_BYTES {
            let message = format!("formatted, this text has {} bytes; at most {MAX_BYTES} are read", formatted.len());
            return Err(Box::new(error(TOO_LARGE, message).note("split it into several files")));
        }
        let after = syntax::read(FileId(0), &formatted, &mut Diagnostics::default());
        let Some(after) = after.filter(|a| words(a) == words(text) && comments(a) == comments(text)) else { break };
        let again = write(&after);
        if again == formatted {
            return Ok(formatted);
        }
        formatted = again;
    }
    let message = "the formatter does not know how to write this text, and has left it alone";
    let error = error(FAILED, message.to_owned());
    Err(Box::new(error.note("this is a mistake of the formatter: please report it with the text")))
}

/// As for texts that are too large to be read.
const TOO_LARGE: &str = "too-large";
/// No text should lead to it.
const FAILED: &str = "formatter";

fn newline(text: &str) -> &'static str {
    match text.find('\n') {
        Some(at) if text[..at].ends_with('\r') => "\r\n",
        _ => "\n",
    }
}

/// The tokens, without commas behind the last thing of a list.
fn words<'t>(text: &Text<'t>) -> Vec<&'t str> {
    let next = text.tokens.iter().skip(1).map(|t| t.text).chain([""]);
    text.tokens.iter().map(|t| t.text).zip(next).filter(|(t, n)| *t != "," || !closes(n)).map(|(t, _)| t).collect()
}

fn comments(text: &Text<'_>) -> Vec<String> {
    let all = text.tokens.iter().flat_map(|t| t.before.iter().chain(&t.after));
    all.map(|c| c.text.replace("\r\n", "\n")).collect()
}
