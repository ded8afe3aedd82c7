//! Text → tree. A bad statement does not hide the next.

mod build;
pub(crate) mod concrete;
mod lexical;
mod mend;
mod recover;
pub mod tree;
pub mod words;

use crate::{
    report::Diagnostics,
    source::{FileId, Span},
};
use pest::Parser as _;

pub use lexical::{MAX_BYTES, MAX_DEPTH};
pub use mend::mended;

use grammar::Grammar;
pub(crate) use grammar::Rule;

/// The parser that pest makes of the grammar; the rules are documented there.
#[allow(missing_docs)]
mod grammar {
    #[derive(pest_derive::Parser)]
    #[grammar = "syntax/afg.pest"]
    pub struct Grammar;
}

/// Parses one text. Always gives a tree; what could not be read is reported and left out.
pub fn parse(file: FileId, text: &str, diagnostics: &mut Diagnostics) -> tree::File {
    let broken = || tree::File { broken: true, ..Default::default() };
    let Some(lexical) = lexical::scan(file, text, diagnostics) else { return broken() };
    match Grammar::parse(Rule::file, &lexical.text) {
        Ok(mut pairs) => {
            let builder = build::Builder::new(file, &lexical.text, diagnostics);
            let mut tree = pairs.next().map_or_else(broken, |pair| builder.file(pair));
            tree.comments = lexical.comments;
            tree
        }
        Err(error) => {
            diagnostics.push(recover::diagnose(file, 0, &lexical.text, &error));
            broken()
        }
    }
}

/// Reads a text with all its tokens and comments; nothing if it has errors, which are reported.
pub(crate) fn read<'t>(file: FileId, text: &'t str, diagnostics: &mut Diagnostics) -> Option<concrete::Text<'t>> {
    let lexical = lexical::scan(file, text, diagnostics)?;
    let pair = match Grammar::parse(Rule::file, &lexical.text) {
        Ok(mut pairs) => pairs.next()?,
        Err(error) => {
            diagnostics.push(recover::diagnose(file, 0, &lexical.text, &error));
            return None;
        }
    };
    let tree = build::Builder::new(file, &lexical.text, diagnostics).file(pair.clone());
    (!tree.broken && !diagnostics.has_errors()).then(|| concrete::read(text, &lexical, pair))
}

/// The span of a pair in `file`.
fn span_of(file: FileId, pair: &pest::iterators::Pair<'_, Rule>) -> Span {
    let span = pair.as_span();
    let trimmed = span.as_str().trim_end().len();
    Span::new(file, span.start(), span.start() + trimmed)
}
