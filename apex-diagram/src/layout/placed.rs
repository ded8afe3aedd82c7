//! Items and texts with their positions.

use crate::text;

/// A point, in pixels to the right and down.
pub type Point = (i64, i64);

/// An item with its position.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Placed {
    /// Upper left corner, relative to the enclosing item.
    pub at: Point,
    /// Width and height.
    pub size: Point,
    /// Texts.
    pub texts: Vec<Text>,
    /// Positions of the ports relative to the corner, in the order of the model.
    pub ports: Vec<Point>,
    /// Nested items, with positions relative to the corner, in the order of the model.
    pub items: Vec<Placed>,
    /// Points of the lines inside, relative to the corner, in the order of the model.
    pub routes: Vec<Vec<Point>>,
}

/// A line of text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Text {
    /// Start, middle or end of the base line.
    pub at: Point,
    /// First part, in bold.
    pub bold: String,
    /// The rest.
    pub plain: String,
    /// Font size in pixels.
    pub size: i64,
    /// Alignment at `at`.
    pub align: Align,
}

/// Alignment of a text at its point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Align {
    /// The text begins at the point.
    Begin,
    /// The middle of the text is at the point.
    Middle,
    /// The text ends at the point.
    End,
}

/// Font sizes of names, types and ports.
pub const NAME: i64 = 12;
pub const TYPE: i64 = 11;
pub const SMALL: i64 = 10;

impl Text {
    /// Returns a text that is not bold.
    pub fn new(at: Point, words: &str, size: i64, align: Align) -> Self {
        Self { at, bold: String::new(), plain: words.to_owned(), size, align }
    }

    /// Upper bound of the width.
    pub fn width(&self) -> i64 {
        wide(&self.plain, self.size) + (text::bold_width(&self.bold, self.size as f64)).ceil() as i64
    }

    /// Left, top, right and bottom.
    pub fn bounds(&self) -> (i64, i64, i64, i64) {
        let left = match self.align {
            Align::Begin => self.at.0,
            Align::Middle => self.at.0 - self.width() / 2,
            Align::End => self.at.0 - self.width(),
        };
        (left, self.at.1 - self.size + 1, left + self.width(), self.at.1 + self.size / 4)
    }
}

/// Upper bound of the width of words.
pub fn wide(words: &str, size: i64) -> i64 {
    text::width(words, size as f64).ceil() as i64
}
