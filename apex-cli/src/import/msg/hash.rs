//! Hash of a type (RIHS01, REP 2016): the checksum SHA-256 of its description in JSON, with those of its parts.

use super::{
    parse::{Element, Field, Many, Plain, Type},
    types::Types,
};
use sha2::{Digest as _, Sha256};
use std::fmt::Write as _;

/// Numbers of types in `type_description_interfaces/msg/FieldType`.
const MESSAGE: u32 = 1;
const TEXT: u32 = 17;
const BOUNDED_TEXT: u32 = 21;
/// Numbers that are added to them for arrays and lists.
const ARRAY: u32 = 48;
const BOUNDED_LIST: u32 = 96;
const LIST: u32 = 144;

/// Hash of a type.
pub fn of(ty: &Type, types: &Types) -> Result<String, String> {
    let mut parts = types.parts(ty)?;
    parts.sort_by(|a, b| a.name.cmp(&b.name));
    let parts: Vec<String> = parts.into_iter().map(description).collect();
    let text = format!(
        "{{\"type_description\": {}, \"referenced_type_descriptions\": [{}]}}",
        description(ty),
        parts.join(", ")
    );
    let mut hash = "RIHS01_".to_owned();
    for byte in Sha256::digest(text.as_bytes()) {
        let _ = write!(hash, "{byte:02x}");
    }
    Ok(hash)
}

/// Description of a type as JSON, with the spaces that Python writes.
fn description(ty: &Type) -> String {
    let fields: Vec<String> = match ty.fields.as_slice() {
        [] => vec![field("structure_needs_at_least_one_member", Plain::U8.number(), (0, 0), "")],
        fields => fields.iter().map(describe).collect(),
    };
    format!("{{\"type_name\": \"{}\", \"fields\": [{}]}}", ty.name, fields.join(", "))
}

fn describe(of: &Field) -> String {
    let (more, capacity) = match of.many {
        Many::One => (0, 0),
        Many::Array(count) => (ARRAY, count),
        Many::List(Some(most)) => (BOUNDED_LIST, most),
        Many::List(None) => (LIST, 0),
    };
    let (number, of_text, message) = match &of.element {
        Element::Plain(plain) => (plain.number(), 0, ""),
        Element::Text(None) => (TEXT, 0, ""),
        Element::Text(Some(most)) => (BOUNDED_TEXT, *most, ""),
        Element::Message(name) => (MESSAGE, 0, name.as_str()),
    };
    field(&of.name, number + more, (capacity, of_text), message)
}

fn field(name: &str, number: u32, (capacity, of_text): (usize, usize), message: &str) -> String {
    format!(
        "{{\"name\": \"{name}\", \"type\": {{\"type_id\": {number}, \"capacity\": {capacity}, \
         \"string_capacity\": {of_text}, \"nested_type_name\": \"{message}\"}}}}"
    )
}

impl Plain {
    /// Number of the type.
    fn number(self) -> u32 {
        match self {
            Self::I8 => 2,
            Self::U8 => 3,
            Self::I16 => 4,
            Self::U16 => 5,
            Self::I32 => 6,
            Self::U32 => 7,
            Self::I64 => 8,
            Self::U64 => 9,
            Self::F32 => 10,
            Self::F64 => 11,
            Self::Bool => 15,
            Self::Byte => 16,
            Self::Text => TEXT,
        }
    }
}
