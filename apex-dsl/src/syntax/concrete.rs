//! A text as it stands: every token and every comment of it, under the rules of the grammar.

use super::{Rule, lexical::Lexical};
use pest::iterators::Pair;
use std::ops::Range;

/// A text without errors.
pub struct Text<'t> {
    /// The tokens in order. The last is empty: what stands before it ends the text.
    pub tokens: Vec<Token<'t>>,
    /// The rule `file`.
    pub root: Node,
}

/// What a rule of the grammar matched.
pub struct Node {
    /// The rule.
    pub rule: Rule,
    /// What it consists of, in order.
    pub kids: Vec<Kid>,
}

/// A part of a [`Node`].
pub enum Kid {
    /// What another rule matched.
    Node(Node),
    /// A sign without a rule of its own, by its place in [`Text::tokens`].
    Token(usize),
}

/// A word, a sign or a line of documentation, with the comments around it.
pub struct Token<'t> {
    /// What is written.
    pub text: &'t str,
    /// The comments that belong to it and stand before it.
    pub before: Vec<Comment<'t>>,
    /// The comments that stand behind it in its line.
    pub after: Vec<Comment<'t>>,
    /// Whether an item, a statement or a parameter begins here.
    pub begins: bool,
    /// Whether there is an empty line before it, behind its comments.
    pub blank: bool,
}

/// A comment that is not documentation.
pub struct Comment<'t> {
    /// What is written.
    pub text: &'t str,
    /// Whether it is of the kind that ends with its line.
    pub is_line: bool,
    /// Whether there is an empty line before it.
    pub blank: bool,
    /// Whether no token stands behind it in its line.
    pub ends_line: bool,
}

/// Opens something that is closed again.
pub fn opens(token: &str) -> bool {
    matches!(token, "(" | "[" | "{" | "<")
}

/// Closes what was opened.
pub fn closes(token: &str) -> bool {
    matches!(token, ")" | "]" | "}" | ">")
}

/// The tokens of `original`, which was parsed as `file` once its comments were blanked.
pub fn read<'t>(original: &'t str, lexical: &Lexical, file: Pair<'_, Rule>) -> Text<'t> {
    let mut shape = Shape { blanked: &lexical.text, places: vec![], begins: vec![] };
    let root = shape.node(file);
    let mut tokens: Vec<Token<'t>> = vec![];
    let mut comments: &[Range<usize>] =
        &lexical.comments.iter().map(|s| s.start as usize..s.end as usize).collect::<Vec<_>>();
    let mut end = 0;
    for (place, begins) in shape.places.into_iter().zip(shape.begins) {
        let mut token = Token { text: &original[place.clone()], before: vec![], after: vec![], begins, blank: false };
        let (here, rest) = comments.split_at(comments.partition_point(|comment| comment.start < place.start));
        Gap { original, place: end..place.start }.attach(here, tokens.last_mut(), &mut token);
        (comments, end) = (rest, place.end);
        tokens.push(token);
    }
    Text { tokens, root }
}

/// Finds the tokens: pairs without pairs inside, and the signs between pairs.
struct Shape<'b> {
    blanked: &'b str,
    places: Vec<Range<usize>>,
    begins: Vec<bool>,
}

impl Shape<'_> {
    fn node(&mut self, pair: Pair<'_, Rule>) -> Node {
        let (rule, span) = (pair.as_rule(), pair.as_span());
        let first = self.places.len();
        let mut inner = pair.into_inner().peekable();
        let mut kids = vec![];
        if rule == Rule::number || (inner.peek().is_none() && !is_bracketed(rule)) {
            kids.push(self.token(span.start(), span.as_str().trim_end().len()));
        } else {
            let mut at = span.start();
            for pair in inner {
                self.signs(at..pair.as_span().start(), &mut kids);
                at = pair.as_span().end();
                kids.push(Kid::Node(self.node(pair)));
            }
            self.signs(at..span.end(), &mut kids);
        }
        if let Some(begins) = self.begins.get_mut(first) {
            *begins |= begins_line(rule);
        }
        Node { rule, kids }
    }

    fn signs(&mut self, range: Range<usize>, kids: &mut Vec<Kid>) {
        let mut at = range.start;
        while at < range.end {
            let rest = &self.blanked[at..range.end];
            let length = match rest.as_bytes() {
                [b' ' | b'\t' | b'\r' | b'\n', ..] => {
                    at += 1;
                    continue;
                }
                [b'-' | b'=', b'>', ..] | [b':', b':', ..] => 2,
                _ => 1,
            };
            kids.push(self.token(at, length));
            at += length;
        }
    }

    fn token(&mut self, start: usize, length: usize) -> Kid {
        self.places.push(start..start + length);
        self.begins.push(false);
        Kid::Token(self.places.len() - 1)
    }
}

/// Rules that match two brackets with nothing between them.
fn is_bracketed(rule: Rule) -> bool {
    matches!(rule, Rule::list | Rule::list_expr | Rule::tuple_ty | Rule::use_group)
}

fn begins_line(rule: Rule) -> bool {
    use Rule::*;
    matches!(rule, inner_doc | item | stmt | fsm_stmt | state_stmt | test_stmt | param)
}

/// What stands between two tokens.
struct Gap<'t> {
    original: &'t str,
    place: Range<usize>,
}

impl<'t> Gap<'t> {
    /// Gives the comments of the gap, which stand at `places`, to the token on its left or to the one on its right.
    fn attach(&self, places: &[Range<usize>], mut left: Option<&mut Token<'t>>, right: &mut Token<'t>) {
        let mut is_behind_left = true;
        for (i, comment) in self.comments(places).into_iter().enumerate() {
            is_behind_left &=
                self.lines_before(i, places) == 0 && (i == 0 || !self.original[places[i - 1].clone()].contains('\n'));
            match left.as_deref_mut().filter(|left| is_behind_left && stays(left, &comment, right)) {
                Some(left) => left.after.push(comment),
                None => {
                    is_behind_left = false;
                    right.before.push(comment);
                }
            }
        }
        right.blank = self.lines_before(places.len(), places) > 1;
    }

    fn comments(&self, places: &[Range<usize>]) -> Vec<Comment<'t>> {
        let mut ends_line = false;
        let comment = |i: usize| {
            let text = &self.original[places[i].clone()];
            let is_line = text.starts_with("//");
            // One that another one follows in its line ends it if that one does.
            ends_line = is_line || self.lines_before(i + 1, places) > 0 || (i + 1 < places.len() && ends_line);
            Comment { text: text.trim_end(), is_line, blank: self.lines_before(i, places) > 1, ends_line }
        };
        let mut comments: Vec<_> = (0..places.len()).rev().map(comment).collect();
        comments.reverse();
        comments
    }

    /// How many lines end between a comment and what stands before it; behind the last comment, the token.
    fn lines_before(&self, comment: usize, places: &[Range<usize>]) -> usize {
        let start = if comment == 0 { self.place.start } else { places[comment - 1].end };
        let end = places.get(comment).map_or(self.place.end, |place| place.start);
        self.original[start..end].matches('\n').count()
    }
}

/// Whether a comment that stands right behind `left` is about it, and not about what follows.
fn stays(left: &Token<'_>, comment: &Comment<'_>, right: &Token<'_>) -> bool {
    match left.text {
        _ if comment.is_line => true,
        text if opens(text) => false,
        "," | ";" => comment.ends_line || closes(right.text),
        _ => true,
    }
}
