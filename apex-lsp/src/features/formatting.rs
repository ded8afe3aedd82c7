//! Formatting.

use super::Ready;
use apex_ide::format;
use lsp_types::TextEdit;

/// Edits that format the source file; none while it has errors.
pub fn formatting(ready: &Ready<'_>) -> Vec<TextEdit> {
    let text = &ready.analysis.text;
    let Ok(formatted) = format(text) else { return vec![] };
    // Only the part that differs is replaced, so that the cursor keeps its place elsewhere.
    let same = |(a, b): &((usize, char), char)| a.1 == *b;
    let before: usize = text.char_indices().zip(formatted.chars()).take_while(same).map(|(a, _)| a.1.len_utf8()).sum();
    let (old, new) = (&text[before..], &formatted[before..]);
    let backwards = old.chars().rev().zip(new.chars().rev());
    let after: usize = backwards.take_while(|(a, b)| a == b).map(|(a, _)| a.len_utf8()).sum();
    if old.is_empty() && new.is_empty() {
        return vec![];
    }
    let range = ready.analysis.lines().range(before, text.len() - after);
    vec![TextEdit::new(range, new[..new.len() - after].to_owned())]
}
