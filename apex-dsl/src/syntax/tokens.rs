//! The tokens of a text, which need not be right. Everything but the grammar reads them: the pre-scan, the repair of
//! unfinished texts, the editor and the formatter.

/// A token.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Token<'t> {
    /// Kind of the token.
    pub kind: TokenKind,
    /// Text of the token.
    pub text: &'t str,
    /// Offset of the first byte.
    pub start: usize,
}

/// Kind of a token.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TokenKind {
    /// Blanks and line ends.
    Blank,
    /// A comment to the end of its line, also documentation.
    LineComment,
    /// A comment in `/* */`, which can be nested: to its end, or to that of the text if it is not closed.
    BlockComment {
        /// `true` if it is closed.
        closed: bool,
        /// Deepest nesting of comments in it.
        depth: usize,
    },
    /// A string: to its end, or to that of the text if it is not closed.
    Text {
        /// `true` if it is closed.
        closed: bool,
    },
    /// Letters, digits and `_`.
    Word,
    /// A number with its unit.
    Number,
    /// One of `( [ {`.
    Open,
    /// One of `) ] }`.
    Close,
    /// Another punctuation mark: one character, or one of `->`, `=>`, `::`, `..`, `..=`, `+-`.
    Sign,
    /// A character without a meaning.
    Unknown,
}

impl Token<'_> {
    /// Offset behind the last byte.
    pub const fn end(&self) -> usize {
        self.start + self.text.len()
    }

    /// Returns `true` for a string that ends in the line in which it begins. Others are probably unfinished.
    pub fn ends_in_line(&self) -> bool {
        self.kind == TokenKind::Text { closed: true } && !self.text.contains('\n')
    }
}

/// The token at `start`; `None` at the end of the text.
pub fn token(text: &str, start: usize) -> Option<Token<'_>> {
    let rest = text.get(start..)?;
    let first = rest.chars().next()?;
    let (kind, length) = match first {
        ' ' | '\t' | '\r' | '\n' => (TokenKind::Blank, span(rest, |c| matches!(c, ' ' | '\t' | '\r' | '\n'))),
        '/' if rest.starts_with("//") => (TokenKind::LineComment, rest.find('\n').unwrap_or(rest.len())),
        '/' if rest.starts_with("/*") => block_comment(rest),
        '"' => string(rest),
        '0'..='9' => (TokenKind::Number, number(rest)),
        'a'..='z' | 'A'..='Z' | '_' => (TokenKind::Word, span(rest, |c| c.is_ascii_alphanumeric() || c == '_')),
        '(' | '[' | '{' => (TokenKind::Open, 1),
        ')' | ']' | '}' => (TokenKind::Close, 1),
        // As in other languages, the rest of the line is probably a comment.
        '#' => (TokenKind::Unknown, rest.find('\n').unwrap_or(rest.len())),
        _ => match sign(rest) {
            Some(length) => (TokenKind::Sign, length),
            None => (TokenKind::Unknown, first.len_utf8()),
        },
    };
    Some(Token { kind, text: &rest[..length], start })
}

/// All tokens of a text.
pub fn tokens(text: &str) -> impl Iterator<Item = Token<'_>> {
    let mut at = 0;
    std::iter::from_fn(move || {
        let token = token(text, at)?;
        at = token.end();
        Some(token)
    })
}

/// Length of the punctuation mark with which a text begins.
pub fn sign(text: &str) -> Option<usize> {
    const LONG: [&str; 6] = ["..=", "->", "=>", "::", "..", "+-"];
    const SHORT: &[u8] = b"<>;,:.=-+*/%!&|^";
    let long = LONG.iter().find(|sign| text.starts_with(**sign)).map(|sign| sign.len());
    long.or_else(|| text.as_bytes().first().filter(|byte| SHORT.contains(byte)).map(|_| 1))
}

/// Offset of the unit in a number.
pub fn unit_start(number: &str) -> usize {
    span(number, |c| c.is_ascii_digit() || c == '.' || c == '_')
}

/// Length of the beginning of a text whose characters all satisfy `is_part`.
fn span(text: &str, is_part: impl Fn(char) -> bool) -> usize {
    text.find(|c: char| !is_part(c)).unwrap_or(text.len())
}

