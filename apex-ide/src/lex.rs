//! The tokens of a text before a place. Unfinished text has no syntax tree, but it has tokens.

use apex_dsl::syntax::tokens::{Token, TokenKind, token};

/// The tokens before `end`, without blanks and comments; `None` if `end` is inside a comment or a string.
pub fn tokens_before(text: &str, end: usize) -> Option<Vec<Token<'_>>> {
    let text = text.get(..end)?;
    let (mut tokens, mut at) = (vec![], 0);
    while let Some(token) = token(text, at) {
        at = token.end();
        match token.kind {
            TokenKind::Blank => {}
            TokenKind::LineComment if at == end => return None,
            TokenKind::BlockComment { closed: false, .. } => return None,
            TokenKind::LineComment | TokenKind::BlockComment { .. } => {}
            TokenKind::Text { .. } if !token.ends_in_line() => {
                // A string that does not end in its line is unfinished: only its quote counts.
                if !token.text.contains('\n') {
                    return None;
                }
                at = token.start + 1;
                tokens.push(Token { kind: TokenKind::Sign, text: &text[token.start..at], ..token });
            }
            _ => tokens.push(token),
        }
    }
    Some(tokens)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(text: &str) -> Option<Vec<&str>> {
        tokens_before(text, text.len()).map(|tokens| tokens.iter().map(|t| t.text).collect())
    }

    #[test]
    fn nothing_is_known_in_comments_and_strings() {
        assert_eq!(words("a /* ; */ \"b\" // c\nd"), Some(vec!["a", "\"b\"", "d"]));
        assert_eq!(words("a // b"), None);
        assert_eq!(words("a /* /* */"), None);
        assert_eq!(words("a \"b"), None);
        assert_eq!(words("a \"b\nc"), Some(vec!["a", "\"", "b", "c"]));
    }
}
