//! Repair of unfinished text for editors: makes it parsable without moving the rest.

use super::{
    prescan::{self, MAX_BYTES, MAX_DEPTH},
    tokens::{Token, TokenKind, token},
};
use crate::{report::Diagnostics, source::FileId};

/// Number of readings of a text, at most. Comments and strings without an end are read again, to the end of the text.
const READINGS: usize = 16;

/// Keywords that begin an item.
const ITEMS: [&str; 7] = ["use", "pub", "graph", "robot", "fsm", "test", "tune"];

/// Parsable replacement for a `text` with wrong brackets, strings, comments or characters; `None` if there are none.
/// Wrong bytes become blanks, and open items are closed: in existing blanks, or behind the end. Every other byte of
/// `text` keeps its offset, so that places in both texts are the same.
pub fn repaired(text: &str) -> Option<String> {
    let is_fine = prescan::scan(FileId(0), text, &mut Diagnostics::default()).is_some();
    if is_fine || text.len() > MAX_BYTES {
        return None;
    }
    made_parsable(text)
}

fn made_parsable(text: &str) -> Option<String> {
    let bytes = text.as_bytes().to_vec();
    let mut repairer =
        Repairer { text, bytes, at: 0, open: vec![], angles: 0, solid: 0, again: 0, ends_in_comment: false };
    repairer.run();
    String::from_utf8(repairer.bytes).ok()
}

/// Parsable replacement for a text with a comment that begins at `comment` and never ends. The rest of the text becomes
/// blank, because no part of it is known to be code.
pub fn repaired_before(text: &str, comment: usize) -> Option<String> {
    let blank = |b: u8| if b == b'\n' { b } else { b' ' };
    let (before, behind) = text.as_bytes().split_at_checked(comment)?;
    let cut = before.iter().copied().chain(behind.iter().map(|b| blank(*b))).collect();
    made_parsable(&String::from_utf8(cut).ok()?)
}

/// Offsets at which `repaired` differs from `text`, in ascending order. If something was added behind the end, they
/// include the end, where a statement may be incomplete.
pub fn edits(text: &str, repaired: &str) -> Vec<usize> {
    let end = (repaired.len() > text.len()).then(|| text.trim_end().len());
    let differ = text.bytes().zip(repaired.bytes()).enumerate().filter(|(_, (a, b))| a != b);
    let mut places: Vec<usize> = differ.map(|(at, _)| at).filter(|at| text.is_char_boundary(*at)).chain(end).collect();
    places.sort_unstable();
    places
}

struct Repairer<'a> {
    text: &'a str,
    bytes: Vec<u8>,
    /// Offset of the next token.
    at: usize,
    /// The open brackets, with their places.
    open: Vec<(u8, usize)>,
    /// Number of open `<`.
    angles: usize,
    /// End of the last token.
    solid: usize,
    /// Number of bytes that are read again.
    again: usize,
    /// `true` if the text ends with a `//` comment without a line end.
    ends_in_comment: bool,
}

