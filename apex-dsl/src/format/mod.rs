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
        self,
        concrete::{Text, closes},
    },
};
use layout::Layout;

/// `text` in the style of the language. Line ends stay what the first one is.
///
/// # Errors
/// What is wrong with a text that cannot be read, with spans in the first file of the sources.
pub fn format(text: &str) -> Result<String, Diagnostics> {
    let file = FileId(0);
    let mut diagnostics = Diagnostics::default();
    let Some(before) = syntax::read(file, text, &mut diagnostics) else { return Err(diagnostics) };
    let formatted = print::print(&Layout::new(&before.tokens).file(&before.root), newline(text));
    match syntax::read(file, &formatted, &mut Diagnostics::default()) {
        Some(after) if words(&before) == words(&after) && comments(&before) == comments(&after) => Ok(formatted),
        _ => {
            let message = "the formatter would change what this text says, and has left it alone";
            let error = Diagnostic::error(UNFAITHFUL, Span::new(file, 0, 0), message);
            diagnostics.push(error.note("this is a mistake of the formatter: please report it with the text"));
            Err(diagnostics)
        }
    }
}

/// No text should lead to it.
const UNFAITHFUL: &str = "formatter";

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
