//! Inlay hints with the kinds of connections, and with the ports of those that are made by name.

use super::Ready;
use apex_dsl::resolve::Link;
use lsp_types::{InlayHint, InlayHintKind, InlayHintLabel, InlayHintTooltip, MarkupContent, MarkupKind, Range};
use std::collections::{BTreeMap, BTreeSet};

/// Hints with the kind of each connection in `range`, after its arrow. Different kinds in a list are shown side by
/// side.
pub fn hints(ready: &Ready<'_>, range: Range) -> Vec<InlayHint> {
    let view = ready.view();
    let (start, end) = (ready.offset(range.start) as u32, ready.offset(range.end) as u32);
    let shown = view.links.iter().filter(|l| l.arrow.start >= start && l.arrow.end <= end);
    let mut arrows = BTreeMap::<_, Vec<_>>::new();
    shown.for_each(|link| arrows.entry(link.arrow).or_default().push(link));
    let hint = |(arrow, links): (apex_dsl::source::Span, Vec<&Link>)| {
        let pages: Vec<String> = links.iter().map(|l| apex_ide::describe_link(l)).collect();
        let value = pages.join("\n\n---\n\n");
        InlayHint {
            position: ready.analysis.names.places.range(arrow).end,
            label: InlayHintLabel::String(label(&links)),
            kind: Some(InlayHintKind::TYPE),
            text_edits: None,
            tooltip: Some(InlayHintTooltip::MarkupContent(MarkupContent { kind: MarkupKind::Markdown, value })),
            padding_left: Some(true),
            padding_right: Some(false),
            data: None,
        }
    };
    arrows.into_iter().map(hint).collect()
}

/// The kinds of the connections of an arrow, or the ports that `.*` connects.
fn label(links: &[&Link]) -> String {
    let mut words: Vec<&str> = links.iter().map(|link| word(apex_ide::flow_word(link))).collect();
    words.dedup();
    let mut ports: Vec<&str> = links.iter().filter(|link| link.by_name).map(|link| link.to.port()).collect();
    let mut seen = BTreeSet::new();
    ports.retain(|port| seen.insert(*port));
    match ports.is_empty() {
        true => words.join("/"),
        false => format!("{}: {}", words.join("/"), ports.join(", ")),
    }
}

/// Short name of a kind, because it appears at every arrow.
fn word(flow: &str) -> &str {
    match flow {
        "synchronous" => "sync",
        "asynchronous" => "event",
        other => other,
    }
}
