//! Completion.

use super::Ready;
use crate::documents::Document;
use apex_dsl::{report::Diagnostics, source::FileId, syntax};
use apex_ide::{Completion, CompletionKind};
use lsp_types::{
    CompletionItem, CompletionItemKind, CompletionTextEdit, Documentation, InsertTextFormat, MarkupContent, MarkupKind,
    Position, Range, TextEdit,
};
use std::{
    collections::{BTreeMap, BTreeSet},
    fs,
    path::PathBuf,
};

/// Completions at a position. Placeholders are used only if `snippets` is set.
pub fn completion(
    ready: &Ready<'_>,
    position: Position,
    snippets: bool,
    siblings: &apex_ide::Siblings<'_>,
) -> Vec<CompletionItem> {
    let text = &ready.analysis.text;
    let offset = ready.offset(position);
    let (start, found) = apex_ide::complete(&ready.view(), text, offset, siblings);
    let range = ready.analysis.lines().range(start, offset);
    let import = import_position(ready);
    found.into_iter().map(|c| item(c, range, import, snippets)).collect()
}

fn item(found: Completion, range: Range, import: Position, snippets: bool) -> CompletionItem {
    let snippet = found.snippet.filter(|_| snippets);
    let format = if snippet.is_some() { InsertTextFormat::SNIPPET } else { InsertTextFormat::PLAIN_TEXT };
    // Certain completions come first, those that need an import last.
    let rank = found.kind as u8 + 10 * (u8::from(!found.sure) + u8::from(found.import.is_some()));
    CompletionItem {
        sort_text: Some(format!("{rank:02}{}", found.label)),
        kind: Some(kind(found.kind)),
        detail: (!found.detail.is_empty()).then_some(found.detail),
        documentation: (!found.docs.is_empty())
            .then_some(Documentation::MarkupContent(MarkupContent { kind: MarkupKind::Markdown, value: found.docs })),
        insert_text_format: Some(format),
        text_edit: Some(CompletionTextEdit::Edit(TextEdit::new(range, snippet.unwrap_or_else(|| found.label.clone())))),
        additional_text_edits: found.import.map(|line| vec![TextEdit::new(Range::new(import, import), line)]),
        label: found.label,
        ..CompletionItem::default()
    }
}

fn kind(kind: CompletionKind) -> CompletionItemKind {
    match kind {
        CompletionKind::Name => CompletionItemKind::VARIABLE,
        CompletionKind::Port => CompletionItemKind::FIELD,
        CompletionKind::Param => CompletionItemKind::PROPERTY,
        CompletionKind::Value => CompletionItemKind::VALUE,
        CompletionKind::Unit => CompletionItemKind::UNIT,
        CompletionKind::NodeType => CompletionItemKind::CLASS,
        CompletionKind::Type => CompletionItemKind::STRUCT,
        CompletionKind::Module => CompletionItemKind::MODULE,
        CompletionKind::Keyword => CompletionItemKind::KEYWORD,
    }
}

/// Position for a new import: before the first one, or after the documentation of the source file.
fn import_position(ready: &Ready<'_>) -> Position {
    let text = &ready.analysis.text;
    let first = ready.view().texts.files[0].1.uses.iter().filter_map(|u| u.path.first()).map(|p| p.span.start).min();
    let offset = match first {
        Some(start) => text.get(..start as usize).and_then(|before| before.rfind("use")).unwrap_or(0),
        None => text.split_inclusive('\n').take_while(|line| line.starts_with("//!")).map(str::len).sum(),
    };
    ready.analysis.lines().position(offset)
}

/// `true` if a position is in the indentation of its line: a blank there does not trigger a completion.
pub fn is_indent(ready: &Ready<'_>, position: Position) -> bool {
    let before = &ready.analysis.text[..ready.offset(position)];
    before.rsplit('\n').next().is_some_and(|line| line.trim().is_empty())
}

/// Names of source files, each with the names of its graphs and state machines.
pub fn siblings(paths: &BTreeSet<PathBuf>, open: &BTreeMap<PathBuf, Document>) -> Vec<(String, Vec<String>)> {
    let of = |path: &PathBuf| {
        let text = open.get(path).map(|d| d.text.to_string()).or_else(|| fs::read_to_string(path).ok())?;
        let tree = syntax::parse(FileId(0), &text, &mut Diagnostics::default());
        let graphs = tree.graphs.into_iter().map(|g| g.name.text);
        let names = graphs.chain(tree.machines.into_iter().map(|m| m.name.text)).collect();
        Some((path.file_stem()?.to_str()?.to_owned(), names))
    };
    paths.iter().filter_map(of).collect()
}
