//! Documents: formatted text with its possible line breaks.

use apex_dsl::syntax::cst::Comment;
use std::borrow::Cow;

/// A piece of text that is not yet divided into lines.
#[derive(Clone)]
pub enum Doc<'t> {
    /// Text that is written unchanged.
    Text(Cow<'t, str>),
    /// A blank between two words; nothing at the start of a line.
    Space,
    /// A blank, or a line break if the group around it is broken.
    Line,
    /// Nothing, or a line break if the group around it is broken.
    SoftLine,
    /// Begins a new line.
    Fresh,
    /// Begins a new line after an empty one; nothing in a group that is not broken.
    Blank,
    /// Text that is written only if the group around it is broken.
    Broken(Cow<'t, str>),
    /// A comment. One that extends to the end of its line is written at the end of the current line.
    Comment {
        /// The comment.
        text: &'t str,
        /// `true` if it extends to the end of its line.
        is_line: bool,
    },
    /// Several documents in sequence.
    Concat(Vec<Doc<'t>>),
    /// A document in which new lines are indented.
    Indent(Box<Doc<'t>>),
    /// A document in one line if it fits, otherwise broken at each possible line break.
    Group(Box<Doc<'t>>),
    /// Documents separated by [`Doc::Line`], of which only the necessary ones are broken.
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

    /// `count` blanks.
    pub fn pad(count: usize) -> Self {
        Self::text(" ".repeat(count))
    }

    /// A sequence in which new lines are indented.
    pub fn indent(parts: Vec<Self>) -> Self {
        Self::Indent(Box::new(Self::Concat(parts)))
    }

    /// A sequence in one line if it fits.
    pub fn group(parts: Vec<Self>) -> Self {
        Self::Group(Box::new(Self::Concat(parts)))
    }

    /// The text in one line, however long it is; `None` if it contains a comment or documentation.
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

/// Number of columns that `text` takes.
pub fn width(text: &str) -> usize {
    text.chars().count()
}
