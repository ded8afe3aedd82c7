//! Parsing: turns a source file into a syntax tree. An incorrect statement does not hide the next one.

mod build;
mod characters;
pub mod cst;
#[rustfmt::skip]
#[allow(missing_docs, dead_code)]
mod grammar;
pub mod keywords;
mod mistakes;
mod prescan;
mod repair;
mod syntax_errors;
pub mod tokens;
pub mod tree;

use crate::{
    report::Diagnostics,
    source::{FileId, Span},
};
use pest::Parser as _;

pub use prescan::{MAX_BYTES, MAX_DEPTH};
pub use repair::repaired;

use grammar::Grammar;
pub use grammar::Rule;

/// Parses a source file. Always returns a tree; the parts that cannot be parsed are reported and left out.
pub fn parse(file: FileId, text: &str, diagnostics: &mut Diagnostics) -> tree::File {
    let broken = || tree::File { broken: true, broken_items: true, ..Default::default() };
    let Some(lexical) = prescan::scan(file, text, diagnostics) else {
        return around_damage(file, text, diagnostics).unwrap_or_else(broken);
    };
    match Grammar::parse(Rule::file, &lexical.text) {
        Ok(mut pairs) => {
            let builder = build::Builder::new(file, &lexical.text, vec![], diagnostics);
            let mut tree = pairs.next().map_or_else(broken, |pair| builder.file(pair));
            tree.comments = lexical.comments;
            tree
        }
        Err(error) => {
            diagnostics.push(syntax_errors::diagnose(file, 0, &lexical.text, &error));
            broken()
        }
    }
}

/// Parses the intact parts of a source file with wrong brackets, strings, comments or characters, so that errors
/// elsewhere are reported, too. The wrong parts have been reported before.
fn around_damage(file: FileId, text: &str, diagnostics: &mut Diagnostics) -> Option<tree::File> {
    let mut repaired = repair::repaired(text)?;
    let mut edits = repair::edits(text, &repaired);
    // Nothing behind a comment without an end is known to be code.
    if let Some(at) = edits.iter().copied().find(|at| text[*at..].starts_with("/*")) {
        repaired = repair::repaired_before(text, at)?;
        edits = repair::edits(text, &repaired);
    }
    let lexical = prescan::scan(file, &repaired, &mut Diagnostics::default())?;
    let pair = Grammar::parse(Rule::file, &lexical.text).ok()?.next()?;
    let tree = build::Builder::new(file, &lexical.text, edits, diagnostics).until(text.len()).file(pair);
    // Text that was added behind the end is not a place in the source file.
    let is_inside = |span: &Span| span.file != file || span.end as usize <= text.len();
    diagnostics.retain(|d| d.places().all(|span| is_inside(&span)));
    Some(tree::File { broken: true, comments: lexical.comments, ..tree })
}

/// Reads a source file with all its tokens and comments; `None` if it has errors, which are reported.
pub fn read<'t>(file: FileId, text: &'t str, diagnostics: &mut Diagnostics) -> Option<cst::Text<'t>> {
    let lexical = prescan::scan(file, text, diagnostics)?;
    let pair = match Grammar::parse(Rule::file, &lexical.text) {
        Ok(mut pairs) => pairs.next()?,
        Err(error) => {
            diagnostics.push(syntax_errors::diagnose(file, 0, &lexical.text, &error));
            return None;
        }
    };
    let tree = build::Builder::new(file, &lexical.text, vec![], diagnostics).file(pair.clone());
    (!tree.broken && !diagnostics.has_errors()).then(|| cst::read(text, &lexical, pair))
}
