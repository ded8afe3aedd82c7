//! The tokens of a text before a place. Unfinished text has no syntax tree, but it has tokens.

/// A token.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Token<'a> {
    /// Kind of the token.
    pub kind: TokenKind,
    /// Text of the token.
    pub text: &'a str,
    /// Offset of the first byte.
    pub start: usize,
}

/// Kind of a token.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TokenKind {
    /// Letters, digits and `_`.
    Keyword,
    /// A number with its unit.
    Number,
    /// A string.
    Text,
    /// Anything else: one character, or one of `->`, `=>`, `::`, `..`, `..=`.
    Sign,
}

/// The tokens before `end`, without comments; `None` if `end` is inside a comment or a string.
pub fn tokens_before(text: &str, end: usize) -> Option<Vec<Token<'_>>> {
    let text = text.get(..end)?;
    let mut tokens = vec![];
    let mut at = 0;
    while let Some(first) = text[at..].chars().next() {
        let rest = &text[at..];
        let (kind, length) = match first {
            _ if rest.starts_with("//") => {
                at += rest.find('\n')?;
                continue;
            }
            _ if rest.starts_with("/*") => {
                at += block_comment(rest)?;
                continue;
            }
            c if c.is_whitespace() => {
                at += c.len_utf8();
                continue;
            }
            '"' => (TokenKind::Text, string(rest)?),
            '0'..='9' => (TokenKind::Number, number(rest)),
            'a'..='z' | 'A'..='Z' | '_' => (TokenKind::Keyword, word(rest)),
            _ => (TokenKind::Sign, sign(rest, first)),
        };
        tokens.push(Token { kind, text: &rest[..length], start: at });
        at += length;
    }
    Some(tokens)
}

/// Length of a comment, including nested comments.
fn block_comment(text: &str) -> Option<usize> {
    let (mut depth, mut at) = (0, 0);
    let bytes = text.as_bytes();
    while at < bytes.len() {
        match () {
            () if bytes[at..].starts_with(b"/*") => (depth, at) = (depth + 1, at + 2),
            () if bytes[at..].starts_with(b"*/") => (depth, at) = (depth - 1, at + 2),
            () => at += 1,
        }
        if depth == 0 {
            return Some(at);
        }
    }
    None
}

/// Length of a string. One that does not end in its line is unfinished and counts as a single character.
fn string(text: &str) -> Option<usize> {
    let mut escaped = false;
    for (i, c) in text.char_indices().skip(1) {
        match c {
            '"' if !escaped => return Some(i + 1),
            '\n' => return Some(1),
            _ => escaped = c == '\\' && !escaped,
        }
    }
    None
}

fn word(text: &str) -> usize {
    text.find(|c: char| !c.is_ascii_alphanumeric() && c != '_').unwrap_or(text.len())
}

/// Length of a number with its unit: `1.5m/s^2`, `15cm`, `0x1F`.
fn number(text: &str) -> usize {
    let bytes = text.as_bytes();
    let byte = |at: usize| bytes.get(at).copied().unwrap_or(b' ');
    let mut at = 0;
    while byte(at).is_ascii_alphanumeric()
        || matches!(byte(at), b'_' | b'^' | b'%')
        || byte(at) == b'.' && byte(at + 1).is_ascii_digit()
        || byte(at) == b'-' && byte(at - 1) == b'^'
        || matches!(byte(at), b'/' | b'*') && byte(at - 1).is_ascii_alphabetic()
    {
        at += 1;
    }
    at
}

fn sign(text: &str, first: char) -> usize {
    let long = ["..=", "->", "=>", "::", ".."];
    long.iter().find(|s| text.starts_with(**s)).map_or(first.len_utf8(), |s| s.len())
}

/// Offset of the unit in a number.
pub fn unit_start(number: &str) -> usize {
    let digits = |c: char| c.is_ascii_digit() || c == '.' || c == '_';
    number.find(|c: char| !digits(c)).unwrap_or(number.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(text: &str) -> Option<Vec<&str>> {
        tokens_before(text, text.len()).map(|tokens| tokens.iter().map(|t| t.text).collect())
    }

    #[test]
    fn words_and_signs() {
        assert_eq!(
            words("a.b->c(x = 1.5m/s^-2) /* ; */"),
            Some(vec!["a", ".", "b", "->", "c", "(", "x", "=", "1.5m/s^-2", ")"])
        );
        assert_eq!(words("in 0..=1 // no\n;"), Some(vec!["in", "0", "..=", "1", ";"]));
        assert_eq!(words("15cm/"), Some(vec!["15cm/"]));
        assert_eq!(words("a // b"), None);
        assert_eq!(words("a /* /* */"), None);
        assert_eq!(words("a \"b"), None);
        assert_eq!(words("a \"b\nc"), Some(vec!["a", "\"", "b", "c"]));
        assert_eq!(unit_start("1.5m/s"), 3);
    }
}
