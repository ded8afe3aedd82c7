//! Common mistakes in statements: explains them better than "expected …" does, and suggests a fix.

use super::keywords;
use crate::{
    report::{Diagnostic, nearest},
    source::{FileId, Span},
    units,
};

/// The place in a statement where the grammar does not match.
pub struct CommonMistake<'a> {
    /// The file.
    pub file: FileId,
    /// Offset of the statement in the file.
    pub start: usize,
    /// The statement.
    pub text: &'a str,
    /// Offset of the place in the statement.
    pub at: usize,
    /// Names of the tokens that the grammar expects there.
    pub expected: &'a [&'static str],
}

/// Words with which statements of programming languages begin, and what a graph has instead.
const ELSEWHERE: [(&[&str], &str); 4] = [
    (
        &["if", "else", "match", "when", "unless"],
        "a node decides: `gate` passes tokens while a condition holds, `switch` and `either` send them one way or the other",
    ),
    (
        &["for", "while", "loop", "repeat"],
        "tokens circulate over a connection with `delay`; `each` runs a node for every element of a list",
    ),
    (
        &["fn", "def", "func", "struct", "class", "impl", "enum"],
        "nodes and types are written in Rust, beside this file",
    ),
    (&["return", "print", "println", "assert"], "what happens is seen in `apex studio`, and checked by a `test`"),
];

/// Keywords that begin a statement of a graph.
const STATEMENTS: [&str; 7] = ["node", "in", "out", "slot", "event", "claim", "record"];

