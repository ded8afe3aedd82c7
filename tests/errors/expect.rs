//! Expected diagnostics are comments under the line that they refer to:
//! ```text
//!     a -> b.x;
//! //         ^ error[unknown-port]: `b` has no port `x`
//! // | did you mean `y`? → `y`
//! ```
//! `^` marks the characters, `'` a position between two. `~` after the marks means that the span continues in the next
//! line. A span in the first two columns, which the slashes hide, is written `//<^` or `//<<^`. Lines with `|` belong
//! to the message: further places (as text, with the distance in lines), notes, and fixes.

use super::compile::Compiled;
use apex_dsl::{
    report::{Diagnostic, Severity},
    source::{FileId, Span},
};

/// Removes the expectations from `text`.
pub fn strip(text: &str) -> String {
    text.split_inclusive('\n').filter(|line| !is_expectation(line)).collect()
}

fn is_expectation(line: &str) -> bool {
    let Some(rest) = line.strip_prefix("//") else { return false };
    let rest = rest.trim_start();
    let marks = rest.trim_start_matches(['<', '^', '\'', '~']);
    rest.starts_with("| ")
        || (marks.len() < rest.len() && [" error[", " warning["].iter().any(|w| marks.starts_with(w)))
        || rest.starts_with("elsewhere ")
}

/// The compiled source file with its diagnostics as expectations.
pub fn annotate(compiled: &Compiled) -> String {
    let root = FileId(0);
    let source = compiled.sources.get(root);
    let found = compiled.diagnostics.sorted();
    let mut lines: Vec<&str> = source.text.split_inclusive('\n').collect();
    if source.text.is_empty() || source.text.ends_with('\n') {
        lines.push("");
    }
    let mut text = String::new();
    for (number, line) in lines.iter().enumerate() {
        let here: Vec<&&Diagnostic> =
            found.iter().filter(|d| place(compiled, d).is_some_and(|p| p.0 == number)).collect();
        text.push_str(line);
        if here.is_empty() {
            continue;
        }
        let end = if line.ends_with("\r\n") || source.text.contains("\r\n") { "\r\n" } else { "\n" };
        if !line.ends_with('\n') && !line.is_empty() {
            text.push_str(end);
        }
        for diagnostic in here {
            for line in describe(compiled, diagnostic, line) {
                text.push_str(&line);
                text.push_str(end);
            }
        }
    }
    for diagnostic in found.iter().filter(|d| d.primary.span.file != root) {
        let (line, column) = compiled.sources.line_column(diagnostic.primary.span.file, diagnostic.primary.span.start);
        let file = compiled.sources.get(diagnostic.primary.span.file).path.file_name().unwrap_or_default();
        text.push_str(&format!("// elsewhere {}:{line}:{column} {}\n", file.display(), headline(diagnostic)));
    }
    text
}

/// Line and column, counted from 0, of a diagnostic in the source file itself.
fn place(compiled: &Compiled, diagnostic: &Diagnostic) -> Option<(usize, usize)> {
    let span = diagnostic.primary.span;
    let (line, column) = compiled.sources.line_column(span.file, span.start);
    (span.file == FileId(0)).then_some((line - 1, column - 1))
}

fn describe(compiled: &Compiled, diagnostic: &Diagnostic, line: &str) -> Vec<String> {
    let (number, column) = place(compiled, diagnostic).unwrap_or_default();
    let mut lines = vec![format!("{}{} {}", margin(line, column), marks(compiled, diagnostic), headline(diagnostic))];
    if !diagnostic.primary.text.is_empty() {
        lines.push(format!("// | here: {}", diagnostic.primary.text));
    }
    for label in &diagnostic.secondary {
        let (other, _) = compiled.sources.line_column(label.span.file, label.span.start);
        let place = match (number + 1).abs_diff(other) {
            _ if label.span.file != diagnostic.primary.span.file => "in another text".to_owned(),
            0 => "same line".to_owned(),
            n if other > number => format!("{n} below"),
            n => format!("{n} above"),
        };
        let text = first_line(compiled.sources.text(label.span));
        lines.push(format!("// | `{text}` ({place}): {}", label.text).trim_end_matches([' ', ':']).to_owned());
    }
    lines.extend(diagnostic.notes.iter().map(|note| format!("// | {}", without_lines(note))));
    for fix in &diagnostic.fixes {
        lines.push(format!("// | {} → `{}`", fix.title, fix.replacement.trim_end().replace('\n', "\\n")));
    }
    lines
}

fn headline(diagnostic: &Diagnostic) -> String {
    let level = match diagnostic.severity {
        Severity::Error => "error",
        Severity::Warning => "warning",
    };
    format!("{level}[{}]: {}", diagnostic.code, diagnostic.message)
}

/// Indentation of the marks, so that they are under the marked text. Tabs stay tabs.
fn margin(line: &str, column: usize) -> String {
    if column < 2 {
        return format!("//{}", "<".repeat(column + 1));
    }
    // A tab is wider than the slashes, so it is kept after them.
    let blanks = line.chars().take(column).map(|c| if c == '\t' { '\t' } else { ' ' });
    let skipped = if line.starts_with('\t') { 0 } else { 2 };
    format!("//{}", blanks.skip(skipped).collect::<String>())
}

fn marks(compiled: &Compiled, diagnostic: &Diagnostic) -> String {
    let text = compiled.sources.text(diagnostic.primary.span);
    let first = first_line(text);
    match (text.is_empty(), first.len() < text.len()) {
        (true, _) => "'".to_owned(),
        (_, false) => "^".repeat(first.chars().count()),
        (_, true) => "^".repeat(first.chars().count()) + "~",
    }
}

fn first_line(text: &str) -> &str {
    text.lines().next().unwrap_or_default()
}

/// Removes the line numbers of nodes, which change whenever a node is added.
pub fn without_lines(note: &str) -> String {
    let mut parts = note.split(".rs:");
    let mut text = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        text.push_str(".rs:…");
        text.push_str(part.trim_start_matches(|c: char| c.is_ascii_digit()));
    }
    text
}

/// The source file after a fix.
pub fn apply(text: &str, span: Span, replacement: &str) -> String {
    format!("{}{replacement}{}", &text[..span.start as usize], &text[span.end as usize..])
}
