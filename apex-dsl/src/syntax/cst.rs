//! The concrete syntax of a source file: all its tokens and comments, under the rules of the grammar.

use super::{
    Rule,
    prescan::Lexical,
    tokens::{TokenKind, tokens},
};
use pest::iterators::Pair;
use std::ops::Range;

/// A source file without errors.
pub struct Text<'t> {
    /// The tokens in order. The last one is empty and marks the end of the file.
    pub tokens: Vec<Token<'t>>,
    /// The rule `file`.
    pub root: Node,
}

/// The part of the text that matched a rule of the grammar.
pub struct Node {
    /// The rule.
    pub rule: Rule,
    /// Its parts, in order.
    pub kids: Vec<Child>,
}

/// A part of a [`Node`].
pub enum Child {
    /// The match of another rule.
    Node(Node),
    /// A token without a rule of its own, by its index in [`Text::tokens`].
    Token(usize),
}

/// A word, a punctuation mark or a line of documentation, with the comments around it.
pub struct Token<'t> {
    /// Text of the token.
    pub text: &'t str,
    /// Comments in front of it that belong to it.
    pub before: Vec<Comment<'t>>,
    /// Comments behind it in the same line.
    pub after: Vec<Comment<'t>>,
    /// `true` if an item, a statement or a parameter begins here.
    pub begins: bool,
    /// `true` if there is an empty line between its comments and itself.
    pub blank: bool,
}

/// A comment that is not documentation.
pub struct Comment<'t> {
    /// Text of the comment.
    pub text: &'t str,
    /// `true` for a comment that extends to the end of its line.
    pub is_line: bool,
    /// `true` if there is an empty line before it.
    pub blank: bool,
    /// `true` if no token follows in the same line.
    pub ends_line: bool,
}

/// Returns `true` for an opening bracket.
pub fn opens(token: &str) -> bool {
    matches!(token, "(" | "[" | "{" | "<")
}

/// Returns `true` for a closing bracket.
pub fn closes(token: &str) -> bool {
    matches!(token, ")" | "]" | "}" | ">")
}

/// The tokens of `original`, which was parsed as `file` after its comments had been blanked.
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

/// Collects the tokens: matches without inner matches, and the punctuation between matches.
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
                kids.push(Child::Node(self.node(pair)));
            }
            self.signs(at..span.end(), &mut kids);
        }
        if let Some(begins) = self.begins.get_mut(first) {
            *begins |= begins_line(rule);
        }
        Node { rule, kids }
    }

    fn signs(&mut self, range: Range<usize>, kids: &mut Vec<Child>) {
        let between = tokens(&self.blanked[range.clone()]).filter(|token| token.kind != TokenKind::Blank);
        for token in between {
            kids.push(self.token(range.start + token.start, token.text.len()));
        }
    }

    fn token(&mut self, start: usize, length: usize) -> Child {
        self.places.push(start..start + length);
        self.begins.push(false);
        Child::Token(self.places.len() - 1)
    }
}

/// Returns `true` for rules that can match a pair of brackets without contents.
fn is_bracketed(rule: Rule) -> bool {
    matches!(rule, Rule::list | Rule::list_expr | Rule::tuple_ty | Rule::use_group)
}

fn begins_line(rule: Rule) -> bool {
    use Rule::*;
    matches!(rule, inner_doc | item | stmt | fsm_stmt | state_stmt | test_stmt | tune_stmt | param)
}

/// The text between two tokens.
struct Gap<'t> {
    original: &'t str,
    place: Range<usize>,
}

impl<'t> Gap<'t> {
    /// Attaches the comments of the gap, which are at `places`, to the token on its left or to the one on its right.
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
            // The line of a comment that is followed by another one ends with the latter.
            ends_line = is_line || self.lines_before(i + 1, places) > 0 || (i + 1 < places.len() && ends_line);
            Comment { text: text.trim_end(), is_line, blank: self.lines_before(i, places) > 1, ends_line }
        };
        let mut comments: Vec<_> = (0..places.len()).rev().map(comment).collect();
        comments.reverse();
        comments
    }

    /// Number of line ends before a comment, back to the previous comment or token. After the last comment: before the
    /// token.
    fn lines_before(&self, comment: usize, places: &[Range<usize>]) -> usize {
        let start = if comment == 0 { self.place.start } else { places[comment - 1].end };
        let end = places.get(comment).map_or(self.place.end, |place| place.start);
        self.original[start..end].matches('\n').count()
    }
}

/// Returns `true` if a comment directly behind `left` belongs to it, not to the following token.
fn stays(left: &Token<'_>, comment: &Comment<'_>, right: &Token<'_>) -> bool {
    match left.text {
        _ if comment.is_line => true,
        text if opens(text) => false,
        "," | ";" => comment.ends_line || closes(right.text),
        _ => true,
    }
}
