//! Parts of a shape, as text.

use std::fmt::Write as _;

/// Text of a part that serde does not show: a type that refuses all values which were tried.
const UNKNOWN: &str = "…";
/// Number of spaces before a line, for each level.
const INDENT: usize = 2;

/// A part of a type.
#[derive(Debug, Default)]
pub struct Slot {
    pub shape: Shape,
    /// `true` if all of it is known.
    pub known: bool,
    /// `true` if no value of it could be made.
    pub refused: bool,
    /// Number of attempts in vain.
    pub failures: u8,
}

/// Shape of a part of a type.
#[derive(Debug, Default)]
pub enum Shape {
    #[default]
    Unknown,
    /// Number, text, or a type that contains itself.
    Leaf(&'static str),
    /// Value or nothing.
    Option(Box<Slot>),
    /// List of any length.
    List(Box<Slot>),
    /// Keys and values.
    Map(Box<[Slot; 2]>),
    /// Values one after the other: a struct, a tuple, or an array, whose elements have the same slot.
    Values { name: &'static str, fields: &'static [&'static str], slots: Vec<Slot>, count: usize },
    /// One of several variants. `works` is one of which a value could be made.
    Enum { name: &'static str, variants: &'static [&'static str], slots: Vec<Slot>, works: Option<usize> },
}

impl Slot {
    /// Returns `true` if there is nothing more to be learned about it.
    pub fn is_closed(&self) -> bool {
        self.known || self.refused
    }

    /// The type in one line.
    pub fn head(&self) -> String {
        match &self.shape {
            Shape::Unknown => UNKNOWN.to_owned(),
            Shape::Leaf(name) => (*name).to_owned(),
            Shape::Option(inner) => format!("option of {}", inner.head()),
            Shape::List(inner) => format!("list of {}", inner.head()),
            Shape::Map(_) => "map".to_owned(),
            Shape::Enum { name, .. } => format!("enum {name}"),
            Shape::Values { name, slots, count, .. } => match self.only() {
                Some(inner) if name.is_empty() => format!("{count} of {}", inner.head()),
                Some(inner) => format!("{name} of {}", inner.head()),
                None if name.is_empty() && slots.is_empty() => "()".to_owned(),
                None if name.is_empty() => "tuple".to_owned(),
                None => format!("struct {name}"),
            },
        }
    }

    /// The part that stands for all others: that of a struct with one value, or of an array.
    fn only(&self) -> Option<&Self> {
        let Shape::Values { name, fields, slots, .. } = &self.shape else { return None };
        let first = slots.first().filter(|_| fields.is_empty())?;
        let text = |slot: &Self| {
            let mut text = slot.head();
            slot.lines(0, &mut text);
            text
        };
        let is_only = slots.len() == 1 || name.is_empty() && slots.iter().all(|slot| text(slot) == text(first));
        is_only.then_some(first)
    }

    /// Appends a line for each part.
    pub fn lines(&self, level: usize, text: &mut String) {
        match &self.shape {
            Shape::Unknown | Shape::Leaf(_) => {}
            Shape::Option(inner) | Shape::List(inner) => inner.lines(level, text),
            Shape::Map(slots) => {
                for (name, slot) in ["key", "value"].iter().zip(slots.iter()) {
                    slot.line(name, level, text);
                }
            }
            Shape::Values { fields, slots, .. } => match self.only() {
                Some(inner) => inner.lines(level, text),
                None => {
                    for (number, slot) in slots.iter().enumerate() {
                        let name = fields.get(number).map_or_else(|| number.to_string(), |name| (*name).to_owned());
                        slot.line(&name, level, text);
                    }
                }
            },
            Shape::Enum { variants, slots, .. } => {
                for (name, slot) in variants.iter().zip(slots) {
                    slot.line(name, level, text);
                }
            }
        }
    }

    fn line(&self, name: &str, level: usize, text: &mut String) {
        let _ = writeln!(text, "{:indent$}{name}: {}", "", self.head(), indent = level * INDENT);
        self.lines(level + 1, text);
    }
}