impl CommonMistake<'_> {
    /// The explanation of the mistake, if it is a common one.
    pub fn explained(&self) -> Option<Diagnostic> {
        let mistakes = [
            Self::number,
            Self::unit,
            Self::frame,
            Self::reserved,
            Self::reference,
            Self::slash,
            Self::declaration,
            Self::arrow,
            Self::argument,
            Self::parentheses,
            Self::elsewhere,
            Self::operator,
            Self::equals,
            Self::glob,
            Self::keyword,
            Self::modifier,
        ];
        mistakes.iter().find_map(|slip| slip(self))
    }

    fn rest(&self) -> &str {
        &self.text[self.at..]
    }

    /// The text before the place, without trailing blanks.
    fn before(&self) -> &str {
        self.text[..self.at].trim_end()
    }

    /// Returns `true` if the statement declares a port.
    fn is_port(&self) -> bool {
        matches!(word(self.text.trim_start()), "in" | "out" | "slot" | "event")
    }

    fn expects(&self, what: &str) -> bool {
        self.expected.contains(&what)
    }

    fn span(&self, from: usize, to: usize) -> Span {
        Span::new(self.file, self.start + from, self.start + to)
    }

    /// Span of the next `length` bytes.
    fn here(&self, length: usize) -> Span {
        self.span(self.at, self.at + length)
    }

    /// Explains `.5` and `5.`.
    fn number(&self) -> Option<Diagnostic> {
        let digit = |c: char| c.is_ascii_digit();
        let behind = self.rest().strip_prefix('.')?;
        let digits = behind.find(|c: char| !digit(c)).unwrap_or(behind.len());
        if self.expects("a value") && digits > 0 {
            let error = Diagnostic::error("syntax", self.here(1 + digits), "a number must begin with a digit");
            return Some(error.fix("add a zero", self.here(0), "0"));
        }
        let number = self.text[..self.at].rsplit(|c: char| !digit(c) && c != '_').next().unwrap_or_default();
        let whole =
            self.text[..self.at - number.len()].trim_end().ends_with(['=', '(', '[', ',', '+', '*', '<', '>', '-']);
        if number.starts_with(digit) && whole && digits == 0 && !behind.starts_with('.') {
            let error = Diagnostic::error("syntax", self.here(1), "a number must end with a digit");
            return Some(error.fix("add a zero", self.here(1).after(), "0"));
        }
        None
    }

    /// Explains `5 m`.
    fn unit(&self) -> Option<Diagnostic> {
        let before = self.before();
        let word = word(self.rest());
        let number = before.rsplit(|c: char| !c.is_ascii_alphanumeric() && c != '.').next().unwrap_or_default();
        let names_argument = self.rest()[word.len()..].trim_start().starts_with('=');
        let is_number =
            number.starts_with(|c: char| c.is_ascii_digit()) && number.ends_with(|c: char| c.is_ascii_digit());
        if word.is_empty() || !is_number || names_argument || before.len() == self.at || units::parse(word).is_err() {
            return None;
        }
        let error = Diagnostic::error("syntax", self.here(word.len()), "a unit must directly follow its number");
        Some(error.fix("remove the space", self.span(before.len(), self.at), ""))
    }

    /// Explains `in scan: Scan in;` and `in scan: Scan in base-link;`.
    fn frame(&self) -> Option<Diagnostic> {
        let is_frame = |before: &str| self.is_port() && before.contains(':') && before.trim_end().ends_with(" in");
        if self.expects("a name") && is_frame(self.before()) {
            let length = self.rest().chars().next().map_or(0, char::len_utf8);
            let error = Diagnostic::error("syntax", self.here(length), "expected the name of a frame");
            return Some(error.note("the frame of a port is written `in name: Type in base;`"));
        }
        let outside = |c: char| !c.is_ascii_alphanumeric() && c != '_';
        let start = self.before().rfind(outside).map_or(0, |at| at + 1);
        let length = self.rest().find(|c| outside(c) && !"-/.".contains(c))?;
        let written = self.text[start..self.at + length].trim();
        if !self.expects("`;`")
            || !is_frame(&self.text[..start])
            || length == 0
            || written.contains(char::is_whitespace)
        {
            return None;
        }
        let frame = self.span(start, self.at + length);
        let error = Diagnostic::error("syntax", frame, format!("the frame `{written}` must be in quotes"));
        let error = error.note("a frame without quotes has letters, digits and `_`");
        Some(error.fix("quote it", frame, format!("\"{written}\"")))
    }

    /// Explains `node in = …`.
    fn reserved(&self) -> Option<Diagnostic> {
        let word = word(self.rest());
        if !self.expects("a name") || !keywords::RESERVED.contains(&word) {
            return None;
        }
        let message = format!("`{word}` is a reserved word and cannot be a name");
        Some(Diagnostic::error("syntax", self.here(word.len()), message))
    }

    /// Explains `in pose: &Pose2`.
    fn reference(&self) -> Option<Diagnostic> {
        let behind = self.rest().strip_prefix('&')?;
        if !self.expects("a type") {
            return None;
        }
        let of_rust = behind.trim_start().strip_prefix("mut ").unwrap_or(behind).trim_start();
        let length = self.rest().len() - of_rust.len();
        let error = Diagnostic::error(
            "syntax",
            self.here(length),
            format!("a type in a source file has no `{}`", self.rest()[..length].trim_end()),
        );
        Some(error.note("remove it: tokens are values; only the Rust code of a node borrows them"))
    }

    /// Explains `in pose: geometry_msgs/Pose`.
    fn slash(&self) -> Option<Diagnostic> {
        let is_typed = self.expects("`::`") || self.expects("`<`");
        if !is_typed || !self.rest().starts_with('/') || !self.before().contains(':') {
            return None;
        }
        let is_path = |c: char| c.is_ascii_alphanumeric() || "_/".contains(c);
        let start = self.text[..self.at].rfind(|c| !is_path(c)).map_or(0, |before| before + 1);
        let end = self.rest().find(|c| !is_path(c)).map_or(self.text.len(), |end| self.at + end);
        let (written, path) = (&self.text[start..end], self.span(start, end));
        let name = written.rsplit('/').next().filter(|name| !name.is_empty())?;
        let message = format!("a type is a Rust path, but `{written}` is not");
        let error = Diagnostic::error("syntax", path, message);
        let note = format!("import the Rust type and write its name: `use package::{name};`");
        Some(error.note(note).guess(format!("write `{name}`"), path, name))
    }

    /// Explains `node a Ramp()`, `in x u64`, `in x = u64`, `node a = Ramp;`.
    fn declaration(&self) -> Option<Diagnostic> {
        let first = word(self.text.trim_start());
        let named = !word(self.rest()).is_empty();
        if first == "node" && self.expects("`=`") && named {
            let error = Diagnostic::error("syntax", self.here(word(self.rest()).len()), "expected `=`");
            return Some(error.note("an instance is written `node name = Type();`").fix(
                "insert `=`",
                self.here(0),
                "= ",
            ));
        }
        if !self.is_port() || !self.expects("`:`") {
            return None;
        }
        const HOW: &str = "a port is written `in name: Type;`";
        if self.rest().starts_with('=') {
            let error = Diagnostic::error("syntax", self.here(1), "the type of a port is written after `:`").note(HOW);
            let blanks = self.span(self.before().len(), self.at + 1);
            return Some(error.fix("write `:`", blanks, ":"));
        }
        let is_here = !self.text[self.before().len()..self.at].contains('\n');
        (named && is_here).then(|| {
            let error =
                Diagnostic::error("syntax", self.here(word(self.rest()).len()), "expected `:` or `;`").note(HOW);
            error.fix("write `:`", self.span(self.before().len(), self.before().len()), ":")
        })
    }

    /// Explains `a --> b`, `a > b`, `a = b`, `a <- b`, `a -> b, c`, `a = Ramp();`.
    fn arrow(&self) -> Option<Diagnostic> {
        let signs = |text: &str| text.find(|c: char| !"-=<>~".contains(c)).unwrap_or(text.len());
        let is_chain = !STATEMENTS.contains(&word(self.text.trim_start())) && !word(self.text.trim_start()).is_empty();
        if !is_chain {
            return None;
        }
        if self.before().ends_with('<') && self.rest().starts_with('-') {
            let at = self.before().len() - 1;
            let error =
                Diagnostic::error("syntax", self.span(at, self.at + 1), "a connection is written from left to right");
            return Some(error.note("write `from -> to;`"));
        }
        if !(self.expects("`->` or `=>`") || self.expects("`;`") && self.before().ends_with(')')) {
            return None;
        }
        let length = signs(self.rest());
        let sign = &self.rest()[..length];
        let target = self.rest()[length..].trim_start();
        if sign == "=" && !self.before().contains(['.', '>', '(', '[']) && makes_a_node(target) {
            let error = Diagnostic::error("syntax", self.span(0, self.before().len()), "`node` is missing");
            let error = error.note("an instance is written `node name = Type();`");
            return Some(error.guess("insert `node`", self.span(0, 0), "node "));
        }
        if self.rest().starts_with(',') && self.before().contains('>') {
            let error =
                Diagnostic::error("syntax", self.here(1), "several ends of a connection are written in brackets");
            return Some(error.note("write `a -> [b, c];`"));
        }
        let means = match sign {
            "" | "->" | "=>" => return None,
            _ if sign.contains("=>") => "=>",
            _ => "->",
        };
        let error = Diagnostic::error("syntax", self.here(length), format!("`{sign}` is not an arrow"))
            .note("`->` connects; `=>` connects and lets activity pass");
        // A sign with a head can only be an arrow, whereas the direction of `a = b` is unknown.
        let title = format!("write `{means}`");
        Some(if sign.ends_with('>') {
            error.fix(title, self.here(length), means)
        } else {
            error.guess(title, self.here(length), means)
        })
    }

    /// Explains `Mul(a: 3)`, `Mul(a = 3 b = 4)`, `Mul(a 3)`, `Mul(a = {1, 2})`.
    fn argument(&self) -> Option<Diagnostic> {
        if self.expects("a value") && self.rest().starts_with('{') {
            let error = Diagnostic::error("syntax", self.here(1), "expected a value");
            return Some(error.note("a list is written `[a, b]`"));
        }
        if !self.expects("`)`") {
            return None;
        }
        if self.rest().starts_with(':') && !self.rest().starts_with("::") {
            let error = Diagnostic::error("syntax", self.here(1), "an argument is written `name = value`");
            return Some(error.fix("write `=`", self.span(self.before().len(), self.at + 1), " ="));
        }
        if self.expects("`=`") && self.rest().starts_with(|c: char| c.is_ascii_digit() || c == '"') {
            let error = Diagnostic::error("syntax", self.here(0), "an argument is written `name = value`");
            return Some(error.fix("write `=`", self.here(0), "= "));
        }
        let name = word(self.rest());
        let behind = self.rest()[name.len()..].trim_start();
        let is_argument = !name.is_empty() && behind.starts_with('=') && !behind.starts_with("==");
        is_argument.then(|| {
            let place = self.span(self.before().len(), self.before().len());
            Diagnostic::error("syntax", place, "expected `,` between two arguments").fix("separate them", place, ",")
        })
    }

    /// Explains `node a = Ramp;`.
    fn parentheses(&self) -> Option<Diagnostic> {
        let is_node = word(self.text.trim_start()) == "node";
        if !is_node || !self.expects("`(`") || !self.rest().starts_with(';') {
            return None;
        }
        let behind = self.span(self.before().len(), self.before().len());
        let error = Diagnostic::error("syntax", behind, "expected `(`");
        Some(error.note("the arguments are written in parentheses, which may be empty").fix(
            "insert `()`",
            behind,
            "()",
        ))
    }

    /// Explains `if a { … }` and other words of programming languages.
    fn elsewhere(&self) -> Option<Diagnostic> {
        let first = word(self.text.trim_start());
        let (_, instead) = ELSEWHERE.iter().find(|(words, _)| words.contains(&first))?;
        let begins = self.text.len() - self.text.trim_start().len();
        // As the name of a node it goes on with a connection.
        if self.at <= begins || self.text[begins + first.len()..].trim_start().starts_with(['-', '=', '.', '(']) {
            return None;
        }
        let error = Diagnostic::error(
            "syntax",
            self.span(begins, begins + first.len()),
            format!("no statement begins with `{first}`"),
        );
        Some(error.note(*instead))
    }

    /// Explains `a + b -> c`.
    fn operator(&self) -> Option<Diagnostic> {
        let node = match self.rest().chars().next()? {
            '+' => "add",
            '-' if !self.rest().starts_with("->") => "sub",
            '*' => "mul",
            '/' => "div",
            _ => return None,
        };
        if !self.expects("`->` or `=>`") || !self.rest()[1..].starts_with(' ') {
            return None;
        }
        let error = Diagnostic::error("syntax", self.here(1), "a connection has no operators: nodes calculate");
        Some(error.note(format!("write `node {node} = {node}(); a -> {node}.a; b -> {node}.b;` (`apex_nodes::math`)")))
    }

    /// Explains `expect a = 3`.
    fn equals(&self) -> Option<Diagnostic> {
        let is_sign = self.rest().starts_with('=') && !self.rest().starts_with("==") && !self.rest().starts_with("=>");
        if !is_sign || !self.expects("a comparison") {
            return None;
        }
        let error = Diagnostic::error("syntax", self.here(1), "values are compared with `==`");
        Some(error.fix("write `==`", self.here(1), "=="))
    }

    /// Explains `use path::*`.
    fn glob(&self) -> Option<Diagnostic> {
        if word(self.text.trim_start()) != "use" || !self.rest().starts_with('*') {
            return None;
        }
        let error = Diagnostic::error("syntax", self.here(1), "an import names what it imports");
        Some(error.note("write `use path::{Name, …};`; `apex nodes` lists the nodes"))
    }

    /// Explains `nod a = Ramp();`.
    fn keyword(&self) -> Option<Diagnostic> {
        let first = word(self.text);
        let next = word(self.rest());
        if !self.expects("`->` or `=>`")
            || first.is_empty()
            || self.before() != first
            || next.is_empty()
            || STATEMENTS.contains(&first)
        {
            return None;
        }
        let meant = match first {
            "let" | "var" | "const" => Some("node"),
            "input" => Some("in"),
            "output" => Some("out"),
            _ => nearest(first, STATEMENTS),
        }?;
        let error =
            Diagnostic::error("syntax", self.span(0, first.len()), format!("no statement begins with `{first}`"));
        Some(error.guess(format!("did you mean `{meant}`?"), self.span(0, first.len()), meant))
    }

    /// Explains `Ramp() evry 20ms`.
    fn modifier(&self) -> Option<Diagnostic> {
        let name = word(self.rest());
        let at = self.before().as_bytes().last();
        if name.is_empty()
            || !self.expects("`;`")
            || !at.is_some_and(|b| b.is_ascii_alphanumeric() || b")]\"".contains(b))
        {
            return None;
        }
        let is_instance = word(self.text.trim_start()) == "node" || self.before().ends_with(')');
        let begins_line = self.text[self.before().len()..self.at].contains('\n');
        let meant = nearest(name, modifiers());
        if !is_instance || (begins_line && meant.is_none()) {
            return None;
        }
        if meant == Some(name) {
            let error = Diagnostic::error("syntax", self.here(name.len()), "a port has no modifiers");
            return Some(error.note("write them after an instance: `node name = Type() every 20ms;`"));
        }
        let error = Diagnostic::error("syntax", self.here(name.len()), format!("there is no modifier `{name}`"));
        Some(match meant {
            Some(meant) => error.guess(format!("did you mean `{meant}`?"), self.here(name.len()), meant),
            None => error.note(format!(
                "the modifiers of an instance are {}",
                modifiers().map(|m| format!("`{m}`")).collect::<Vec<_>>().join(", ")
            )),
        })
    }
}

/// Keywords of modifiers.
fn modifiers() -> impl Iterator<Item = &'static str> {
    keywords::words_at(keywords::KeywordPosition::Modifier).map(|word| word.text)
}

/// The word at the start of `text`; empty if there is none.
fn word(text: &str) -> &str {
    let end = text.find(|c: char| !c.is_ascii_alphanumeric() && c != '_').unwrap_or(text.len());
    if text.starts_with(|c: char| c.is_ascii_digit()) { "" } else { &text[..end] }
}

/// Returns `true` if `text` begins with `Type(…` or `path::Type<…>(…`.
fn makes_a_node(text: &str) -> bool {
    let path = text.find(|c: char| !c.is_ascii_alphanumeric() && !"_:".contains(c)).unwrap_or(text.len());
    path > 0 && text[path..].trim_start().starts_with(['(', '<'])
}
