//! Properties that the formatter has for every source file.

use apex_dsl::{
    report::Diagnostics,
    source::{FileId, Span},
    syntax::{parse, tree::File},
};
use apex_ide::format;

/// Formats a source file and checks the result. Returns `None` if it has errors.
pub fn check(name: &str, text: &str) -> Option<String> {
    let (before, has_errors) = read(text);
    let formatted = match format(text) {
        Ok(formatted) => formatted,
        Err(diagnostics) => {
            let said: Vec<_> = diagnostics.sorted().into_iter().map(|d| d.message.clone()).collect();
            assert!(has_errors, "{name} has no errors, but is not formatted: {said:?}\n{text}");
            return None;
        }
    };
    assert!(!has_errors, "{name} has errors, but is formatted");
    let (after, _) = read(&formatted);
    assert_eq!(
        comments(text, &before),
        comments(&formatted, &after),
        "comments of {name}:\n{text}\nbecame\n{formatted}"
    );
    assert_eq!(shape(before), shape(after), "{name}:\n{text}\nbecame\n{formatted}");
    let again = format(&formatted).unwrap_or_default();
    assert_eq!(again, formatted, "{name} is formatted differently when it is formatted again:\n{text}");
    Some(formatted)
}

fn read(text: &str) -> (File, bool) {
    let mut diagnostics = Diagnostics::default();
    let file = parse(FileId(0), text, &mut diagnostics);
    (file, diagnostics.has_errors())
}

/// Comments with unified line ends.
fn comments(text: &str, file: &File) -> Vec<String> {
    let comment = |span: &Span| text[span.start as usize..span.end as usize].trim_end().replace("\r\n", "\n");
    file.comments.iter().map(comment).collect()
}

/// Syntax tree without positions.
fn shape(mut file: File) -> String {
    file.comments.clear();
    file.imports_at = None;
    let written = format!("{file:?}");
    let mut parts = written.split("Span { file: FileId(0), start: ");
    let first = parts.next().unwrap_or_default().to_owned();
    parts.fold(first, |shape, part| shape + part.split_once('}').map_or("", |(_, rest)| rest))
}

/// Removes comments, and the lines that contain nothing else.
pub fn without_comments(text: &str) -> String {
    let mut bare = text.replace("\r\n", "\n");
    for Span { start, end, .. } in read(&bare).0.comments.into_iter().rev() {
        let (start, end) = (start as usize, end as usize);
        let before = bare[..start].trim_end_matches([' ', '\t']);
        let is_whole_line = before.is_empty() || before.ends_with('\n');
        let ends_line = bare[end..].starts_with('\n');
        let end = if is_whole_line && ends_line { end + 1 } else { end };
        bare.replace_range(start..end, if end > start && !ends_line { " " } else { "" });
    }
    bare
}
