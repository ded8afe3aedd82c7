//! What is to be written, with the places where a line may end.

use crate::syntax::concrete::Comment;
use std::borrow::Cow;

/// A piece of text whose lines are still to be found.
#[derive(Clone)]
pub enum Doc<'t> {
    /// Written as it is.
    Text(Cow<'t, str>),
    /// A blank between two words; nothing at the start of a line.
    Space,
    /// A blank; the end of a line if the group around it is broken.
    Line,
    /// Nothing; the end of a line if the group around it is broken.
    SoftLine,
    /// What follows begins a line.
    Fresh,
    /// What follows begins a line with an empty one before it; nothing in a group that is not broken.
    Blank,
    /// Only written if the group around it is broken.
    Broken(Cow<'t, str>),
    /// A comment. One that ends with its line is written at the end of the line that it stands in.
    Comment {
        /// What is written.
        text: &'t str,
        /// Whether it ends with its line.
        is_line: bool,
    },
    /// One behind the other.
    Concat(Vec<Doc<'t>>),
    /// Lines that begin inside are indented.
    Indent(Box<Doc<'t>>),
    /// In one line if it fits, else broken at all its lines.
    Group(Box<Doc<'t>>),
    /// With a [`Doc::Line`] between each two, of which only those are broken that must be.
    Fill(Vec<Doc<'t>>),
}

impl<'t> Doc<'t> {
    /// Nothing.
    pub const NIL: Self = Self::Text(Cow::Borrowed(""));

    /// `text` as it is.
    pub fn text(text: impl Into<Cow<'t, str>>) -> Self {
        Self::Text(text.into())
    }

    /// A comment.
    pub fn comment(comment: &Comment<'t>) -> Self {
        Self::Comment { text: comment.text, is_line: comment.is_line }
    }

    /// So many blanks.
    pub fn pad(count: usize) -> Self {
        Self::text(" ".repeat(count))
    }

    /// With lines that begin inside indented.
    pub fn indent(parts: Vec<Self>) -> Self {
        Self::Indent(Box::new(Self::Concat(parts)))
    }

    /// In one line if it fits.
    pub fn group(parts: Vec<Self>) -> Self {
        Self::Group(Box::new(Self::Concat(parts)))
    }

    /// The text in one line, however long that is; nothing if a comment or documentation stands in it.
    pub fn flat(&self) -> Option<String> {
        let mut text = String::new();
        self.write_flat(&mut text).then_some(text).filter(|t| !t.contains('\n'))
    }

    fn write_flat(&self, text: &mut String) -> bool {
        match self {
            Self::Text(part) => text.push_str(part),
            Self::Space | Self::Line => text.push(' '),
            Self::SoftLine | Self::Blank | Self::Broken(_) => {}
            Self::Fresh | Self::Comment { .. } => return false,
            Self::Concat(parts) => return parts.iter().all(|part| part.write_flat(text)),
            Self::Indent(inner) | Self::Group(inner) => return inner.write_flat(text),
            Self::Fill(items) => {
                return items.iter().enumerate().all(|(i, item)| {
                    text.push_str(if i > 0 { " " } else { "" });
                    item.write_flat(text)
                });
            }
        }
        true
    }
}

/// How many columns `text` takes.
pub fn width(text: &str) -> usize {
    text.chars().count()
}