impl Repairer<'_> {
    fn run(&mut self) {
        while let Some(token) = token(self.text, self.at) {
            self.at = token.end();
            match token.kind {
                TokenKind::Blank => continue,
                TokenKind::LineComment => {
                    self.ends_in_comment = self.at == self.text.len();
                    continue;
                }
                TokenKind::BlockComment { closed: true, depth } if depth <= MAX_DEPTH => {}
                TokenKind::BlockComment { .. } => self.unfinished(token, 2),
                // Strings are short: the quote is probably a mistake.
                TokenKind::Text { .. } if !token.ends_in_line() => self.unfinished(token, 1),
                TokenKind::Text { .. } | TokenKind::Number => {}
                TokenKind::Word => self.word(token),
                TokenKind::Open => self.opening(token),
                TokenKind::Close => self.closing(token),
                TokenKind::Sign => self.sign(token),
                TokenKind::Unknown => self.blank(token.start, token.text.len()),
            }
            self.solid = self.at;
        }
        self.drop_until_brace();
        if self.ends_in_comment && self.open.iter().any(|(bracket, _)| *bracket == b'{') {
            self.bytes.push(b'\n');
        }
        while let Some((bracket, at)) = self.open.pop() {
            match bracket {
                b'{' => self.bytes.extend(self.closer(at)),
                _ => self.bytes[at] = b' ',
            }
        }
    }

    /// Replaces the `count` bytes with which a comment or a string begins by blanks, and reads it as code: without a
    /// limit, many of them would take the square of the time of one.
    fn unfinished(&mut self, token: Token<'_>, count: usize) {
        self.again += token.text.len();
        let is_limit = self.again > READINGS * self.text.len();
        self.blank(token.start, if is_limit { self.text.len() - token.start } else { count });
    }

    /// Replaces `count` bytes at `start` by blanks, and goes on behind them.
    fn blank(&mut self, start: usize, count: usize) {
        self.at = start + count;
        self.bytes[start..self.at].fill(b' ');
    }

    fn sign(&mut self, token: Token<'_>) {
        match token.text {
            "<" if self.angles >= MAX_DEPTH => self.blank(token.start, 1),
            "<" => self.angles += 1,
            ">" => self.angles = self.angles.saturating_sub(1),
            ";" => {
                self.angles = 0;
                self.drop_until_brace();
            }
            _ => {}
        }
    }

    fn opening(&mut self, token: Token<'_>) {
        if self.open.len() >= MAX_DEPTH {
            return self.blank(token.start, 1);
        }
        self.open.push((token.text.as_bytes()[0], token.start));
    }

    /// Closes the matching bracket and drops the open ones inside it. Without a match the bracket itself is dropped.
    fn closing(&mut self, token: Token<'_>) {
        let byte = token.text.as_bytes()[0];
        let partner = match byte {
            b')' => b'(',
            b']' => b'[',
            _ => b'{',
        };
        let is_partner = |(open, _): &(u8, usize)| *open == partner;
        let found = self.open.iter().rposition(is_partner);
        let Some(found) = found.filter(|f| byte == b'}' || self.open[*f..].iter().all(|(open, _)| *open != b'{'))
        else {
            return self.blank(token.start, 1);
        };
        for (_, at) in self.open.split_off(found).into_iter().skip(1) {
            self.bytes[at] = b' ';
        }
    }

    /// Drops the brackets that are open at the end of a statement.
    fn drop_until_brace(&mut self) {
        while let Some((bracket, at)) = self.open.pop() {
            if bracket == b'{' {
                return self.open.push((bracket, at));
            }
            self.bytes[at] = b' ';
        }
    }

    fn word(&mut self, token: Token<'_>) {
        let begins_line = token.start == 0 || self.text.as_bytes()[token.start - 1] == b'\n';
        let behind = self.text[token.end()..].trim_start();
        let named = behind.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_');
        if begins_line && named && ITEMS.contains(&token.text) {
            self.close_items(token.start);
        }
    }

    /// Closes the items that are open where another one begins, in the blanks before it, as far as there is room.
    fn close_items(&mut self, next: usize) {
        while let Some((bracket, at)) = self.open.pop() {
            let closer = self.closer(at);
            let room = self.bytes[self.solid..].iter().take_while(|b| b.is_ascii_whitespace()).count();
            if bracket == b'{' && self.solid + closer.len() <= next && closer.len() <= room {
                self.bytes[self.solid..self.solid + closer.len()].copy_from_slice(closer);
                self.solid += closer.len();
            } else {
                self.bytes[at] = b' ';
            }
        }
    }

    /// The text that closes the brace at `at`. The brace of an import needs a semicolon.
    fn closer(&self, at: usize) -> &'static [u8] {
        if self.text[..at].trim_end().ends_with("::") { b"};" } else { b"}" }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rest_keeps_its_place() {
        assert_eq!(repaired("graph A { }"), None);
        assert_eq!(repaired("graph A {").as_deref(), Some("graph A {}"));
        assert_eq!(repaired("use a::{b, c").as_deref(), Some("use a::{b, c};"));
        assert_eq!(repaired("graph A { x -> B(; }").as_deref(), Some("graph A { x -> B ; }"));
        assert_eq!(repaired("graph A { x -> B[(1]; ) }").as_deref(), Some("graph A { x -> B[ 1];   }"));
        assert_eq!(repaired("graph A { ü }").as_deref(), Some("graph A {    }"));
        assert_eq!(repaired("graph A {\n\nrobot B { }").as_deref(), Some("graph A {}\nrobot B { }"));
        assert_eq!(repaired("graph A { x = \"a\\\"; }\n}").as_deref(), Some("graph A { x =  a  ; }\n "));
        assert_eq!(repaired("/* graph").as_deref(), Some("   graph"));
        assert_eq!(repaired("graph A { // b").as_deref(), Some("graph A { // b\n}"));
        assert_eq!(repaired("graph A { /// b\n").as_deref(), Some("graph A { /// b\n}"));
        assert_eq!(repaired("graph A { /* { // b").as_deref(), Some("graph A {    { // b\n}}"));
        assert_eq!(repaired_before("graph A { /* ü\n{", 10).as_deref(), Some("graph A {      \n }"));
    }

    /// With a time that grows with the square of the length, this would take an hour.
    #[test]
    fn many_beginnings_without_an_end() {
        for piece in ["/*", "\n\\\"", "\"\n", "/* \" */ \"\n"] {
            let text = format!("graph A {{ \"{}", piece.repeat(MAX_BYTES / piece.len() / 2));
            let repaired = repaired(&text).expect("it has no end");
            assert!(repaired.starts_with("graph A {") && repaired.len() >= text.len());
        }
    }

    /// Every byte keeps its place or becomes blank, except for closing brackets in blanks. The result can be parsed.
    #[test]
    fn offsets_are_kept() {
        const PIECES: [&str; 31] = [
            "graph A {",
            "\ngraph B { ",
            "\nuse a::{b, ",
            "\nfsm F {",
            "{",
            "}",
            "(",
            ")",
            "[",
            "]",
            "<",
            ">",
            ";",
            "\"",
            "\\",
            "/*",
            "*/",
            "//",
            "// x",
            "/// y",
            "\n",
            "\r\n",
            " ",
            "x",
            "->",
            "1.5m",
            "ü",
            "😀",
            "\u{feff}",
            "\0",
            "::",
        ];
        let mut dice = 1_u64;
        let mut roll = |below: usize| {
            dice = dice.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (dice >> 33) as usize % below
        };
        let mut changed = 0;
        for _ in 0..20_000 {
            let text: String = (0..roll(24)).map(|_| PIECES[roll(PIECES.len())]).collect();
            let comment = text.find("/*").unwrap_or(text.len());
            for repaired in [repaired(&text), repaired_before(&text, comment)].into_iter().flatten() {
                changed += 1;
                assert!(repaired.len() >= text.len(), "{text:?}: {repaired:?}");
                for (at, c) in text.char_indices() {
                    let new = &repaired[at..at + c.len_utf8()];
                    let is_kept = new.chars().eq([c]);
                    let is_blank = new.bytes().all(|b| b == b' ');
                    let is_closer = c.is_ascii_whitespace() && matches!(new, "}" | ";");
                    assert!(is_kept || is_blank || is_closer, "{text:?}: {repaired:?}");
                }
                let read = prescan::scan(FileId(0), &repaired, &mut Diagnostics::default());
                assert!(read.is_some(), "{text:?}: {repaired:?}");
            }
        }
        assert!(changed > 10_000, "{changed}");
    }
}
