//! The first pass over a source file, which relieves the grammar. Reports characters without a meaning, and brackets
//! that do not match or nest too deeply. Replaces comments by blanks.

use super::characters::{self, Foreign};
use crate::{
    report::{Diagnostic, Diagnostics},
    source::{FileId, Span},
};

/// Largest size of a source file.
pub const MAX_BYTES: usize = 4 << 20;
/// Deepest nesting of brackets, type arguments and block comments.
pub const MAX_DEPTH: usize = 64;
/// Largest number of characters without a meaning that are reported individually.
const MAX_UNKNOWN: usize = 20;
/// Mark that some editors write before the first character of a file.
const BYTE_ORDER_MARK: &str = "\u{feff}";

/// A text whose comments are replaced by blanks.
pub struct Lexical {
    /// The text, with the same length as the original.
    pub text: String,
    /// Places of the comments.
    pub comments: Vec<Span>,
}

/// Scans `text`; `None` if it cannot be parsed at all.
pub fn scan(file: FileId, text: &str, diagnostics: &mut Diagnostics) -> Option<Lexical> {
    if text.len() > MAX_BYTES {
        let message = format!("this source file has {} bytes, but at most {MAX_BYTES} are read", text.len());
        diagnostics
            .push(Diagnostic::error("too-large", Span::new(file, 0, 0), message).note("split it into several files"));
        return None;
    }
    let mut scanner = Scanner {
        file,
        bytes: text.as_bytes(),
        at: if text.starts_with(BYTE_ORDER_MARK) { BYTE_ORDER_MARK.len() } else { 0 },
        open: vec![],
        angles: 0,
        unknown: 0,
        foreign: Foreign::default(),
        comments: vec![],
        long_string: None,
        failed: false,
    };
    scanner.run(text, diagnostics);
    scanner.foreign.report(diagnostics);
    let failed = scanner.failed;
    let comments = scanner.comments;
    if failed {
        return None;
    }
    let mut blanked = text.as_bytes().to_vec();
    if text.starts_with(BYTE_ORDER_MARK) {
        blanked[..BYTE_ORDER_MARK.len()].fill(b' ');
    }
    for span in &comments {
        for byte in &mut blanked[span.start as usize..span.end as usize] {
            if *byte != b'\n' {
                *byte = b' ';
            }
        }
    }
    // Only whole comments are replaced by ASCII blanks, so that the text remains valid UTF-8.
    let text = String::from_utf8(blanked).ok()?;
    Some(Lexical { text, comments })
}

struct Scanner<'a> {
    file: FileId,
    bytes: &'a [u8],
    at: usize,
    open: Vec<(u8, usize)>,
    angles: usize,
    unknown: usize,
    /// Words with letters that are not allowed in names.
    foreign: Foreign,
    comments: Vec<Span>,
    /// The first string that continues after the end of its line.
    long_string: Option<usize>,
    failed: bool,
}

