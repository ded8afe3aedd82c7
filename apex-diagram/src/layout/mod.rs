//! Coordinates for a model. Boxes stand in layers from left to right (Sugiyama, Tagawa, Toda: Methods for visual understanding of
//! hierarchical system structures, 1981); what is nested is laid out first, and is one big box then.
//!
//! Slots and events stand at the top and the bottom of a box, but their lines go to the left and to the right: each has a row above or
//! below the box. With its rows, a box has ends of lines on two sides only.

mod cells;
mod coordinates;
mod cycles;
mod frame;
mod labels;
mod leaf;
mod order;
mod route;
pub mod simplex;
mod strokes;

pub use strokes::{Stroke, strokes};

use crate::{model::Item, text};

/// A point, in pixels to the right and down.
pub type Point = (i64, i64);

/// An item with its place.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Placed {
    /// Its upper left corner, in the item around it.
    pub at: Point,
    /// Its width and height.
    pub size: Point,
    /// What is written in it.
    pub texts: Vec<Text>,
    /// The points of its ports, from its corner, in the order of the model.
    pub ports: Vec<Point>,
    /// What is inside, from its corner, in the order of the model.
    pub items: Vec<Placed>,
    /// The lines inside, from its corner, in the order of the model.
    pub routes: Vec<Vec<Point>>,
}

/// A line of text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Text {
    /// Where it begins, ends or has its middle; its base line.
    pub at: Point,
    /// What comes first, in bold.
    pub bold: String,
    /// The rest.
    pub plain: String,
    /// Size of the font.
    pub size: i64,
    /// Which end of it is at `at`.
    pub align: Align,
}

/// How a text stands at its point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Align {
    /// It begins there.
    Begin,
    /// It has its middle there.
    Middle,
    /// It ends there.
    PortId,
}

/// Sizes of fonts: names, types, ports.
const NAME: i64 = 12;
const TYPE: i64 = 11;
const SMALL: i64 = 10;

impl Text {
    fn new(at: Point, words: &str, size: i64, align: Align) -> Self {
        Self { at, bold: String::new(), plain: words.to_owned(), size, align }
    }

    /// The room that it takes at most.
    pub fn width(&self) -> i64 {
        wide(&self.plain, self.size) + (text::bold_width(&self.bold, self.size as f64)).ceil() as i64
    }

    /// Left, top, right, bottom.
    pub fn bounds(&self) -> (i64, i64, i64, i64) {
        let left = match self.align {
            Align::Begin => self.at.0,
            Align::Middle => self.at.0 - self.width() / 2,
            Align::PortId => self.at.0 - self.width(),
        };
        (left, self.at.1 - self.size + 1, left + self.width(), self.at.1 + self.size / 4)
    }
}

fn wide(words: &str, size: i64) -> i64 {
    text::width(words, size as f64).ceil() as i64
}

/// Gives an item and all that is in it a place.
pub fn place(item: &Item) -> Placed {
    match &item.inside {
        Some(frame) => frame::place(item, frame),
        None => leaf::place(item, &leaf::Sides::of(item)),
    }
}
