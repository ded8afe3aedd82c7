//! The part of YAML that graph files need: scalars, lists and maps, with lines.

use super::wrong::Wrong;
use saphyr_parser::{Event, Parser};
use std::collections::BTreeSet;

/// Maximum depth of nested lists and maps.
const MAX_DEPTH: usize = 200;

/// A value and its line.
#[derive(Debug, PartialEq)]
pub struct Yaml {
    pub line: usize,
    pub value: Value,
}

#[derive(Debug, PartialEq)]
pub enum Value {
    Scalar(String),
    List(Vec<Yaml>),
    Map(Vec<(String, Yaml)>),
}

impl Yaml {
    /// The entry of a map.
    pub fn get(&self, key: &str) -> Option<&Self> {
        let Value::Map(entries) = &self.value else { return None };
        entries.iter().find(|(name, _)| name == key).map(|(_, value)| value)
    }

    /// The entry of a map that must exist.
    pub fn need(&self, key: &str, what: &str) -> Result<&Self, Wrong> {
        match &self.value {
            Value::Map(_) => self.get(key).ok_or_else(|| Wrong::new(self.line, format!("{what} has no `{key}`"))),
            _ => Err(Wrong::new(self.line, format!("{what} must be a map with the key `{key}`"))),
        }
    }

    /// The text of a scalar.
    pub fn scalar(&self, what: &str) -> Result<&str, Wrong> {
        match &self.value {
            Value::Scalar(text) => Ok(text),
            _ => Err(Wrong::new(self.line, format!("{what} must be a single value"))),
        }
    }

    /// The items of a list; an empty scalar is an empty list.
    pub fn list(&self, what: &str) -> Result<&[Self], Wrong> {
        match &self.value {
            Value::List(items) => Ok(items),
            Value::Scalar(text) if text.is_empty() || text == "~" => Ok(&[]),
            _ => Err(Wrong::new(self.line, format!("{what} must be a list"))),
        }
    }

    /// The entries of a map; an empty scalar is an empty map.
    pub fn map(&self, what: &str) -> Result<&[(String, Self)], Wrong> {
        match &self.value {
            Value::Map(entries) => Ok(entries),
            Value::Scalar(text) if text.is_empty() || text == "~" => Ok(&[]),
            // Some files write an empty map as an empty list.
            Value::List(items) if items.is_empty() => Ok(&[]),
            _ => Err(Wrong::new(self.line, format!("{what} must be a map"))),
        }
    }
}

/// A list or map that has not ended.
enum Open {
    List(usize, Vec<Yaml>),
    Map(usize, Entries),
}

/// Entries of a map that has not ended.
#[derive(Default)]
struct Entries {
    all: Vec<(String, Yaml)>,
    /// Keys of all entries.
    keys: BTreeSet<String>,
    /// Key whose value follows.
    key: Option<String>,
}

/// The only document of a file.
pub fn read(text: &str) -> Result<Yaml, Wrong> {
    let mut open: Vec<Open> = vec![];
    let mut whole = None;
    for event in Parser::new_from_str(text) {
        let (event, span) =
            event.map_err(|e| Wrong::new(e.marker().line().max(1), format!("this is not YAML: {}", e.info())))?;
        let line = span.start.line().max(1);
        let done = match event {
            Event::Scalar(text, ..) => Yaml { line, value: Value::Scalar(text.into_owned()) },
            Event::SequenceStart(..) | Event::MappingStart(..) if open.len() >= MAX_DEPTH => {
                return Err(Wrong::new(line, format!("this is nested more than {MAX_DEPTH} levels deep")));
            }
            Event::SequenceStart(..) => {
                open.push(Open::List(line, vec![]));
                continue;
            }
            Event::MappingStart(..) => {
                open.push(Open::Map(line, Entries::default()));
                continue;
            }
            Event::SequenceEnd | Event::MappingEnd => match open.pop() {
                Some(Open::List(line, items)) => Yaml { line, value: Value::List(items) },
                Some(Open::Map(line, entries)) => Yaml { line, value: Value::Map(entries.all) },
                None => continue,
            },
            // A graph that contains itself can only be written so.
            Event::Alias(_) => {
                return Err(Wrong::new(line, "aliases (`*name`) are not supported: write the value out"));
            }
            _ => continue,
        };
        match open.last_mut() {
            Some(open) => open.add(done)?,
            None if whole.is_some() => return Err(Wrong::new(line, "a second document begins here")),
            None => whole = Some(done),
        }
    }
    whole.ok_or_else(|| Wrong::new(1, "the file is empty"))
}

impl Open {
    fn add(&mut self, value: Yaml) -> Result<(), Wrong> {
        match self {
            Self::List(_, items) => items.push(value),
            Self::Map(_, entries) => match entries.key.take() {
                Some(name) => entries.all.push((name, value)),
                None => {
                    let name = value.scalar("a key")?;
                    if !entries.keys.insert(name.to_owned()) {
                        return Err(Wrong::new(value.line, format!("the key `{name}` occurs twice")));
                    }
                    entries.key = Some(name.to_owned());
                }
            },
        }
        Ok(())
    }
}