fn block_comment(text: &str) -> (TokenKind, usize) {
    let (mut open, mut depth, mut at) = (0_usize, 0, 0);
    let bytes = text.as_bytes();
    while at < bytes.len() {
        match () {
            () if bytes[at..].starts_with(b"/*") => (open, at) = (open + 1, at + 2),
            () if bytes[at..].starts_with(b"*/") => (open, at) = (open - 1, at + 2),
            () => at += 1,
        }
        depth = depth.max(open);
        if open == 0 {
            return (TokenKind::BlockComment { closed: true, depth }, at);
        }
    }
    (TokenKind::BlockComment { closed: false, depth }, text.len())
}

fn string(text: &str) -> (TokenKind, usize) {
    let mut escaped = false;
    for (at, byte) in text.bytes().enumerate().skip(1) {
        if byte == b'"' && !escaped {
            return (TokenKind::Text { closed: true }, at + 1);
        }
        escaped = byte == b'\\' && !escaped;
    }
    (TokenKind::Text { closed: false }, text.len())
}

/// Length of a number with its unit: `1.5m/s^2`, `15cm`, `0x1F`.
fn number(text: &str) -> usize {
    let bytes = text.as_bytes();
    let byte = |at: usize| bytes.get(at).copied().unwrap_or(b' ');
    let is_comment = |at: usize| text[at..].starts_with("//") || text[at..].starts_with("/*");
    let mut at = 0;
    while byte(at).is_ascii_alphanumeric()
        || matches!(byte(at), b'_' | b'^' | b'%')
        || byte(at) == b'.' && byte(at + 1).is_ascii_digit()
        || byte(at) == b'-' && byte(at - 1) == b'^'
        || matches!(byte(at), b'/' | b'*') && byte(at - 1).is_ascii_alphabetic() && !is_comment(at)
    {
        at += 1;
    }
    at
}

/// The text that a string literal stands for.
pub fn unescape(quoted: &str) -> String {
    let mut text = String::new();
    let mut chars = quoted[1..quoted.len() - 1].chars();
    while let Some(char) = chars.next() {
        match char {
            '\\' => match chars.next() {
                Some('n') => text.push('\n'),
                Some('t') => text.push('\t'),
                Some(other) => text.push(other),
                None => {}
            },
            _ => text.push(char),
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(text: &str) -> Vec<&str> {
        tokens(text).filter(|token| token.kind != TokenKind::Blank).map(|token| token.text).collect()
    }

    #[test]
    fn words_and_signs() {
        assert_eq!(
            words("a.b->c(x = 1.5m/s^-2) /* ; */"),
            ["a", ".", "b", "->", "c", "(", "x", "=", "1.5m/s^-2", ")", "/* ; */"]
        );
        assert_eq!(words("in 0..=1 // no\n;"), ["in", "0", "..=", "1", "// no", ";"]);
        assert_eq!(words("15cm/"), ["15cm/"]);
        assert_eq!(words("15cm// b\n15cm/* b */"), ["15cm", "// b", "15cm", "/* b */"]);
        assert_eq!(words("a \"b\\\"c\nd\" é"), ["a", "\"b\\\"c\nd\"", "é"]);
        assert_eq!(unit_start("1.5m/s"), 3);
    }

    #[test]
    fn what_is_not_closed_goes_on_to_the_end() {
        let last = |text| tokens(text).last().map(|token| (token.kind, token.text));
        let comment = TokenKind::BlockComment { closed: false, depth: 2 };
        assert_eq!(last("a /* /* */ \" é"), Some((comment, "/* /* */ \" é")));
        assert_eq!(last("a \"b\\\""), Some((TokenKind::Text { closed: false }, "\"b\\\"")));
        assert!(!tokens("\"a\nb\"").any(|token| token.ends_in_line()));
    }

    #[test]
    fn tokens_cover_the_text() {
        let text = "graph Ä { x -> B(\"\\\\\", 1.5m) /* c */ ~ } // d";
        assert_eq!(tokens(text).map(|token| token.text).collect::<String>(), text);
    }
}
