//! The first pass over a source file, which relieves the grammar. Reports characters without a meaning, and brackets
//! that do not match or nest too deeply. Replaces comments by blanks.

use super::{
    characters::{self, Foreign},
    tokens::{Token, TokenKind, token},
};
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
        text,
        at: if text.starts_with(BYTE_ORDER_MARK) { BYTE_ORDER_MARK.len() } else { 0 },
        open: vec![],
        angles: 0,
        unknown: 0,
        foreign: Foreign::default(),
        comments: vec![],
        long_string: None,
        failed: false,
    };
    scanner.run(diagnostics);
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
    text: &'a str,
    /// End of the last token.
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
    fn run(&mut self, diagnostics: &mut Diagnostics) {
        while let Some(token) = token(self.text, self.at) {
            self.at = token.end();
            self.token(token, diagnostics);
        }
        if !self.failed && !self.open.is_empty() {
            self.never_closed(diagnostics);
        }
    }

    fn token(&mut self, token: Token<'_>, diagnostics: &mut Diagnostics) {
        match token.kind {
            TokenKind::Blank | TokenKind::Word | TokenKind::Number => {}
            TokenKind::LineComment => self.line_comment(token),
            TokenKind::BlockComment { closed, depth } => self.block_comment(token, closed, depth, diagnostics),
            TokenKind::Text { closed } => self.string(token, closed, diagnostics),
            TokenKind::Open => self.opening(token, diagnostics),
            TokenKind::Close => self.closing(token, diagnostics),
            TokenKind::Sign => self.sign(token, diagnostics),
            TokenKind::Unknown => self.unknown(token.start, diagnostics),
        }
    }

    fn sign(&mut self, token: Token<'_>, diagnostics: &mut Diagnostics) {
        match token.text {
            "<" => {
                self.angles += 1;
                if self.angles > MAX_DEPTH {
                    self.too_deep(token.start, diagnostics);
                }
            }
            ">" => self.angles = self.angles.saturating_sub(1),
            ";" => {
                self.angles = 0;
                self.statement_ends(token.start, diagnostics);
            }
            _ => {}
        }
    }

    /// Reports a bracket that is open at the end. If an item begins inside an open brace, that brace is reported.
    fn never_closed(&mut self, diagnostics: &mut Diagnostics) {
        let (text, Some(&(bracket, at))) = (self.text, self.open.last()) else { return };
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
    fn statement_ends(&mut self, end_of_statement: usize, diagnostics: &mut Diagnostics) {
        while let Some((b'(', at)) = self.open.last().copied() {
            self.open.pop();
            let span = Span::new(self.file, at, at + 1);
            // Parentheses do not contain arrows either, so that they should be closed before the first one.
            let inside = &self.text[at..end_of_statement];
            let end = [inside.find("->"), inside.find("=>")].into_iter().flatten().min().unwrap_or(inside.len());
            let end = at + inside[..end].trim_end().len();
            let here = Span::new(self.file, end, end);
            let error = Diagnostic::error("unclosed", span, "this `(` is never closed");
            let inner = self.open.last().is_some_and(|(bracket, _)| *bracket == b'(');
            self.fail(diagnostics, if inner { error } else { error.fix("close it", here, ")") });
        }
    }

    fn fail(&mut self, diagnostics: &mut Diagnostics, diagnostic: Diagnostic) {
        self.failed = true;
        diagnostics.push(diagnostic);
    }

    /// Reports an error after which nothing can be understood.
    fn give_up(&mut self, diagnostics: &mut Diagnostics, diagnostic: Diagnostic) {
        self.fail(diagnostics, diagnostic);
        self.at = self.text.len();
    }

    fn too_deep(&mut self, at: usize, diagnostics: &mut Diagnostics) {
        let message = format!("brackets are nested more than {MAX_DEPTH} levels deep");
        self.give_up(diagnostics, Diagnostic::error("too-deep", Span::new(self.file, at, at + 1), message));
    }

    fn line_comment(&mut self, token: Token<'_>) {
        let is_doc =
            (token.text.starts_with("///") && !token.text.starts_with("////")) || token.text.starts_with("//!");
        if !is_doc {
            self.comments.push(Span::new(self.file, token.start, token.end()));
        }
    }

    fn block_comment(&mut self, token: Token<'_>, closed: bool, depth: usize, diagnostics: &mut Diagnostics) {
        if depth > MAX_DEPTH {
            return self.too_deep(token.start, diagnostics);
        }
        if closed {
            return self.comments.push(Span::new(self.file, token.start, token.end()));
        }
        let span = Span::new(self.file, token.start, token.start + 2);
        self.give_up(diagnostics, Diagnostic::error("unclosed", span, "this comment is never closed"));
    }

    fn string(&mut self, token: Token<'_>, closed: bool, diagnostics: &mut Diagnostics) {
        if token.text.contains('\n') {
            self.long_string.get_or_insert(token.start);
        }
        if closed {
            return;
        }
        // An unclosed string swaps the beginnings and ends of all later ones: the first long one is the culprit.
        let start = self.long_string.unwrap_or(token.start);
        let span = Span::new(self.file, start, start + 1);
        self.give_up(diagnostics, Diagnostic::error("unclosed", span, "this string is never closed"));
    }

    fn opening(&mut self, token: Token<'_>, diagnostics: &mut Diagnostics) {
        self.open.push((token.text.as_bytes()[0], token.start));
        if self.open.len() > MAX_DEPTH {
            self.too_deep(token.start, diagnostics);
        }
    }

    fn closing(&mut self, token: Token<'_>, diagnostics: &mut Diagnostics) {
        let (byte, span) = (token.text.as_bytes()[0], Span::new(self.file, token.start, token.end()));
        let matching = match byte {
            b')' => b'(',
            b']' => b'[',
            _ => b'{',
        };
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

    fn unknown(&mut self, start: usize, diagnostics: &mut Diagnostics) {
        if let Some(word) = characters::foreign_word(self.text, start) {
            self.at = word.end;
            self.failed = true;
            return self.foreign.add(&self.text[word.clone()], Span::new(self.file, word.start, word.end));
        }
        let Some(char) = self.text[start..].chars().next() else { return };
        self.unknown += 1;
        let diagnostic = characters::unknown(char, Span::new(self.file, start, start + char.len_utf8()));
        if self.unknown >= MAX_UNKNOWN {
            self.give_up(diagnostics, diagnostic.note("more follow: is this an `.afg` file?"));
        } else {
            self.fail(diagnostics, diagnostic);
        }
    }
}

/// Offsets of the lines that begin with the keyword of an item.
fn items(text: &str) -> impl Iterator<Item = usize> {
    let words = ["use ", "graph ", "robot ", "fsm ", "test ", "tune "];
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