impl Scanner<'_> {
    fn run(&mut self, text: &str, diagnostics: &mut Diagnostics) {
        while let Some(&byte) = self.bytes.get(self.at) {
            let start = self.at;
            match byte {
                b'/' if self.starts("//") => self.line_comment(),
                b'/' if self.starts("/*") => self.block_comment(diagnostics),
                b'"' => self.string(diagnostics),
                b'(' | b'[' | b'{' => self.opening(byte, diagnostics),
                b')' | b']' | b'}' => self.closing(byte, diagnostics),
                b'-' | b'=' if self.bytes.get(start + 1) == Some(&b'>') => self.at += 2,
                b'<' => {
                    self.angles += 1;
                    self.at += 1;
                    if self.angles > MAX_DEPTH {
                        self.too_deep(start, diagnostics);
                    }
                }
                b'>' => {
                    self.angles = self.angles.saturating_sub(1);
                    self.at += 1;
                }
                b';' => {
                    self.angles = 0;
                    self.statement_ends(text, diagnostics);
                    self.at += 1;
                }
                b' ' | b'\t' | b'\r' | b'\n' | b'0'..=b'9' | b'a'..=b'z' | b'A'..=b'Z' => self.at += 1,
                b'_' | b',' | b':' | b'.' | b'=' | b'-' | b'+' | b'*' | b'/' | b'%' | b'!' | b'&' | b'|' | b'^' => {
                    self.at += 1
                }
                _ => self.unknown(text, diagnostics),
            }
            if self.failed && self.at >= self.bytes.len() {
                return;
            }
        }
        if !self.failed && !self.open.is_empty() {
            self.never_closed(text, diagnostics);
        }
    }

    /// Reports a bracket that is open at the end. If an item begins inside an open brace, that brace is reported.
    fn never_closed(&mut self, text: &str, diagnostics: &mut Diagnostics) {
        let Some(&(bracket, at)) = self.open.last() else { return };
        let never = |bracket: u8, at: usize| {
            let span = Span::new(self.file, at, at + 1);
            Diagnostic::error("unclosed", span, format!("this `{}` is never closed", bracket as char))
        };
        let outer = self.open[0].1;
        let next = items(text).find(|item| *item > outer).filter(|_| {
            // The braces of an import are not those of an item.
            self.open[0].0 == b'{' && bracket == b'{' && !text[..outer].trim_end().ends_with("::")
        });
        let error = match next {
            Some(next) => {
                let end = code_before(text, next);
                let word = Span::new(self.file, next, next + word_length(&text[next..]));
                never(b'{', outer).also(word, "begins before it is closed").guess(
                    "close it",
                    Span::new(self.file, end, end),
                    "\n}",
                )
            }
            None if bracket == b'{' && self.open.len() == 1 && !text[..at].trim_end().ends_with("::") => {
                let end = Span::new(self.file, text.len(), text.len());
                never(bracket, at).fix("close it", end, if text.ends_with('\n') { "}\n" } else { "\n}\n" })
            }
            None => never(bracket, at),
        };
        self.fail(diagnostics, error);
    }

    /// Reports parentheses that are open at the end of a statement, which must be outside.
    fn statement_ends(&mut self, text: &str, diagnostics: &mut Diagnostics) {
        while let Some((b'(', at)) = self.open.last().copied() {
            self.open.pop();
            let span = Span::new(self.file, at, at + 1);
            // Parentheses do not contain arrows either, so that they should be closed before the first one.
            let inside = &text[at..self.at];
            let end = [inside.find("->"), inside.find("=>")].into_iter().flatten().min().unwrap_or(inside.len());
            let end = at + inside[..end].trim_end().len();
            let here = Span::new(self.file, end, end);
            let error = Diagnostic::error("unclosed", span, "this `(` is never closed");
            let inner = self.open.last().is_some_and(|(bracket, _)| *bracket == b'(');
            self.fail(diagnostics, if inner { error } else { error.fix("close it", here, ")") });
        }
    }

    fn starts(&self, with: &str) -> bool {
        self.bytes[self.at..].starts_with(with.as_bytes())
    }

    fn fail(&mut self, diagnostics: &mut Diagnostics, diagnostic: Diagnostic) {
        self.failed = true;
        diagnostics.push(diagnostic);
    }

    /// Reports an error after which nothing can be understood.
    fn give_up(&mut self, diagnostics: &mut Diagnostics, diagnostic: Diagnostic) {
        self.fail(diagnostics, diagnostic);
        self.at = self.bytes.len();
    }

    fn too_deep(&mut self, at: usize, diagnostics: &mut Diagnostics) {
        let message = format!("brackets are nested more than {MAX_DEPTH} levels deep");
        self.give_up(diagnostics, Diagnostic::error("too-deep", Span::new(self.file, at, at + 1), message));
    }

    fn line_comment(&mut self) {
        let start = self.at;
        let is_doc = (self.starts("///") && !self.starts("////")) || self.starts("//!");
        self.at = self.bytes[start..].iter().position(|&b| b == b'\n').map_or(self.bytes.len(), |n| start + n);
        if !is_doc {
            self.comments.push(Span::new(self.file, start, self.at));
        }
    }

    fn block_comment(&mut self, diagnostics: &mut Diagnostics) {
        let start = self.at;
        let mut depth = 0;
        while self.at < self.bytes.len() {
            if self.starts("/*") {
                depth += 1;
                self.at += 2;
                if depth > MAX_DEPTH {
                    return self.too_deep(start, diagnostics);
                }
            } else if self.starts("*/") {
                depth -= 1;
                self.at += 2;
                if depth == 0 {
                    return self.comments.push(Span::new(self.file, start, self.at));
                }
            } else {
                self.at += 1;
            }
        }
        let span = Span::new(self.file, start, start + 2);
        self.give_up(diagnostics, Diagnostic::error("unclosed", span, "this comment is never closed"));
    }

    fn string(&mut self, diagnostics: &mut Diagnostics) {
        let start = self.at;
        self.at += 1;
        while let Some(&byte) = self.bytes.get(self.at) {
            self.at += if byte == b'\\' { 2 } else { 1 };
            if byte == b'\n' {
                self.long_string.get_or_insert(start);
            }
            if byte == b'"' {
                return;
            }
        }
        // An unclosed string swaps the beginnings and ends of all later ones: the first long one is the culprit.
        let start = self.long_string.unwrap_or(start);
        let span = Span::new(self.file, start, start + 1);
        self.give_up(diagnostics, Diagnostic::error("unclosed", span, "this string is never closed"));
    }

    fn opening(&mut self, byte: u8, diagnostics: &mut Diagnostics) {
        self.open.push((byte, self.at));
        if self.open.len() > MAX_DEPTH {
            return self.too_deep(self.at, diagnostics);
        }
        self.at += 1;
    }

    fn closing(&mut self, byte: u8, diagnostics: &mut Diagnostics) {
        let span = Span::new(self.file, self.at, self.at + 1);
        let matching = match byte {
            b')' => b'(',
            b']' => b'[',
            _ => b'{',
        };
        self.at += 1;
        match self.open.pop() {
            Some((open, _)) if open == matching => {}
            Some((open, at)) => {
                let message = format!("`{}` does not close `{}`", byte as char, open as char);
                let opened = Span::new(self.file, at, at + 1);
                self.give_up(diagnostics, Diagnostic::error("unclosed", span, message).also(opened, "opened here"));
            }
            None => {
                self.give_up(
                    diagnostics,
                    Diagnostic::error("unclosed", span, format!("`{}` closes nothing", byte as char)).guess(
                        "remove it",
                        span,
                        "",
                    ),
                );
            }
        }
    }

    fn unknown(&mut self, text: &str, diagnostics: &mut Diagnostics) {
        let Some(char) = text[self.at..].chars().next() else { return };
        if let Some(word) = characters::foreign_word(text, self.at) {
            self.at = word.end;
            self.failed = true;
            return self.foreign.add(&text[word.clone()], Span::new(self.file, word.start, word.end));
        }
        let span = Span::new(self.file, self.at, self.at + char.len_utf8());
        self.at = span.end as usize;
        self.unknown += 1;
        let diagnostic = characters::unknown(char, span);
        if self.unknown >= MAX_UNKNOWN {
            self.give_up(diagnostics, diagnostic.note("more follow: is this an `.afg` file?"));
        } else {
            self.fail(diagnostics, diagnostic);
        }
    }
}

/// Offsets of the lines that begin with the keyword of an item.
fn items(text: &str) -> impl Iterator<Item = usize> {
    let words = ["use ", "graph ", "robot ", "fsm ", "test "];
    let starts = std::iter::once(0).chain(text.match_indices('\n').map(|(at, _)| at + 1));
    starts.filter(move |at| words.iter().any(|word| text[*at..].starts_with(word)))
}

/// The end of the code before an item. The documentation directly above belongs to the item.
fn code_before(text: &str, item: usize) -> usize {
    let mut end = text[..item].trim_end().len();
    loop {
        let line = text[..end].rfind('\n').map_or(0, |n| n + 1);
        if !text[line..end].starts_with("//") {
            return end;
        }
        end = text[..line].trim_end().len();
    }
}

fn word_length(text: &str) -> usize {
    text.find(' ').unwrap_or(text.len())
}
