//! The formatter: one style, without loss of any part of a source file.
//!
//! `layout` determines the possible line breaks by the rules of the grammar, and writes every token with its comments.
//! `print` chooses the line breaks. The result is parsed again and compared with the input.

mod columns;
mod doc;
mod layout;
mod lists;
mod print;

use apex_dsl::{
    report::{Diagnostic, Diagnostics},
    source::{FileId, Span},
    syntax::{
        self, MAX_BYTES,
        cst::{Text, closes},
    },
};
use layout::Layout;

/// `text` in the style of the language. All line ends become those of the first line.
///
/// # Errors
/// Returns the errors in a text that cannot be parsed, with spans in the first file of the sources.
pub fn format(text: &str) -> Result<String, Diagnostics> {
    let mut diagnostics = Diagnostics::default();
    let Some(read) = syntax::read(FileId(0), text, &mut diagnostics) else { return Err(diagnostics) };
    settled(&read, newline(text)).map_err(|error| {
        diagnostics.push(*error);
        diagnostics
    })
}

/// Largest number of rounds: a comment may move to another token, so that the second round differs from the first.
const MOST_ROUNDS: usize = 8;

/// The formatted text, formatted again until it no longer changes.
fn settled(text: &Text<'_>, newline: &str) -> Result<String, Box<Diagnostic>> {
    let error = |code, message: String| Diagnostic::error(code, Span::new(FileId(0), 0, 0), message);
    let write = |text: &Text<'_>| print::print(&Layout::new(&text.tokens).file(&text.root), newline);
    let mut formatted = write(text);
    for _ in 0..MOST_ROUNDS {
        if formatted.len() > MAX_BYTES {
            let message =
                format!("the formatted source file has {} bytes, but at most {MAX_BYTES} are read", formatted.len());
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
    let message = "the formatter cannot format this source file and has left it unchanged";
    let error = error(FAILED, message.to_owned());
    Err(Box::new(error.note("this is a bug in the formatter: please report it with the source file")))
}

/// The same code as for source files that are too large to be read.
const TOO_LARGE: &str = "too-large";
/// Code of an error that should never occur.
const FAILED: &str = "formatter";

fn newline(text: &str) -> &'static str {
    match text.find('\n') {
        Some(at) if text[..at].ends_with('\r') => "\r\n",
        _ => "\n",
    }
}

/// The tokens, without commas behind the last elements of lists.
fn words<'t>(text: &Text<'t>) -> Vec<&'t str> {
    let next = text.tokens.iter().skip(1).map(|t| t.text).chain([""]);
    text.tokens.iter().map(|t| t.text).zip(next).filter(|(t, n)| *t != "," || !closes(n)).map(|(t, _)| t).collect()
}

fn comments(text: &Text<'_>) -> Vec<String> {
    let all = text.tokens.iter().flat_map(|t| t.before.iter().chain(&t.after));
    all.map(|c| c.text.replace("\r\n", "\n")).collect()
}
