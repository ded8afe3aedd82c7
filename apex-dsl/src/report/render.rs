//! Messages as text and as JSON.

use super::{Diagnostic, Label, Severity};
use crate::source::{Sources, Span};
use annotate_snippets::{AnnotationKind, Element, Group, Level, Patch, Renderer, Snippet};

/// The message in the layout of rustc, with an excerpt of the source file. `color` adds the colors of a terminal.
pub fn render(diagnostic: &Diagnostic, sources: &Sources, color: bool) -> String {
    let level = match diagnostic.severity {
        Severity::Error => Level::ERROR,
        Severity::Warning => Level::WARNING,
    };
    let title = level.primary_title(diagnostic.message.as_str()).id(diagnostic.code);
    let mut files = vec![diagnostic.primary.span.file];
    for label in &diagnostic.secondary {
        if !files.contains(&label.span.file) {
            files.push(label.span.file);
        }
    }
    let paths: Vec<String> = files.iter().map(|f| sources.get(*f).path.display().to_string()).collect();
    let mut main = title.elements(std::iter::empty::<Element<'_>>());
    for (file, path) in files.iter().zip(&paths) {
        let source = sources.get(*file);
        // An excerpt contains everything between two places of one line, so that places far apart are left out.
        let is_far = |label: &Label| {
            let (a, b) = (
                label.span.start.min(diagnostic.primary.span.start),
                label.span.start.max(diagnostic.primary.span.start),
            );
            label.span.file == diagnostic.primary.span.file
                && (b - a) as usize > MAX_LINE
                && !source.text[a as usize..b as usize].contains('\n')
        };
        let here = |label: &Label| label.span.file == *file && !is_far(label);
        let mut snippet = Snippet::source(&*source.text).path(path.as_str()).line_start(source.origin.0 + 1);
        if here(&diagnostic.primary) {
            snippet = snippet.annotation(annotation(AnnotationKind::Primary, &diagnostic.primary));
        }
        for label in diagnostic.secondary.iter().filter(|l| here(l)) {
            snippet = snippet.annotation(annotation(AnnotationKind::Context, label));
        }
        main = main.element(snippet);
    }
    for note in &diagnostic.notes {
        main = main.element(Level::NOTE.message(note.as_str()));
    }
    let mut report = vec![main];
    let titles: Vec<(String, String)> = diagnostic
        .fixes
        .iter()
        .map(|fix| (fix.title.clone(), sources.get(fix.span.file).path.display().to_string()))
        .collect();
    for (fix, (title, path)) in diagnostic.fixes.iter().zip(&titles) {
        let source = sources.get(fix.span.file);
        if line_length(&source.text, fix.span) > MAX_LINE {
            report.push(Group::with_title(Level::HELP.secondary_title(title.as_str())));
            continue;
        }
        let patch = Patch::new(range(fix.span), fix.replacement.as_str());
        let snippet = Snippet::source(&*source.text).path(path.as_str()).line_start(source.origin.0 + 1).patch(patch);
        report.push(Group::with_title(Level::HELP.secondary_title(title.as_str())).element(snippet));
    }
    let renderer = if color { Renderer::styled() } else { Renderer::plain() };
    renderer.render(&report)
}

/// Longest line that is shown with a fix, in bytes: a fix is displayed with its whole lines.
const MAX_LINE: usize = 500;

/// Length of the lines that contain `span`.
fn line_length(text: &str, span: Span) -> usize {
    let (start, end) = (span.start as usize, span.end as usize);
    let first = text[..start].rfind('\n').map_or(0, |n| n + 1);
    let last = text[end..].find('\n').map_or(text.len(), |n| end + n);
    last - first
}

fn annotation(kind: AnnotationKind, label: &Label) -> annotate_snippets::Annotation<'_> {
    kind.span(range(label.span)).label(label.text.as_str())
}

fn range(span: Span) -> std::ops::Range<usize> {
    span.start as usize..span.end as usize
}

/// The message as one JSON object: `file`, `line`, `column`, `end_line`, `end_column`, `severity`, `code`, `message`,
/// `label`, `labels`, `notes`, `fixes`. Lines and columns count from 1, columns in characters.
pub fn json(diagnostic: &Diagnostic, sources: &Sources) -> serde_json::Value {
    let mut object = place(diagnostic.primary.span, sources);
    object["severity"] = serde_json::json!(diagnostic.severity);
    object["code"] = diagnostic.code.into();
    object["message"] = diagnostic.message.as_str().into();
    object["label"] = diagnostic.primary.text.as_str().into();
    object["labels"] = diagnostic
        .secondary
        .iter()
        .map(|label| {
            let mut object = place(label.span, sources);
            object["message"] = label.text.as_str().into();
            object
        })
        .collect();
    object["notes"] = diagnostic.notes.iter().map(String::as_str).collect();
    object["fixes"] = diagnostic
        .fixes
        .iter()
        .map(|fix| {
            let mut object = place(fix.span, sources);
            object["title"] = fix.title.as_str().into();
            object["replacement"] = fix.replacement.as_str().into();
            object["certain"] = fix.certain.into();
            object
        })
        .collect();
    object
}

fn place(span: Span, sources: &Sources) -> serde_json::Value {
    let (line, column) = sources.line_column(span.file, span.start);
    let (end_line, end_column) = sources.line_column(span.file, span.end);
    serde_json::json!({
        "file": sources.get(span.file).path.display().to_string(),
        "line": line,
        "column": column,
        "end_line": end_line,
        "end_column": end_column,
    })
}
