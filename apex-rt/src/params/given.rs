//! Values of parameters with their contents: they are read on one thread and set on another.

use super::{IntoParam, ParamRef};
use std::{string::String, vec::Vec};

/// Maximum length in bytes of a value that is set as text, or shown as text, while a program runs.
pub const MAX_VALUE: usize = 16 << 10;

/// A value as a [`ParamRef`], with its contents.
#[derive(Debug, Clone, PartialEq)]
pub enum Given {
    Bool(bool),
    Integer(i128),
    Float(f64),
    Single(f32),
    Text(String),
    List(Vec<Given>),
    Other(&'static str),
}

impl Given {
    /// Copies a value. Returns `None` if it has more than `room` bytes, of which each element of a list takes one at
    /// least; takes what it has from `room`.
    pub fn copy(value: ParamRef<'_>, room: &mut usize) -> Option<Self> {
        let size = match value {
            ParamRef::Text(text) => text.len().max(1),
            _ => 1,
        };
        *room = room.checked_sub(size)?;
        Some(match value {
            ParamRef::Bool(value) => Self::Bool(value),
            ParamRef::Integer(value) => Self::Integer(value),
            ParamRef::Float(value) => Self::Float(value),
            ParamRef::Single(value) => Self::Single(value),
            ParamRef::Text(text) => Self::Text(text.into()),
            ParamRef::Other(what) => Self::Other(what),
            ParamRef::List(list) if list.count() > *room => return None,
            ParamRef::List(list) => {
                let elements = (0..list.count()).map(|index| Self::copy(list.element(index), room));
                Self::List(elements.collect::<Option<_>>()?)
            }
        })
    }
}

impl IntoParam for Given {
    fn give(&self) -> ParamRef<'_> {
        match self {
            Self::Bool(value) => ParamRef::Bool(*value),
            Self::Integer(value) => ParamRef::Integer(*value),
            Self::Float(value) => ParamRef::Float(*value),
            Self::Single(value) => ParamRef::Single(*value),
            Self::Text(text) => ParamRef::Text(text),
            Self::List(list) => ParamRef::List(list),
            Self::Other(what) => ParamRef::Other(what),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::{string::ToString as _, vec};

    #[test]
    fn a_value_is_copied_as_far_as_there_is_room() {
        let list = vec![vec![1u8, 2], vec![3]];
        let mut room = 6;
        let copy = Given::copy(list.give(), &mut room).expect("two lists of two and one elements");
        assert_eq!((copy.give().to_string().as_str(), room), ("[[1, 2], [3]]", 0));
        assert_eq!(Given::copy(list.give(), &mut 5), None);
        assert_eq!(Given::copy("four".give(), &mut 3), None);
        assert_eq!(Given::copy([0u8; 1000].give(), &mut 999), None);
    }
}
