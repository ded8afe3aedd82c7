//! Hover.

use super::Ready;
use lsp_types::{Hover, HoverContents, MarkupContent, MarkupKind, Position};

/// Description of the name, arrow or keyword at a position.
pub fn hover(ready: &Ready<'_>, position: Position) -> Option<Hover> {
    let (view, offset) = (ready.view(), ready.offset(position));
    let (value, range) = match ready.occurrence(position) {
        Some(found) => {
            (apex_ide::describe(&view, found.definition), Some(ready.analysis.names.places.range(found.span)))
        }
        None => match arrow(ready, offset) {
            Some((value, range)) => (value, Some(range)),
            None => (apex_ide::describe_word(&view, &ready.analysis.text, offset)?, None),
        },
    };
    let contents = HoverContents::Markup(MarkupContent { kind: MarkupKind::Markdown, value });
    (!matches!(&contents, HoverContents::Markup(m) if m.value.is_empty())).then_some(Hover { contents, range })
}

/// Descriptions of the connections of the arrow at `offset`.
fn arrow(ready: &Ready<'_>, offset: usize) -> Option<(String, lsp_types::Range)> {
    let view = ready.view();
    let here = |s: apex_dsl::source::Span| s.start as usize <= offset && offset <= s.end as usize;
    let links: Vec<_> = view.links.iter().filter(|l| here(l.arrow)).collect();
    let first = links.first()?;
    let pages: Vec<String> = links.iter().map(|l| apex_ide::describe_link(l)).collect();
    Some((pages.join("\n\n---\n\n"), ready.analysis.names.places.range(first.arrow)))
}
