//! Comparison of the types in a recording with those of the program.

use super::{Schema, definition, shape};
use apex_bag::Channel;
use core::fmt::{self, Display, Formatter};

/// A channel whose tokens are of another type than the recorded ones.
#[derive(Debug, Clone, PartialEq)]
pub struct TypeChange {
    /// Name of the channel: that of the port and its node.
    pub channel: String,
    /// Name of the recorded type.
    pub recorded: String,
    /// Name of the type that the program has.
    pub present: String,
    /// First lines of the descriptions of both types that differ; `None` if the recording has no description.
    pub difference: Option<(String, String)>,
}

/// Result of a comparison.
pub enum TypeMatch {
    /// The types are the same.
    Same,
    /// The types have the same name, but the recording does not describe its type.
    Undescribed,
    /// The types differ.
    Changed(TypeChange),
}

/// Compares the type of a recorded channel with the present one. A type that has only moved to another module is the
/// same, and so is a message that is defined in other words.
pub fn compare(recorded: &Channel, present: Schema, shape: fn() -> String) -> TypeMatch {
    let change = |difference| {
        TypeMatch::Changed(TypeChange {
            channel: recorded.name.clone(),
            recorded: recorded.schema.clone(),
            present: present.name.to_owned(),
            difference,
        })
    };
    let is_message = present.encoding == "cdr";
    if is_message && recorded.schema != present.name {
        return change(None);
    }
    if recorded.encoding != present.encoding {
        let encodings = [&recorded.encoding, present.encoding].map(|encoding| format!("encoding {encoding}"));
        return change((recorded.schema == present.name).then(|| encodings.into()));
    }
    match &recorded.shape {
        Some(recorded) => {
            let compare = if is_message { definition::difference } else { shape::difference };
            compare(recorded, &shape()).map_or(TypeMatch::Same, |difference| change(Some(difference)))
        }
        None if recorded.schema == present.name => TypeMatch::Undescribed,
        None => change(None),
    }
}

impl Display for TypeChange {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Self { channel, recorded, present, difference } = self;
        write!(f, "the type of `{channel}` was `{recorded}` and is `{present}`")?;
        let Some((was, is)) = difference else { return Ok(()) };
        write!(f, "; the first difference:\n    recorded: {was}\n    now:      {is}")
    }
}
