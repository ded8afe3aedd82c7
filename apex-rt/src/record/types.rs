//! Comparison of the types in a recording with those of the program.

use super::{Schema, definition, shape};
use apex_bag::{Channel, ROS1};
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

/// Returns in words how the messages of another program's channel differ from those of the same name that are defined
/// by `known`. A channel without a definition is known by its name alone.
pub fn other_message(channel: &Channel, known: &str) -> Option<String> {
    let shape = channel.shape.as_deref().filter(|_| !known.is_empty())?;
    let shape = if channel.encoding == ROS1 { definition::of_ros1(shape) } else { shape.to_owned() };
    let (theirs, ours) = definition::difference(&shape, known)?;
    Some(format!(
        "has another message `{}` than is known here; the first difference:\n    recorded: {theirs}\n    \
         known:    {ours}",
        channel.schema
    ))
}

impl Display for TypeChange {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Self { channel, recorded, present, difference } = self;
        write!(f, "the type of `{channel}` was `{recorded}` and is `{present}`")?;
        let Some((was, is)) = difference else { return Ok(()) };
        write!(f, "; the first difference:\n    recorded: {was}\n    now:      {is}")
    }
}
