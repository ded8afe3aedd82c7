//! Documentation comments of node types, shortened.

use std::fmt::Write as _;

/// First sentence of documentation, in one line. A period before a small letter or a number (`fig. 4.10`) does not end
/// it.
pub fn first_sentence(docs: &str) -> String {
    let paragraph: Vec<&str> = docs.trim().lines().map(str::trim).take_while(|line| !line.is_empty()).collect();
    let paragraph = paragraph.join(" ");
    let begins = |rest: &str| rest.chars().next().is_some_and(|c| !c.is_lowercase() && !c.is_numeric());
    let end = paragraph.match_indices(". ").find(|(at, _)| begins(&paragraph[at + 2..])).map(|(at, _)| at + 1);
    paragraph[..end.unwrap_or(paragraph.len())].to_owned()
}

/// Removes links to Rust's documentation: [`Scan`](path) becomes `Scan`.
pub fn linkless(text: &str) -> String {
    let mut rest = text;
    let mut out = String::new();
    while let Some((before, code)) = rest.split_once("[`") {
        out += before;
        let Some((code, after)) = code.split_once("`]") else {
            return out + "[`" + code;
        };
        let _ = write!(out, "`{}`", code.rsplit("::").next().unwrap_or(code));
        rest = match after.strip_prefix('(').and_then(|target| target.split_once(')')) {
            Some((_, after)) => after,
            None => after,
        };
    }
    out + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_sentence_has_no_links() {
        for (docs, expected) in [
            (
                "Sends a [`Scan`](crate::Scan) to\n[`flow::Hold`] (thesis fig. 4.10). More.\n\nMuch more.",
                "Sends a `Scan` to `Hold` (thesis fig. 4.10).",
            ),
            ("No end", "No end"),
            ("", ""),
            ("Open [`end", "Open [`end"),
        ] {
            assert_eq!(linkless(&first_sentence(docs)), expected);
        }
    }
}
