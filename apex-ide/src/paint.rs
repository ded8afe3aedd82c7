//! Colours of a source file, for editors that have no grammar of their own.

use apex_dsl::syntax::{
    keywords::{KEYWORDS, KeywordPosition, RESERVED},
    tokens::{Token, TokenKind, tokens},
};

/// Kind of a piece of text.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Paint {
    /// Blanks, punctuation marks, and names of nodes and ports.
    Plain,
    /// A comment.
    Comment,
    /// Documentation.
    Docs,
    /// A keyword.
    Keyword,
    /// A name with a capital letter: of a graph, a node type, or a type.
    Type,
    /// A string.
    Text,
    /// A number with its unit.
    Number,
    /// The arrow of a connection.
    Arrow,
}

/// The pieces of a source file, which together are the whole text. The text need not be right.
pub fn paint(text: &str) -> Vec<(&str, Paint)> {
    let all: Vec<Token<'_>> = tokens(text).collect();
    let meaningful =
        |t: &&Token<'_>| !matches!(t.kind, TokenKind::Blank | TokenKind::LineComment | TokenKind::BlockComment { .. });
    let mut before = "";
    let mut pieces = vec![];
    for (at, token) in all.iter().enumerate() {
        let after = || all[at + 1..].iter().find(meaningful).map_or("", |t| t.text);
        let paint = match token.kind {
            TokenKind::LineComment if token.text.starts_with("///") || token.text.starts_with("//!") => Paint::Docs,
            TokenKind::LineComment | TokenKind::BlockComment { .. } => Paint::Comment,
            TokenKind::Text { .. } => Paint::Text,
            TokenKind::Number => Paint::Number,
            TokenKind::Sign if matches!(token.text, "->" | "=>") => Paint::Arrow,
            TokenKind::Word if is_keyword(token.text, before, after()) => Paint::Keyword,
            TokenKind::Word if token.text.starts_with(|c: char| c.is_ascii_uppercase()) => Paint::Type,
            _ => Paint::Plain,
        };
        if meaningful(&token) {
            before = token.text;
        }
        pieces.push((token.text, paint));
    }
    pieces
}

/// `true` for a keyword between two tokens. Most keywords can be names, too.
fn is_keyword(word: &str, before: &str, after: &str) -> bool {
    if RESERVED.contains(&word) {
        return true;
    }
    let begins = matches!(before, "" | ";" | "{" | "}" | "pub");
    let is_name = matches!(before, "." | "::" | "node") || matches!(after, "." | "::" | "->" | "=>" | "=" | ":");
    KEYWORDS.iter().filter(|keyword| keyword.text == word).any(|keyword| match keyword.position {
        KeywordPosition::Item | KeywordPosition::Graph | KeywordPosition::Machine => begins,
        KeywordPosition::Test | KeywordPosition::Tune => begins,
        // A modifier follows a node, a name follows an arrow.
        KeywordPosition::Modifier => !is_name && !begins && !matches!(before, "->" | "=>"),
        KeywordPosition::Inside | KeywordPosition::Claim => !is_name && !begins,
        KeywordPosition::Value => true,
        // A node that every graph has.
        KeywordPosition::Node => false,
    }) && !(is_name && begins)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(text: &str, wanted: Paint) -> Vec<&str> {
        paint(text).into_iter().filter(|(_, paint)| *paint == wanted).map(|(text, _)| text).collect()
    }

    const TEXT: &str = "/// Drives.\ngraph Go { // é\n  in a: i64;\n  node on = Wheel(x = 1.5m, s = \"b\") every 5ms timeout 2s;\n  on -> state.timeout; start => on; }\nfsm F { state go { on stop => go; } }";

    #[test]
    fn every_kind_has_its_colour() {
        assert_eq!(of(TEXT, Paint::Docs), ["/// Drives."]);
        assert_eq!(of(TEXT, Paint::Comment), ["// é"]);
        assert_eq!(of(TEXT, Paint::Type), ["Go", "Wheel", "F"]);
        assert_eq!(of(TEXT, Paint::Number), ["1.5m", "5ms", "2s"]);
        assert_eq!(of(TEXT, Paint::Text), ["\"b\""]);
        assert_eq!(of(TEXT, Paint::Arrow), ["->", "=>", "=>"]);
        let keywords = ["graph", "in", "node", "every", "timeout", "fsm", "state", "on"];
        assert_eq!(of(TEXT, Paint::Keyword), keywords);
    }

    #[test]
    fn pieces_are_the_whole_text() {
        for text in [TEXT, "", "graph \"", "/* /*", "é~ -> 1.."] {
            assert_eq!(paint(text).into_iter().map(|(text, _)| text).collect::<String>(), text);
        }
    }
}
